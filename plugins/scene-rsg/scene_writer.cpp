#include "scene_writer.h"

#include <algorithm>

#include "api/scene.h"
#include "spark/describe.h"
#include "spark/error.h"
#include "spark/predicates.h"
#include "spark/random.h"

namespace spark {

namespace {

/// A text as an operand that is read as this text.
std::string operandOf(const std::string& text) {
  // A word that begins with '$' is a variable.
  if (text.size() > 1 && text.front() == '$') return fmt::format("(join $ {})", operandOf(text.substr(1)));
  if (isWord(text) && text.front() != '$') return text;
  std::string out = "\"";
  for (const char c : text) {
    if (std::string_view("\"'()\\").find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out + '"';
}

/// Appends values, with a blank before each; the elements of a list one after the other. `what` is for errors.
void appendOperands(const Value& value, const std::string& what, bool inList, std::string& out) {
  const auto refuse = [&] {
    return Error(
        fmt::format("{} cannot be written to a scene file: expected a text, a number, a bool or a list of "
                    "these, found {}",
                    what, value.text().substr(0, 200)));
  };
  if (value.isNil() || (value.isList() && inList)) throw refuse();
  if (value.isList()) {
    for (const Value& element : value.toList()) appendOperands(element, what, true, out);
    return;
  }
  if (value.isNumber() && std::isnan(value.toNumber())) throw refuse();
  std::string text = value.isString() ? operandOf(value.toString()) : value.text();
  if (!value.isString() && text.ends_with(".0")) text.resize(text.size() - 2);
  out += ' ' + text;
}

bool isSetAtOnce(const Property& p) { return p.name == "name" || p.name == "localTransform" || p.name == "localPos"; }

}  // namespace

void SceneWriter::describe(Description<SceneWriter>& d) {
  d.doc("Writes nodes as a scene file, from which they can be imported again.");
  d.method("text", &SceneWriter::text).parameters({"path"}).doc("A scene file with all nodes below that path.");
}

std::string SceneWriter::text(const std::string& path) {
  const Node& root = require<Node>(path);
  std::string out = "(RSG 0 2)\n(\n";
  for (const auto& child : root.children()) writeNode(*child, 1, out);
  return out + ")\n";
}

void SceneWriter::writeNode(const Leaf& node, int depth, std::string& out) {
  const std::string indent(static_cast<std::size_t>(2 * depth), ' '), inner = indent + "  ";
  ClassObject& type = *node.classObject();
  if (!type.isA(SceneNode::kClassName) && !type.isOrOffers("IExtension"))
    throw Error(fmt::format("{} cannot be written to a scene file: its class {} is none of scene nodes", node.path(),
                            type.name()));
  out += fmt::format("{}(nd {}", indent, type.name());
  if (node.name() != type.name()) out += fmt::format(" (setName {})", operandOf(node.name()));
  if (const auto transform = node.as<Transform>(); transform && transform->local() != Matrix::Identity()) {
    out += '\n' + inner + "(setLocalTransform";
    for (int i = 0; i < 16; ++i) appendOperands(shortest(transform->local().data()[i]), node.path(), false, out);
    out += ')';
  }
  if (const auto calls = node.as<ISceneCalls>())
    for (const SceneCall& call : calls->sceneCalls()) {
      out += '\n' + inner + '(' + call.method;
      for (const Value& argument : call.arguments)
        appendOperands(argument, fmt::format("{} of {}", call.method, node.path()), false, out);
      out += ')';
    }
  writeProperties(node, inner, out);
  if (const Node* const parent = node.asNode(); parent && !parent->children().empty()) {
    out += '\n';
    for (const auto& child : parent->children()) writeNode(*child, depth + 1, out);
    out.pop_back();  // the bracket follows the last child
  }
  out += ")\n";
}

void SceneWriter::writeProperties(const Leaf& node, const std::string& indent, std::string& out) {
  const auto calls = node.as<ISceneCalls>();
  const std::vector<std::string_view> byCalls = calls ? calls->setByCalls() : std::vector<std::string_view>();
  // A new node of the name, because the name may be the default of other properties.
  const std::unique_ptr<Leaf> fresh = node.classObject()->create();
  fresh->setName(node.name());
  for (const Property* p : node.classObject()->properties()) {
    if (p->readOnly || p->ofProcess || isSetAtOnce(*p) || p->type == Convert<RandomStream>::typeName() ||
        std::find(byCalls.begin(), byCalls.end(), p->name) != byCalls.end())
      continue;
    const Value value = p->get(node);
    if (value == p->get(*fresh)) continue;
    out += '\n' + indent + "(set " + p->name;
    appendOperands(value, node.path() + '.' + p->name, false, out);
    out += ')';
  }
}

}  // namespace spark
