#include "program.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include "spark/error.h"
#include "spark/predicates.h"

namespace spark::rsg {

namespace {

/// Abbreviations of keywords and methods.
constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kHeadAliases{{{"nd", "node"},
                                                                                     {"sel", "select"},
                                                                                     {"templ", "template"},
                                                                                     {"def", "define"},
                                                                                     {"att", "attach"},
                                                                                     {"SLT", "setLocalTransform"},
                                                                                     {"sSc", "setScale"},
                                                                                     {"sMat", "setMaterial"}}};
/// Abbreviations of classes.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kClassAliases{
    {{"BN", "BaseNode"}, {"SMN", "SingleMatNode"}, {"TRF", "Transform"}}};
/// The methods of Transform in the installed base. Calls with these names are immediate, whatever the node's class is.
constexpr std::array<std::string_view, 10> kImmediate{
    "getFullPath",    "setName",     "getName",     "isLeaf",           "unlinkLeaf",
    "unlinkChildren", "importScene", "setLocalPos", "setLocalRotation", "setLocalTransform"};

/// The full name of an abbreviation; other words unchanged.
template <std::size_t N>
std::string_view resolve(const std::array<std::pair<std::string_view, std::string_view>, N>& aliases,
                         std::string_view word) {
  for (const auto& [alias, name] : aliases)
    if (alias == word) return name;
  return word;
}

Site siteOf(const Element& e) { return {e.line(), e.column()}; }

/// A statement that throws an Error with the message `text`.
Statement failing(const Site& site, std::string text) {
  Statement s;
  s.kind = Statement::Kind::error;
  s.site = site;
  s.text = std::move(text);
  return s;
}

/// Turns parsed lists into statements.
class Compiler {
 public:
  /// Adds variables to `program`.
  explicit Compiler(Program& program) : program_(program) {}
  /// Compiles the elements of a list.
  Block block(const Element& list);

