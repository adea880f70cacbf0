#include "run.h"

#include <optional>

#include "expression.h"
#include "spark/error.h"

namespace spark::rsg {

namespace {
/// An Error that says where.
class Located : public Error {
 public:
  using Error::Error;
};
}  // namespace

template <class F>
decltype(auto) Run::located(const Site& site, F f) const {
  try {
    return f();
  } catch (const Located&) {
    throw;
  } catch (const std::exception& e) {
    throw Located(where(program_, site) + ": " + e.what());
  }
}

Run::Run(RsgImporter& importer, const Program& program, std::vector<std::string> arguments)
    : importer_(importer),
      program_(program),
      environment_(program, std::move(arguments), importer.rules_.defineByName) {}

void Run::execute(Node& root) {
  root_ = &root;
  std::optional<Error> failure;
  std::size_t passed = 0;
  try {
    walk(program_.body, {&root, &passed});
  } catch (const Error& e) {
    failure = e;
  }
  try {
    flush();
  } catch (const Error& e) {
    if (!failure) failure = e;
  }
  if (failure) throw *failure;
}

void Run::walk(const Block& block, Cursor cursor) {
  std::size_t passed = 0;
  for (const Statement& s : block.statements) {
    importer_.frames_.back().site = s.site;
    located(s.site, [&] { step(s, cursor, passed); });
  }
}

void Run::step(const Statement& s, Cursor& cursor, std::size_t& passed) {
  if (!cursor.node) throw Error("the node that this belongs to was removed");
  Node& node = *cursor.node;
  const auto enter = [&](Node& inner) {
    cursor = {&inner, &passed};
    passed = 0;
  };
  switch (s.kind) {
    case Statement::Kind::block:
      return walk(s.blocks.front(), cursor);
    case Statement::Kind::node:
      return enter(makeNode(s, node));
    case Statement::Kind::nextNode:
      return enter(nextNode(cursor));
    case Statement::Kind::select:
      return enter(select(s, node));
    case Statement::Kind::print:
      return importer_.kernel().log().debug("{}: {}", where(program_, s.site), node.path());
    case Statement::Kind::parameters:
      for (const int slot : s.slots) environment_.parameter(slot);
      return;
    case Statement::Kind::define:
      return environment_.define(s.slots.front(), textOf(s.operands.front()));
    case Statement::Kind::choose:
      return choose(s, cursor);
    case Statement::Kind::call:
      return call(s, node);
    case Statement::Kind::error:
      throw Error(s.text);
  }
}

ClassObject& Run::classOf(const Statement& s) const {
  if (s.made) return *s.made;
  ClassObject& made = importer_.kernel().classOf(s.text);
  if (!made.isA(SceneNode::kClassName))
    throw Error("expected a class of scene nodes, found " + made.name() + ", which does not derive from " +
                SceneNode::kClassName);
  s.made = &made;
  return made;
}

Node& Run::makeNode(const Statement& s, Node& parent) {
  ClassObject& made = classOf(s);
  Budget& budget = importer_.budget_;
  if (++budget.nodes > budget.maxNodes)
    importer_.exhausted("too many nodes: one import may make at most " + std::to_string(budget.maxNodes) + " (" +
                        importer_.path() + ".maxNodes)");
  return *parent.add(made.create()).asNode();
}

Node& Run::nextNode(Cursor& cursor) {
  const auto& children = cursor.node->children();
  const std::size_t i = (*cursor.passed)++;
  if (i >= children.size())
    throw Error("expected at most " + std::to_string(children.size()) + " nodes below " + cursor.node->path() +
                ", found one more");
  if (auto node = children[i]->as<SceneNode>()) return *node;
  throw Error("expected a scene node, found " + children[i]->path());
}

Node& Run::select(const Statement& s, Node& parent) {
  Leaf* found = parent.child(s.text);
  if (found && found->as<SceneNode>()) return *found->asNode();
  std::vector<std::string> names;
  for (const auto& child : parent.children()) names.push_back(child->name());
  throw Error("there is no scene node '" + s.text + "' in " + parent.path() + "." + didYouMean(s.text, names));
}

void Run::choose(const Statement& s, const Cursor& cursor) {
  const std::string value = textOf(s.operands.front());
  for (std::size_t i = 0; i < s.blocks.size(); ++i) {
    if (textOf(s.operands[i + 1]) != value) continue;
    try {
      walk(s.blocks[i], cursor);
    } catch (const Error& e) {
      if (importer_.rules_.strict || importer_.budget_.exhausted) throw;
      complain(s, Level::error, "the case '" + value + "' failed, the rest goes on: " + e.what());
    }
    return;
  }
  if (s.blocks.empty()) return;
  std::string labels;
  for (std::size_t i = 1; i < s.operands.size() && i < 10; ++i)
    labels += (i > 1 ? ", '" : "'") + textOf(s.operands[i]) + "'";
  throw Error("no case matches '" + value + "', there are " + labels);
}

void Run::call(const Statement& s, Node& node) {
  ++importer_.calls_;
  List computed;
  if (!s.constant) {
    computed.reserve(s.operands.size());
    for (const Operand& o : s.operands) computed.emplace_back(textOf(o));
  }
  const List& arguments = s.constant ? s.arguments : computed;
  if (!s.immediate)
    queue_.push_back({&node, &s, std::move(computed)});
  else if (s.text == "importScene")
    import(s, node, arguments);
  else
    invoke(s, node, arguments);
}

void Run::import(const Statement& s, Node& node, const List& arguments) {
  if (!methodOf(s, node) || arguments.empty()) return invoke(s, node, arguments);  // says what is wrong
  const std::string& file = arguments.front().toString();
  try {
    importer_.kernel().root().require<ISceneServer>().importScene(file, node,
                                                                  List(arguments.begin() + 1, arguments.end()));
  } catch (const std::exception& e) {
    if (importer_.rules_.strict || importer_.budget_.exhausted)
      throw Located(where(program_, s.site) + ": the import of '" + file + "' failed", e);
    complain(s, Level::error, "the import of '" + file + "' failed, the rest goes on: " + e.what());
  }
}

const Method* Run::methodOf(const Statement& s, Leaf& node) const {
  ClassObject& c = *node.classObject();
  if (s.classId != c.id()) {
    s.method = c.method(s.text);
    s.classId = c.id();
  }
  return s.method;
}

void Run::invoke(const Statement& s, Leaf& node, const List& arguments) {
  const Method* method = methodOf(s, node);
  if (!method) {
    if (s.complained && !importer_.rules_.strict) return;
    std::vector<std::string> names;
    for (const Method* m : node.classObject()->methods()) names.push_back(m->name);
    return complain(
        s, Level::error,
        "class " + node.classObject()->name() + " has no method '" + s.text + "'." + didYouMean(s.text, names));
  }
  if (s.text == "unlinkLeaf" && &node == root_) throw Error("a scene cannot remove the node that it is imported into");
  if (importer_.rules_.strict || !importer_.rules_.looseArguments) {
    callMethod(node, s.text, arguments);
    return;
  }
  const ClassObject& called = *node.classObject();  // the node may go
  std::string whyNot;
  if (!callLoosely(node, *method, arguments, whyNot))
    complain(s, Level::warning, s.text + " of " + called.name() + " is skipped: " + whyNot);
}

void Run::flush() {
  std::optional<Error> failure;
  for (const Queued& q : queue_) {
    importer_.frames_.back().site = q.call->site;
    try {
      located(q.call->site, [&] {
        if (q.node)
          invoke(*q.call, *q.node, q.call->constant ? q.call->arguments : q.computed);
        else
          complain(*q.call, Level::error, "the node of this call was removed before it was made");
      });
    } catch (const Error& e) {
      if (!failure) failure = e;
    }
  }
  if (failure) throw *failure;
}

std::string Run::textOf(const Operand& o) {
  return located(o.site, [&]() -> std::string {
    switch (o.kind) {
      case Operand::Kind::text:
        return o.text;
      case Operand::Kind::variable:
        return environment_.value(o.slot);
      case Operand::Kind::bad:
        throw Error(o.text);
      default:
        break;
    }
    const bool eval = o.kind == Operand::Kind::eval;
    std::string text;
    for (const Operand& part : o.parts) {
      text += textOf(part);
      if (eval) text += ' ';
      if (text.size() > kMaxText)
        throw Error("expected a text of at most " + std::to_string(kMaxText) + " bytes, found a longer one");
    }
    if (!eval) return text;
    ++importer_.evals_;
    const auto lookup = [this](std::string_view group, std::string_view member) { return variable(group, member); };
    std::string result =
        resultText(evaluate(text, lookup, importer_.rules_.integerDivision), importer_.rules_.evalDigits6);
    if (result.size() > kMaxText)
      throw Error("expected a text of at most " + std::to_string(kMaxText) + " bytes, found a longer one");
    return result;
  });
}

Value Run::variable(std::string_view group, std::string_view member) const {
  Node* groups = importer_.kernel().root().find<Node>("/sys/variables");
  auto found = groups && groups->child(group) ? groups->child(group)->as<IVariables>() : nullptr;
  if (!found) {
    std::vector<std::string> names;
    if (groups)
      for (const auto& child : groups->children()) names.push_back(child->name());
    throw Error("there are no variables '" + std::string(group) + "' below /sys/variables." + didYouMean(group, names));
  }
  Value value = found->variable(member);
  if (value.isNil())
    throw Error("the variable " + std::string(group) + (member.empty() ? "" : "." + std::string(member)) +
                " is not set");
  return value;
}

void Run::complain(const Statement& s, Level level, const std::string& sentence) {
  if (importer_.rules_.strict) throw Error(sentence);
  if (s.complained) return;
  s.complained = true;
  importer_.kernel().log().write(level, where(program_, s.site) + ": " + sentence + importer_.chain());
}

}  // namespace spark::rsg
