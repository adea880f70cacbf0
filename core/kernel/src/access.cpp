#include "spark/access.h"

#include <algorithm>
#include <cstdlib>

#include "spark/class_object.h"
#include "spark/error.h"
#include "spark/running.h"

namespace spark {

namespace {
/// Numbers may come as text: what will be read from it is checked.
void checkRange(const Property& p, const Value& v, bool loose) {
  if (!p.min && !p.max) return;
  if (v.isList()) {
    for (const Value& e : v.toList()) checkRange(p, e, loose);
  } else if (v.isNumber() || v.isString()) {
    Args args{std::span(&v, 1), loose};
    const double d = Convert<double>::from(args);
    if ((p.min && !(d >= *p.min)) || (p.max && !(d <= *p.max)))
      throw Error("expected " + (p.min ? Value(*p.min).text() : std::string("-inf")) + " to " +
                  (p.max ? Value(*p.max).text() : std::string("inf")) + (p.unit.empty() ? "" : " " + p.unit) +
                  ", found " + v.text());
  }
}

void checkChoices(const Property& p, const Value& v) {
  if (p.choices.empty()) return;
  if (std::find(p.choices.begin(), p.choices.end(), v.plain()) != p.choices.end()) return;
  std::string all;
  for (const std::string& c : p.choices) all += (all.empty() ? "'" : ", '") + c + "'";
  throw Error("expected one of " + all + ", found " + v.text());
}

/// The type in `name: type [unit]`, of which only the type must be there.
std::string_view typeOf(std::string_view parameter) {
  if (const std::size_t colon = parameter.find(": "); colon != std::string_view::npos)
    parameter.remove_prefix(colon + 2);
  return parameter.substr(0, parameter.find(" ["));
}

/// What typed texts among the arguments mean for the method.
std::vector<Value> readTyped(const Method& m, std::span<const Value> arguments) {
  constexpr std::string_view kListOf = "list of ";
  const bool each = arguments.size() == m.parameters.size();
  std::string_view type;  // of plain arguments that together make a vector: none of its own
  if (!each && m.parameters.size() == 1 && typeOf(m.parameters[0]).starts_with(kListOf))
    type = typeOf(m.parameters[0]).substr(kListOf.size());
  std::vector<Value> out;
  for (std::size_t i = 0; i < arguments.size(); ++i)
    out.push_back(arguments[i].readAs(each ? typeOf(m.parameters[i]) : type));
  return out;
}
}  // namespace

void writeProperty(const Property& p, Leaf& leaf, Args& args) {
  for (const Value& v : args.values) {
    checkRange(p, v, args.loose);
    checkChoices(p, v);
  }
  p.set(leaf, args);
}
namespace {
ClassObject& classFor(const Leaf& leaf) {
  if (!leaf.classObject()) throw Error(leaf.path() + " has no class");
  return *leaf.classObject();
}

const Property& findProperty(const Leaf& leaf, std::string_view name) {
  ClassObject& c = classFor(leaf);
  if (const Property* p = c.property(name)) return *p;
  std::vector<std::string> names;
  for (const Property* p : c.properties()) names.push_back(p->name);
  throw Error(leaf.path() + " (class " + c.name() + ") has no property '" + std::string(name) + "'." +
              didYouMean(name, names));
}

std::string signature(const Method& m) {
  std::string out = m.name + "(";
  for (const std::string& p : m.parameters) out += (out.back() == '(' ? "" : ", ") + p;
  return out + ")";
}

int scalarCount(std::span<const Value> arguments) {
  int n = 0;
  for (const Value& v : arguments) n += v.isList() ? static_cast<int>(v.toList().size()) : 1;
  return n;
}

std::string countProblem(const Method& m, std::span<const Value> arguments, bool loose) {
  const int n = scalarCount(arguments);
  // One list may stand for one argument; only what is plainly too few or too many is refused here.
  const bool tooFew = n < m.minScalars && static_cast<int>(arguments.size()) < m.minScalars;
  const bool tooMany =
      m.maxScalars >= 0 && static_cast<int>(arguments.size()) > m.maxScalars && !(loose && m.surplusIgnored);
  if (!tooFew && !tooMany) return {};
  std::string wanted = std::to_string(m.minScalars);
  if (m.maxScalars < 0)
    wanted = "at least " + wanted;
  else if (m.maxScalars != m.minScalars)
    wanted += " to " + std::to_string(m.maxScalars);
  return signature(m) + " expected " + wanted + " arguments, found " + std::to_string(n);
}
/// What loose reading made of texts where numbers are due: " 'six' was read as 0.", "" when there are none.
std::string readAsNumbers(const Method& m, std::span<const Value> arguments) {
  const auto wantsNumbers = [](const std::string& parameter) {
    return parameter.find("number") != std::string::npos || parameter.find("integer") != std::string::npos ||
           parameter.find("vec3") != std::string::npos;
  };
  if (!std::all_of(m.parameters.begin(), m.parameters.end(), wantsNumbers)) return {};
  std::string out;
  for (const Value& v : arguments) {
    if (!v.isString()) continue;
    const char* text = v.toString().c_str();
    char* end = nullptr;
    const double number = std::strtod(text, &end);
    if (end == text || *end != 0)
      out += "\n  '" + v.toString() + "' is no number: it was read as " + Value(number).text() + ".";
  }
  return out;
}
}  // namespace

Value getProperty(const Leaf& leaf, std::string_view name) { return findProperty(leaf, name).get(leaf); }

void setProperty(Leaf& leaf, std::string_view name, const Value& value) {
  const Property& p = findProperty(leaf, name);
  if (!p.set) throw Error(leaf.path() + "." + std::string(name) + " is read only");
  const NowRunning now(p.name.c_str(), &leaf);
  try {
    const Value meant = value.readAs(p.type);
    Args args{std::span(&meant, 1)};
    writeProperty(p, leaf, args);
  } catch (const std::exception& e) {
    throw Error("cannot set " + leaf.path() + "." + std::string(name), e);
  }
}

Value callMethod(Leaf& leaf, std::string_view name, std::span<const Value> arguments) {
  ClassObject& c = classFor(leaf);
  const Method* m = c.method(name);
  if (!m) {
    std::vector<std::string> names;
    for (const Method* q : c.methods()) names.push_back(q->name);
    throw Error(leaf.path() + " (class " + c.name() + ") has no method '" + std::string(name) + "'." +
                didYouMean(name, names));
  }
  if (const std::string problem = countProblem(*m, arguments, false); !problem.empty())
    throw Error("cannot call " + leaf.path() + ": " + problem);
  const NowRunning now(m->name.c_str(), &leaf);
  try {
    std::vector<Value> meant;
    if (std::any_of(arguments.begin(), arguments.end(), [](const Value& v) { return v.isTyped(); }))
      arguments = meant = readTyped(*m, arguments);
    Args args{arguments};
    Value result = m->call(leaf, args);
    if (!args.atEnd())
      throw Error(signature(*m) + " expected fewer arguments, found " + std::to_string(arguments.size()));
    return result;
  } catch (const std::exception& e) {
    throw Error("cannot call " + std::string(name) + " of " + leaf.path(), e);
  }
}

bool callLoosely(Leaf& leaf, const Method& method, std::span<const Value> arguments, std::string& whyNot) {
  whyNot = countProblem(method, arguments, true);
  if (!whyNot.empty()) return false;
  const NowRunning now(method.name.c_str(), &leaf);
  try {
    Args args{arguments, true};
    method.call(leaf, args);
    return true;
  } catch (const RefusedValue&) {
    throw;
  } catch (const std::exception& e) {
    whyNot = signature(method) + ": " + e.what() + readAsNumbers(method, arguments);
    return false;
  }
}

}  // namespace spark