 private:
  using Position = Element::Iterator;
  /// Compiles the statement that begins with the atom at `at`, and moves `at` past it.
  Statement atom(Position& at, const Position& end, const Element& list);
  // Compile the rest of a list after its keyword.
  Statement parameters(Position at, const Position& end, const Site& site);
  Statement define(Position at, const Position& end, const Site& site);
  Statement choose(Position at, const Position& end, const Site& site);
  Statement call(std::string_view method, Position at, const Position& end, const Site& site);
  Statement set(Position at, const Position& end, const Site& site);
  /// Adds the operands of a call.
  void addOperands(Statement& s, Position at, const Position& end);
  Operand operand(const Element& e);
  /// The slot of a variable; a new one for a new name.
  std::size_t slot(std::string_view variable);
  Program& program_;
};

Block Compiler::block(const Element& list) {
  Block out;
  const Position end = list.end();
  for (Position at = list.begin(); at != end;) {
    const Element e = *at;
    if (e.isList()) {
      Statement s;
      s.site = siteOf(e);
      s.blocks.push_back(block(e));
      out.statements.push_back(std::move(s));
      ++at;
    } else {
      out.statements.push_back(atom(at, end, list));
    }
  }
  return out;
}

Statement Compiler::atom(Position& at, const Position& end, const Element& list) {
  const std::string_view word = resolve(kHeadAliases, (*at).text());
  Statement s;
  s.site = siteOf(*at).line ? siteOf(*at) : siteOf(list);
  ++at;

  // Keywords that take one or two words: the rest of the list is further statements.
  if (word == "pwd") {
    s.kind = Statement::Kind::print;
    return s;
  }
  if (word == "node" && program_.delta) {
    while (at != end && !(*at).isList()) ++at;
    s.kind = Statement::Kind::nextNode;
    return s;
  }
  const bool named = word == "node" || word == "select";
  if (named && at != end && !(*at).isList()) {
    s.kind = word == "node" ? Statement::Kind::node : Statement::Kind::select;
    s.text = word == "node" ? resolve(kClassAliases, (*at).text()) : (*at).text();
    ++at;
    return s;
  }

  // All others take the whole rest of the list.
  const Position rest = std::exchange(at, end);
  if (named) return failing(s.site, fmt::format("expected a name after '{}'", word));
  if (word == "template") return parameters(rest, end, s.site);
  if (word == "define") return define(rest, end, s.site);
  if (word == "switch") return choose(rest, end, s.site);
  if (word == "set" && program_.ours) return set(rest, end, s.site);
  return call(word, rest, end, s.site);
}

Statement Compiler::parameters(Position at, const Position& end, const Site& site) {
  Statement s;
  s.kind = Statement::Kind::parameters;
  s.site = site;
  for (; at != end && !(*at).isList(); ++at) {
    const std::string_view name = (*at).text();
    if (name.size() < 2 || name[0] != '$')
      return failing(siteOf(*at), fmt::format("expected a parameter such as '$size' in template, found '{}'", name));
    s.slots.push_back(slot(name));
  }
  return s;
}

Statement Compiler::define(Position at, const Position& end, const Site& site) {
  Statement s;
  s.kind = Statement::Kind::define;
  s.site = site;
  const std::string_view name = at != end ? (*at).text() : std::string_view();
  if (name.size() < 2 || name[0] != '$')
    return failing(site, fmt::format("expected a variable such as '$size' after define, found '{}'", name));
  s.slots.push_back(slot(name));
  if (!(++at != end)) return failing(site, fmt::format("expected a value for {}, found nothing", name));
  s.operands.push_back(operand(*at));
  return s;
}

Statement Compiler::choose(Position at, const Position& end, const Site& site) {
  Statement s;
  s.kind = Statement::Kind::choose;
  s.site = site;
  if (!(at != end)) return failing(site, "expected a value after switch, found nothing");
  s.operands.push_back(operand(*at));

  // Each case is a list of a label and a body.
  for (++at; at != end; ++at) {
    const Element label = (*at).at(0);
    Operand o;
    if ((*at).isList() && label) {
      o = operand(label);
    } else {
      o.kind = Operand::Kind::bad;
      o.site = siteOf(*at);
      o.text = fmt::format("expected a case such as (true (nd Box)), found {}",
                           (*at).isList() ? "an empty list" : fmt::format("'{}'", (*at).text()));
    }
    s.operands.push_back(std::move(o));
    const Element body = (*at).isList() ? (*at).at(1) : Element();
    s.blocks.push_back(body && body.isList() ? block(body) : Block());
  }
  return s;
}

Statement Compiler::call(std::string_view method, Position at, const Position& end, const Site& site) {
  Statement s;
  s.kind = Statement::Kind::call;
  s.site = site;
  s.text = method;
  // Of ours, poses of bodies as well: joints are attached at these poses, in any order of the text.
  s.immediate = (program_.ours && method == "setLocalPose") ||
                std::find(kImmediate.begin(), kImmediate.end(), method) != kImmediate.end();
  addOperands(s, at, end);
  return s;
}

Statement Compiler::set(Position at, const Position& end, const Site& site) {
  if (!(at != end) || (*at).isList())
    return failing(site, "expected the name of a property and its value after set, as in (set contactMu 0.5)");
  Statement s;
  s.kind = Statement::Kind::set;
  s.site = site;
  s.text = (*at).text();
  addOperands(s, ++at, end);
  return s;
}

void Compiler::addOperands(Statement& s, Position at, const Position& end) {
  for (; at != end; ++at) s.operands.push_back(operand(*at));
  s.constant =
      std::all_of(s.operands.begin(), s.operands.end(), [](const Operand& o) { return o.kind == Operand::Kind::text; });
  if (s.constant)
    for (const Operand& o : s.operands) s.arguments.emplace_back(o.text);
}

Operand Compiler::operand(const Element& e) {
  Operand o;
  o.site = siteOf(e);
  if (!e.isList()) {
    o.text = e.text();
    if (o.text.size() > 1 && o.text[0] == '$') {
      o.kind = Operand::Kind::variable;
      o.slot = slot(o.text);
    }
    return o;
  }
  const std::string_view head = e.head();
  if (head != "eval" && head != "join") {
    o.kind = Operand::Kind::bad;
    o.text =
        fmt::format("expected a text, a variable, (eval ...) or (join ...), found a list that begins with '{}'", head);
    return o;
  }
  o.kind = head == "eval" ? Operand::Kind::eval : Operand::Kind::join;
  Position at = e.begin();
  for (++at; at != e.end(); ++at) o.parts.push_back(operand(*at));
  return o;
}

std::size_t Compiler::slot(std::string_view variable) {
  auto& names = program_.variables;
  const auto found = std::find(names.begin(), names.end(), variable);
  if (found != names.end()) return found - names.begin();
  names.emplace_back(variable);
  return names.size() - 1;
}

/// True for the first word of a header.
bool isMagic(std::string_view word) {
  return word == "RSG" || word == "RubySceneGraph" || word == "RDS" || word == "RubyDeltaScene";
}

bool isDelta(std::string_view word) { return word == "RDS" || word == "RubyDeltaScene"; }

/// An Error at a location in a file.
Error errorAt(std::string_view resource, std::uint32_t line, std::uint32_t column, std::string_view text) {
  return Error(fmt::format("{}:{}:{}: {}", resource, line, column, text));
}

/// The second number of the version in a header, 1 or 2; 0 for anything else.
int versionOf(const Element& header) {
  const auto number = [&](std::size_t i) {
    return header.at(i) && header.at(i).isText() ? std::atoi(std::string(header.at(i).text()).c_str()) : -1;
  };
  if (!header.isList() || header.size() != 3 || !isMagic(header.head()) || number(1) != 0) return 0;
  // A delta scene changes nodes of others, in the installed base's way only.
  return number(2) == 1 ? 1 : number(2) == 2 && !isDelta(header.head()) ? 2 : 0;
}

/// As versionOf(), but throws Error for anything else.
int checkHeader(std::string_view resource, const Element& header) {
  if (const int version = versionOf(header)) return version;

  // The beginning of what was found instead.
  std::string found = header.isList() ? "(" : std::string(header.text());
  for (std::size_t i = 0; header.isList() && i < std::min<std::size_t>(header.size(), 4); ++i)
    found += (i ? " " : "") + (header.at(i).isList() ? "..." : std::string(header.at(i).text().substr(0, 32)));
  throw errorAt(resource, header.line(), header.column(),
                fmt::format("expected the header (RSG 0 1), (RSG 0 2) or (RDS 0 1), found {}{}", found.substr(0, 140),
                            header.isList() ? ")" : ""));
}

}  // namespace

