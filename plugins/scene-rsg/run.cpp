#include "run.h"

#include <charconv>
#include <filesystem>
#include <optional>

#include "expression.h"
#include "spark/error.h"
#include "spark/plugin_object.h"
#include "spark/script.h"
#include "spark/script_text.h"

namespace spark::rsg {

namespace {
/// An Error whose message begins with file:line:column.
class Located : public Error {
 public:
  using Error::Error;
};

Error tooLong() { return Error(fmt::format("expected a text of at most {} bytes, found a longer one", kMaxText)); }
/// True for methods as those of scripted perceptors, which attach a script to their node.
bool attachesScript(const Method& m) {
  return m.name == "script" && m.parameters.size() == 2 && m.parameters.front().starts_with("file:");
}

/// Uses the plugins that provide a class and its bases, as models of other languages do.
void provide(Kernel& kernel, std::string_view className) {
  if (!kernel.findClass(className))
    if (const Plugin* const provider = kernel.plugins().providerOf(className)) kernel.plugins().use(provider->name());
  if (const ClassObject* const known = kernel.findClass(className); known && !known->baseName().empty())
    provide(kernel, known->baseName());
}
}  // namespace

template <class F>
decltype(auto) Run::located(const Site& site, F f) const {
  try {
    return f();
  } catch (const Located&) {
    throw;
  } catch (const std::exception& e) {
    throw Located(fmt::format("{}: {}", where(program_, site), e.what()));
  }
}

Run::Run(RsgImporter& importer, const Program& program, std::vector<std::string> arguments)
    : importer_(importer),
      scenes_(importer.kernel().root().find<ISceneServer>()),
      program_(program),
      environment_(program, std::move(arguments), importer.rules_.defineByName || program.ours) {}

void Run::execute(Node& root) {
  root_ = &root;
  std::optional<Error> failure;  // the first error
  std::size_t nextChild = 0;
  try {
    runBlock(program_.body, {&root, &nextChild});
  } catch (const Error& e) {
    failure = e;
  }
  try {
    flush();
  } catch (const Error& e) {
    if (!failure) failure = e;
  }
  if (!failure) failure = importFailure_;
  if (failure) throw *failure;
}

void Run::runBlock(const Block& block, Cursor cursor) {
  std::size_t nextChild = 0;
  for (const Statement& s : block.statements) {
    importer_.frames_.back().site = s.site;
    located(s.site, [&] { runStatement(s, cursor, nextChild); });
  }
}

void Run::runStatement(const Statement& s, Cursor& cursor, std::size_t& nextChild) {
  if (!cursor.node) throw Error("the node that this belongs to was removed");
  Leaf& node = *cursor.node;
  const auto enter = [&](Leaf& inner) {
    cursor = {&inner, &nextChild};
    nextChild = 0;
  };
  switch (s.kind) {
    case Statement::Kind::block:
      return runBlock(s.blocks.front(), cursor);
    case Statement::Kind::node:
      return enter(makeNode(s, node));
    case Statement::Kind::nextNode:
      return enter(nextNode(cursor));
    case Statement::Kind::select:
      return enter(select(s, node));
    case Statement::Kind::print:
      return importer_.kernel().log().debug("{}: {}", where(program_, s.site), node.path());
    case Statement::Kind::parameters:
      for (const std::size_t slot : s.slots) environment_.parameter(slot);
      return;
    case Statement::Kind::define:
      return environment_.define(s.slots.front(), textOf(s.operands.front()));
    case Statement::Kind::choose:
      return choose(s, cursor);
    case Statement::Kind::call:
    case Statement::Kind::set:
      return call(s, node);
    case Statement::Kind::error:
      throw Error(s.text);
  }
}

ClassObject& Run::classOf(const Statement& s) const {
  if (s.nodeClass) return *s.nodeClass;
  Kernel& kernel = importer_.kernel();
  if (program_.ours) provide(kernel, s.text);
  ClassObject& nodeClass = kernel.classOf(s.text);
  // Of ours, what engines read beside a node is no scene node, and cannot have children.
  if (!nodeClass.isA(SceneNode::kClassName) && !(program_.ours && nodeClass.isOrOffers("IExtension")))
    throw Error(fmt::format("expected a class of scene nodes, found {}, which does not derive from {}",
                            nodeClass.name(), SceneNode::kClassName));
  s.nodeClass = &nodeClass;
  return nodeClass;
}

Leaf& Run::makeNode(const Statement& s, Leaf& parent) {
  ClassObject& nodeClass = classOf(s);
  Budget& budget = importer_.budget_;
  if (++budget.nodes > budget.maxNodes)
    importer_.exhausted(
        fmt::format("too many nodes: one import may make at most {} ({}.maxNodes)", budget.maxNodes, importer_.path()));
  Node* const above = parent.asNode();
  if (!above) throw Error(fmt::format("{} cannot have children", parent.path()));
  return above->add(nodeClass.create());
}

Node& Run::nextNode(Cursor& cursor) {
  const auto& children = cursor.node->asNode()->children();
  const std::size_t i = (*cursor.nextChild)++;
  if (i >= children.size())
    throw Error(
        fmt::format("expected at most {} nodes below {}, found one more", children.size(), cursor.node->path()));
  if (auto node = children[i]->as<SceneNode>()) return *node;
  throw Error(fmt::format("expected a scene node, found {}", children[i]->path()));
}

Node& Run::select(const Statement& s, Leaf& parent) {
  const Node* const above = parent.asNode();
  Leaf* found = above ? above->child(s.text) : nullptr;
  if (found && found->as<SceneNode>()) return *found->asNode();
  std::vector<std::string> names;
  for (std::size_t i = 0; above && i < above->children().size(); ++i) names.push_back(above->children()[i]->name());
  throw Error(fmt::format("there is no scene node '{}' in {}.{}", s.text, parent.path(), didYouMean(s.text, names)));
}

void Run::choose(const Statement& s, const Cursor& cursor) {
  // The first matching case.
  const std::string value = textOf(s.operands.front());
  for (std::size_t i = 0; i < s.blocks.size(); ++i) {
    if (textOf(s.operands[i + 1]) != value) continue;
    try {
      runBlock(s.blocks[i], cursor);
    } catch (const Error& e) {
      if (strict() || importer_.budget_.exhausted) throw;
      complain(s, Level::error, fmt::format("the case '{}' failed, the rest goes on: {}", value, e.what()));
    }
    return;
  }

  // None matches; a switch without cases has no effect.
  if (s.blocks.empty()) return;
  std::string labels;
  for (std::size_t i = 1; i < s.operands.size() && i < 10; ++i)
    labels += (i > 1 ? ", '" : "'") + textOf(s.operands[i]) + "'";
  throw Error(fmt::format("no case matches '{}', there are {}", value, labels));
}

void Run::call(const Statement& s, Leaf& node) {
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

void Run::import(const Statement& s, Leaf& node, const List& arguments) {
  Node* const root = node.asNode();
  if (!root || !methodOf(s, node) || arguments.empty()) return invoke(s, node, arguments);  // reports the problem
  const std::string file = resourceOf(arguments.front().toString());
  try {
    importer_.kernel().root().require<ISceneServer>().importScene(file, *root,
                                                                  List(arguments.begin() + 1, arguments.end()));
  } catch (const std::exception& e) {
    const Located failure(fmt::format("{}: the import of '{}' failed", where(program_, s.site), file), e);
    if (strict() || importer_.budget_.exhausted) throw failure;
    if (!importer_.rules_.looseImports && !importFailure_)
      importFailure_ = failure;
    else
      complain(s, Level::error, fmt::format("the import of '{}' failed, the rest goes on: {}", file, e.what()));
  }
}

std::string Run::resourceOf(const std::string& file) const {
  const std::size_t folder = program_.resource.rfind('/') + 1;
  if (folder == 0 || file.starts_with('/')) return file;
  std::string beside = program_.resource.substr(0, folder) + file;
  if (file.find("./") != std::string::npos) beside = std::filesystem::path(beside).lexically_normal().generic_string();
  if (beside.starts_with("..") || beside.starts_with('/')) return file;
  auto* const files = importer_.kernel().root().find<IFileServer>();
  return files && files->exists(beside) ? beside : file;
}

void Run::attachScript(Leaf& node, const List& arguments) {
  if (arguments.empty()) throw Error("expected the file of a script and its arguments, found no file");
  List given;
  for (auto it = arguments.begin() + 1; it != arguments.end(); ++it) {
    const std::string text = it->plain();
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool isNumber = error == std::errc() && end == text.data() + text.size();
    given.push_back(isNumber ? Value(number) : Value(text));
  }
  Value argument;
  if (given.size() == 1)
    argument = given.front();
  else if (!given.empty())
    argument = Value(std::move(given));
  attachScript(node, arguments.front().toString(), argument);
}

/// A script of the file server; by a name without `..` also one that a config may attach. There are no others.
void Run::attachScript(Leaf& node, const std::string& file, const Value& argument) {
  const Node& root = importer_.kernel().root();
  const std::string resource = resourceOf(file);
  if (resource.starts_with('/') || ("/" + resource + "/").find("/../") != std::string::npos)
    throw Error(fmt::format("expected a script beside this file or below the folders of scenes, found '{}'", file));
  auto* const files = root.find<IFileServer>();
  if (files && files->exists(resource))
    root.require<IScriptText>(IScriptServer::kPath).attachText(node, files->read(resource), resource, true, argument);
  else
    root.require<IScriptServer>(IScriptServer::kPath).attach(node, file, argument);
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
  if (s.kind == Statement::Kind::set) return set(s, node, arguments);
  if (s.text == "attachScript") return attachScript(node, arguments);
  const Method* method = methodOf(s, node);
  if (method && attachesScript(*method)) return attachScript(node, arguments);
  if (!method) {
    if (s.complained && !strict()) return;
    std::vector<std::string> names;
    for (const Method* m : node.classObject()->methods()) names.push_back(m->name);
    return complain(
        s, Level::error,
        fmt::format("class {} has no method '{}'.{}", node.classObject()->name(), s.text, didYouMean(s.text, names)));
  }
  if (s.text == "unlinkLeaf" && &node == root_) throw Error("a scene cannot remove the node that it is imported into");
  beforeCall(s, node);
  if (strict() || !importer_.rules_.looseArguments) {
    const Ref<Transform> transform(program_.ours && s.immediate ? node.as<Transform>() : nullptr);
    callMethod(node, s.text, arguments);  // may remove the node
    // A transform that has nothing below it yet moves nothing: what is made there later has its pose from the start.
    if (transform && transform->children().empty()) transform->setMovedSincePlace(false);
    return;
  }
  const ClassObject& called = *node.classObject();  // the call may remove the node
  std::string whyNot;
  if (!callLoosely(node, *method, arguments, whyNot))
    complain(s, Level::warning, fmt::format("{} of {} is skipped: {}", s.text, called.name(), whyNot));
}

void Run::set(const Statement& s, Leaf& node, const List& arguments) {
  ClassObject& c = *node.classObject();
  const Property* const property = c.property(s.text);
  if (!property) {
    std::vector<std::string> names;
    for (const Property* p : c.properties()) names.push_back(p->name);
    throw Error(fmt::format("class {} has no property '{}'.{}", c.name(), s.text, didYouMean(s.text, names)));
  }
  if (!property->set) throw Error(fmt::format("the property {} of class {} is read only", s.text, c.name()));
  if (scenes_) scenes_->willChange(node);
  Args args{arguments};
  try {
    writeProperty(*property, node, args);
  } catch (const std::exception& e) {
    throw Error(fmt::format("cannot set {} of {}", s.text, node.path()), e);
  }
  if (!args.atEnd())
    throw Error(fmt::format("cannot set {} of {}: expected {}, found {} values", s.text, node.path(), property->type,
                            arguments.size()));
}

void Run::beforeCall(const Statement& s, Leaf& node) {
  if (!scenes_) return;
  if (s.text == "unlinkLeaf") return scenes_->willRemove(node);
  if (s.text != "unlinkChildren") return scenes_->willChange(node);
  if (const Node* const parent = node.asNode())
    for (const auto& child : parent->children()) scenes_->willRemove(*child);
}

void Run::flush() {
  std::optional<Error> failure;  // the first error; the other calls are still made
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

    // eval and join: the text of all parts; eval separates them by blanks.
    const bool eval = o.kind == Operand::Kind::eval;
    std::string text;
    for (const Operand& part : o.parts) {
      text += textOf(part);
      if (eval) text += ' ';
      if (text.size() > kMaxText) throw tooLong();
    }
    if (!eval) return text;

    // eval: the value of that text.
    ++importer_.evals_;
    const auto lookup = [this](std::string_view group, std::string_view member) { return variable(group, member); };
    std::string result = resultText(evaluate(text, lookup, importer_.rules_.integerDivision),
                                    importer_.rules_.evalDigits6 && !program_.ours);
    if (result.size() > kMaxText) throw tooLong();
    return result;
  });
}

Value Run::variable(std::string_view group, std::string_view member) const {
  Node* groups = importer_.kernel().root().find<Node>(IVariables::kFolder);
  auto found = groups && groups->child(group) ? groups->child(group)->as<IVariables>() : nullptr;
  if (!found) {
    std::vector<std::string> names;
    if (groups)
      for (const auto& child : groups->children()) names.push_back(child->name());
    throw Error(fmt::format("there are no variables '{}' below /sys/variables.{}", group, didYouMean(group, names)));
  }
  Value value = found->variable(member);
  if (value.isNil())
    throw Error(fmt::format("the variable {}{}{} is not set", group, member.empty() ? "" : ".", member));
  return value;
}

void Run::complain(const Statement& s, Level level, const std::string& text) {
  if (strict()) throw Error(text);
  if (s.complained) return;
  s.complained = true;
  importer_.kernel().log().write(level, fmt::format("{}: {}{}", where(program_, s.site), text, importer_.chain()));
}

}  // namespace spark::rsg
