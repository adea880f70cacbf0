#include "tree_feed.h"

#include "messages.h"
#include "scene_feed.h"
#include "spark/plugin_object.h"
#include "wire.h"

namespace spark::remote {

namespace {
/// True for what the program shows of a run, which is no part of the simulation.
bool isOfProgram(const Leaf& leaf) {
  const Leaf& root = leaf.kernel().root();
  if (leaf.parent() == &root) return leaf.name() == "classes" || leaf.name() == "plugins";
  return leaf.parent() && leaf.parent()->parent() == &root && leaf.parent()->name() == "sys" && leaf.name() == "host";
}

List describe(const Property& p) { return {p.name, p.type, p.unit, p.doc, p.readOnly, p.state, p.scalars}; }

List describe(const Method& m) {
  List parameters(m.parameters.begin(), m.parameters.end());
  return {m.name, m.doc, std::move(parameters), m.returns, m.minScalars, m.maxScalars, m.surplusIgnored};
}

/// The names of all bases, the nearest first, if nodes of the class can be scene nodes of another host.
List basesOf(ClassObject& c) {
  List bases;
  if (isOfScene(c))
    for (ClassObject* base = c.base(); base; base = base->base()) bases.emplace_back(base->name());
  return bases;
}
}  // namespace

void TreeFeed::update(Node& root, SceneFeed& scene, Wire& out) {
  if (root_ == root.id() && version_ == root.changedAt()) return;
  root_ = root.id();
  version_ = root.changedAt();
  ++round_;
  visit(root, scene, out);
  // Parents have smaller ids than their children unless they were moved; removing a node twice does no harm.
  for (auto at = known_.begin(); at != known_.end();) {
    if (at->second.round == round_) {
      ++at;
      continue;
    }
    out.send({kRemove, at->first});
    at = known_.erase(at);
  }
}

void TreeFeed::visit(Node& node, SceneFeed& scene, Wire& out) {
  for (const auto& child : node.children()) {
    if (isOfProgram(*child)) continue;
    tell(*child, scene, out);
    if (Node* const inner = child->asNode()) visit(*inner, scene, out);
  }
}

void TreeFeed::tell(Leaf& leaf, SceneFeed& scene, Wire& out) {
  const std::uint64_t parent = leaf.parent()->id() == root_ ? 0 : leaf.parent()->id();
  const auto [at, isNew] = known_.try_emplace(leaf.id());
  Known& known = at->second;
  if (isNew) {
    tellClass(*leaf.classObject(), out);
    out.send({kAdd, leaf.id(), parent, leaf.name(), leaf.classObject()->name(), scene.describe(leaf)});
  } else {
    if (known.parent != parent) out.send({kMove, leaf.id(), parent});
    if (known.name != leaf.name()) out.send({kRename, leaf.id(), leaf.name()});
  }
  known.round = round_;
  if (isNew || known.parent != parent) known.parent = parent;
  if (isNew || known.name != leaf.name()) known.name = leaf.name();
}

void TreeFeed::tellClass(ClassObject& c, Wire& out) {
  std::uint64_t& described = classes_[c.name()];
  if (described == c.id()) return;
  described = c.id();
  List properties, methods;
  for (const Property* p : c.properties()) properties.emplace_back(describe(*p));
  for (const Method* m : c.methods()) methods.emplace_back(describe(*m));
  const Plugin* const plugin = c.plugin();
  out.send({kClass, c.name(), c.doc(), c.baseName(), plugin ? plugin->name() : "", plugin ? plugin->version() : "",
            std::move(properties), std::move(methods), basesOf(c)});
}

}  // namespace spark::remote
