#include "program.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include "spark/error.h"
#include "spark/predicates.h"

namespace spark::rsg {

namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kHeadAliases{{{"nd", "node"},
                                                                                     {"sel", "select"},
                                                                                     {"templ", "template"},
                                                                                     {"def", "define"},
                                                                                     {"att", "attach"},
                                                                                     {"SLT", "setLocalTransform"},
                                                                                     {"sSc", "setScale"},
                                                                                     {"sMat", "setMaterial"}}};
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kClassAliases{
    {{"BN", "BaseNode"}, {"SMN", "SingleMatNode"}, {"TRF", "Transform"}}};
/// The methods of the original's class Transform: calls of these names are done at once, whatever the class of the
/// node.
constexpr std::array<std::string_view, 10> kImmediate{
    "getFullPath",    "setName",     "getName",     "isLeaf",           "unlinkLeaf",
    "unlinkChildren", "importScene", "setLocalPos", "setLocalRotation", "setLocalTransform"};

template <std::size_t N>
std::string_view resolve(const std::array<std::pair<std::string_view, std::string_view>, N>& aliases,
                         std::string_view word) {
  for (const auto& [alias, name] : aliases)
    if (alias == word) return name;
  return word;
}

Site siteOf(const Element& e) { return {e.line(), e.column()}; }

Statement failing(const Site& site, std::string sentence) {
  Statement s;
  s.kind = Statement::Kind::error;
  s.site = site;
  s.text = std::move(sentence);
  return s;
}

class Compiler {
 public:
  explicit Compiler(Program& program) : program_(program) {}
  Block block(const Element& list);

