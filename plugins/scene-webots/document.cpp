#include "document.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base_nodes.h"

namespace spark::webots {

Document::Document(const std::string& name, const ReadFile& read, mjcf::Unsupported& unsupported)
    : read_(read), unsupported_(unsupported) {
  const Source* const source = load(name);
  if (!source) throw Error(fmt::format("there is no file '{}'", name));
  std::map<const Node*, NodePtr> done;
  const Scope scope{*source, nullptr, done};
  for (const NodePtr& node : source->parsed.nodes) nodes_.push_back(expand(node, scope));
  const auto& protos = source->parsed.protos;
  if (!nodes_.empty() || protos.empty()) return;
  Node only{protos.back()->name, "", &source->file, protos.back()->offset};
  nodes_.push_back(instance(only, {source, protos.back()}, scope));
}

const Document::Source* Document::load(const std::string& name) {
  if (const auto known = sources_.find(name); known != sources_.end()) return known->second.get();
  std::optional<std::string> text = read_(name);
  if (!text) {
    sources_.emplace(name, nullptr);
    return nullptr;
  }
  if (sources_.size() >= kMaxFiles) throw Error(fmt::format("{}:1:1: expected at most {} files", name, kMaxFiles));
  auto source = std::make_unique<Source>();
  source->file.name = name;
  source->file.text = std::move(*text);
  source->parsed = parsed(source->file);
  return sources_.emplace(name, std::move(source)).first->second.get();
}

std::string Document::whyMissing(const std::string& type) const {
  const auto found = missing_.find(type);
  return found == missing_.end() ? "" : found->second;
}

/// The PROTO of a node: in its own file, by an EXTERNPROTO of that file, or beside it.
Document::Found Document::find(const Node& node, const Source& source) {
  for (const auto& proto : source.parsed.protos)
    if (proto->name == node.type) return {&source, proto};
  const auto& externs = source.parsed.externs;
  const auto named =
      std::find_if(externs.rbegin(), externs.rend(), [&](const Extern& e) { return e.name == node.type; });
  const std::string url = named == externs.rend() ? node.type + ".proto" : named->url;
  const std::vector<std::string> names = fileNames(source.file.name, url);
  Found found = findIn(node.type, names);
  if (!found.proto) missing_.emplace(node.type, fmt::format("looked for {}", fmt::join(names, ", ")));
  return found;
}

Document::Found Document::findIn(const std::string& type, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const Source* const source = load(name);
    if (!source) continue;
    for (const auto& proto : source->parsed.protos)
      if (proto->name == type) return {source, proto};
  }
  return {};
}

NodePtr Document::expand(const NodePtr& node, const Scope& scope) {
  if (const auto known = scope.done.find(node.get()); known != scope.done.end()) return known->second;
  NodePtr out = expandOnce(*node, scope);
  scope.done.emplace(node.get(), out);
  return out;
}

NodePtr Document::expandOnce(const Node& node, const Scope& scope) {
  if (++expanded_ > kMaxExpanded)
    throw node.element().error(fmt::format("expected at most {} nodes in all PROTOs and files", kMaxExpanded));
  if (scope.depth > kMaxNesting)
    throw node.element().error(fmt::format("expected nodes nested at most {} deep", kMaxNesting));
  auto out = std::make_shared<Node>(node);
  const Scope inside{scope.source, scope.arguments, scope.done, scope.depth + 1};
  for (Field& f : out->fields) f.value = expand(f, node, inside);
  std::erase_if(out->fields, [](const Field& f) { return !f.value; });
  if (isBaseNode(node.type)) return out;
  const Found found = find(node, scope.source);
  return found.proto ? instance(*out, found, scope) : out;
}

/// nullptr for a field that IS one without a value.
std::shared_ptr<const Value> Document::expand(const Field& f, const Node& node, const Scope& scope) {
  if (f.value->kind == Value::Kind::reference) {
    const std::string& name = f.value->texts.front();
    const auto found = scope.arguments ? scope.arguments->find(name) : Arguments::const_iterator();
    if (!scope.arguments || found == scope.arguments->end())
      throw errorAt(*node.file, f.offset,
                    fmt::format("expected the name of a field of a PROTO behind IS, found '{}'", name));
    return found->second;
  }
  if (f.value->kind != Value::Kind::nodes) return f.value;
  auto out = std::make_shared<Value>();
  out->kind = Value::Kind::nodes;
  for (const NodePtr& n : f.value->nodes) out->nodes.push_back(expand(n, scope));
  return out;
}

/// `node`: with its fields expanded.
NodePtr Document::instance(const Node& node, const Found& found, const Scope& scope) {
  const Proto& proto = *found.proto;
  const std::string key = fmt::format("{} {}", proto.file->name, proto.name);
  if (!open_.insert(key).second) throw node.element().error(fmt::format("the PROTO '{}' contains itself", proto.name));
  Arguments arguments;
  std::map<const Node*, NodePtr> done;
  const Scope outside{*found.source, nullptr, done, scope.depth + 1};
  const Node declared{proto.name, "", proto.file, proto.offset};
  for (const Field& f : proto.fields) {
    const Field* const given = node.field(f.name);
    arguments[f.name] = given ? given->value : expand(f, declared, outside);
  }
  for (const Field& f : node.fields)
    if (!arguments.contains(f.name))
      unsupported_.add(node.element(),
                       fmt::format("the PROTO '{}' has no field '{}', which is ignored", proto.name, f.name));
  NodePtr out = expand(proto.body, {*found.source, &arguments, done, scope.depth + 1});
  open_.erase(key);
  return out;
}

}  // namespace spark::webots