bool looksLikeScene(std::string_view text) {
  Predicates header;
  readSexp(text, header, {8, 64}, 1);
  return !header.empty() && (*header.begin()).isList() && isMagic((*header.begin()).head());
}

bool isOurs(std::string_view text) {
  Predicates header;
  readSexp(text, header, {8, 64}, 1);
  return !header.empty() && versionOf(*header.begin()) == 2;
}

std::shared_ptr<const Program> compile(std::string_view resource, std::string_view text, const ReadingRules& rules) {
  // The header and the body are two lists.
  Predicates read;
  const ReadLimits limits{rules.maxDepth, 1u << 20};
  ReadResult result = readSexp(text, read, limits, 2);
  auto at = read.begin();
  const std::uint32_t endLine = std::max(result.line, 1u), endColumn = std::max(result.column, 1u);
  if (!(at != read.end()))
    throw errorAt(resource, endLine, endColumn,
                  result.message.empty() ? "expected the header (RSG 0 1), found nothing" : result.message);
  auto program = std::make_shared<Program>();
  program->resource = resource;
  program->ours = checkHeader(resource, *at) == 2;
  program->delta = isDelta((*at).head());

  // The body.
  ++at;
  if (!result.message.empty()) throw errorAt(resource, result.line, result.column, result.message);
  if (!(at != read.end()))
    throw errorAt(resource, endLine, endColumn, "expected the scene's body, a list, after the header, found nothing");
  if (!(*at).isList())
    throw Error(fmt::format("{}: expected the scene's body, a list, after the header, found '{}'",
                            where(*program, siteOf(*at)), (*at).text()));

  // Text after the body.
  if (!rules.looseTrailingParen || program->ours) {
    Predicates rest;
    const ReadResult more = readSexp(text.substr(result.consumed), rest, limits, 1);
    if (!rest.empty() || !more.message.empty())
      throw Error(fmt::format("{}: expected nothing after the body that begins here, found {}",
                              where(*program, siteOf(*at)), rest.empty() ? more.message : "more"));
  }
  program->body = Compiler(*program).block(*at);
  return program;
}

std::string where(const Program& program, const Site& site) {
  return fmt::format("{}:{}:{}", program.resource, site.line, site.column);
}

}  // namespace spark::rsg