 private:
  using Position = Element::Iterator;
  /// Compiles the statement that begins with the atom at `at`, and moves `at` behind it.
  Statement atom(Position& at, const Position& end, const Element& list);
  Statement parameters(Position at, const Position& end, const Site& site);
  Statement define(Position at, const Position& end, const Site& site);
  Statement choose(Position at, const Position& end, const Site& site);
  Statement call(std::string_view method, Position at, const Position& end, const Site& site);
  Operand operand(const Element& e);
  int slot(std::string_view variable);
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
  // All others take the rest of the list.
  const Position rest = std::exchange(at, end);
  if (named) return failing(s.site, "expected a name after '" + std::string(word) + "'");
  if (word == "template") return parameters(rest, end, s.site);
  if (word == "define") return define(rest, end, s.site);
  if (word == "switch") return choose(rest, end, s.site);
  return call(word, rest, end, s.site);
}

Statement Compiler::parameters(Position at, const Position& end, const Site& site) {
  Statement s;
  s.kind = Statement::Kind::parameters;
  s.site = site;
  for (; at != end && !(*at).isList(); ++at) {
    const std::string_view name = (*at).text();
    if (name.size() < 2 || name[0] != '$')
      return failing(siteOf(*at),
                     "expected a parameter such as '$size' in template, found '" + std::string(name) + "'");
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
    return failing(site, "expected a variable such as '$size' after define, found '" + std::string(name) + "'");
  s.slots.push_back(slot(name));
  if (!(++at != end)) return failing(site, "expected a value for " + std::string(name) + ", found nothing");
  s.operands.push_back(operand(*at));
  return s;
}

Statement Compiler::choose(Position at, const Position& end, const Site& site) {
  Statement s;
  s.kind = Statement::Kind::choose;
  s.site = site;
  if (!(at != end)) return failing(site, "expected a value after switch, found nothing");
  s.operands.push_back(operand(*at));
  for (++at; at != end; ++at) {
    const Element label = (*at).at(0);
    Operand o;
    if ((*at).isList() && label) {
      o = operand(label);
    } else {
      o.kind = Operand::Kind::bad;
      o.site = siteOf(*at);
      o.text = "expected a case such as (true (nd Box)), found " +
               ((*at).isList() ? "an empty list" : "'" + std::string((*at).text()) + "'");
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
  s.immediate = std::find(kImmediate.begin(), kImmediate.end(), method) != kImmediate.end();
  for (; at != end; ++at) s.operands.push_back(operand(*at));
  s.constant =
      std::all_of(s.operands.begin(), s.operands.end(), [](const Operand& o) { return o.kind == Operand::Kind::text; });
  if (s.constant)
    for (const Operand& o : s.operands) s.arguments.emplace_back(o.text);
  return s;
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
    o.text = "expected a text, a variable, (eval ...) or (join ...), found a list that begins with '" +
             std::string(head) + "'";
    return o;
  }
  o.kind = head == "eval" ? Operand::Kind::eval : Operand::Kind::join;
  Position at = e.begin();
  for (++at; at != e.end(); ++at) o.parts.push_back(operand(*at));
  return o;
}

int Compiler::slot(std::string_view variable) {
  auto& names = program_.variables;
  const auto found = std::find(names.begin(), names.end(), variable);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  names.emplace_back(variable);
  return static_cast<int>(names.size() - 1);
}

bool isMagic(std::string_view word) {
  return word == "RSG" || word == "RubySceneGraph" || word == "RDS" || word == "RubyDeltaScene";
}

std::string place(std::string_view resource, std::uint32_t line, std::uint32_t column) {
  return std::string(resource) + ":" + std::to_string(line) + ":" + std::to_string(column) + ": ";
}

void checkHeader(std::string_view resource, const Element& header) {
  const auto number = [&](std::size_t i) {
    return header.at(i) && header.at(i).isText() ? std::atoi(std::string(header.at(i).text()).c_str()) : -1;
  };
  if (header.isList() && header.size() == 3 && isMagic(header.head()) && number(1) == 0 && number(2) == 1) return;
  std::string found = header.isList() ? "(" : std::string(header.text());
  for (std::size_t i = 0; header.isList() && i < std::min<std::size_t>(header.size(), 4); ++i)
    found += (i ? " " : "") + (header.at(i).isList() ? "..." : std::string(header.at(i).text().substr(0, 32)));
  throw Error(place(resource, header.line(), header.column()) + "expected the header (RSG 0 1) or (RDS 0 1), found " +
              found.substr(0, 140) + (header.isList() ? ")" : ""));
}

}  // namespace

bool looksLikeScene(std::string_view text) {
  Predicates header;
  readSexp(text, header, {8, 64}, 1);
  return !header.empty() && (*header.begin()).isList() && isMagic((*header.begin()).head());
}

std::shared_ptr<const Program> compile(std::string_view resource, std::string_view text, const ReadingRules& rules) {
  Predicates read;
  const ReadLimits limits{rules.maxDepth, 1u << 20};
  ReadResult result = readSexp(text, read, limits, 2);
  auto at = read.begin();
  if (!(at != read.end()))
    throw Error(place(resource, std::max(result.line, 1u), std::max(result.column, 1u)) +
                (result.message.empty() ? "expected the header (RSG 0 1), found nothing" : result.message));
  checkHeader(resource, *at);
  auto program = std::make_shared<Program>();
  program->resource = resource;
  program->delta = (*at).head() == "RDS" || (*at).head() == "RubyDeltaScene";
  ++at;
  if (!result.message.empty()) throw Error(place(resource, result.line, result.column) + result.message);
  if (!(at != read.end()))
    throw Error(place(resource, std::max(result.line, 1u), std::max(result.column, 1u)) +
                "expected the scene's body, a list, after the header, found nothing");
  if (!(*at).isList())
    throw Error(where(*program, siteOf(*at)) + ": expected the scene's body, a list, after the header, found '" +
                std::string((*at).text()) + "'");
  if (!rules.looseTrailingParen) {
    Predicates rest;
    const ReadResult more = readSexp(text.substr(result.consumed), rest, limits, 1);
    if (!rest.empty() || !more.message.empty())
      throw Error(where(*program, siteOf(*at)) + ": expected nothing after the body that begins here, found " +
                  (rest.empty() ? more.message : "more"));
  }
  program->body = Compiler(*program).block(*at);
  return program;
}

std::string where(const Program& program, const Site& site) {
  return program.resource + ":" + std::to_string(site.line) + ":" + std::to_string(site.column);
}

}  // namespace spark::rsg
