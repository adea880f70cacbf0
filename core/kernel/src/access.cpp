#include "spark/access.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "spark/class_object.h"
#include "spark/error.h"
#include "spark/running.h"

namespace spark {

namespace {
/// Throws Error for numbers out of the property's range. A number may be written as text.
void checkRange(const Property& p, const Value& v, bool loose) {
  if (!p.min && !p.max) return;
  if (v.isList()) {
    for (const Value& e : v.toList()) checkRange(p, e, loose);
  } else if (v.isNumber() || v.isString()) {
    Args args{std::span(&v, 1), loose};
    const double d = Convert<double>::from(args);
    if ((p.min && !(d >= *p.min)) || (p.max && !(d <= *p.max)))
      throw Error(fmt::format("expected {} to {}{}{}, found {}", p.min ? Value(*p.min).text() : "-inf",
                              p.max ? Value(*p.max).text() : "inf", p.unit.empty() ? "" : " ", p.unit, v.text()));
  }
}

void checkChoices(const Property& p, const Value& v) {
  if (p.choices.empty()) return;
  if (std::find(p.choices.begin(), p.choices.end(), v.plain()) != p.choices.end()) return;
  throw Error(fmt::format("expected one of '{}', found {}", fmt::join(p.choices, "', '"), v.text()));
}

/// The type of a parameter "name: type [unit]". Name and unit may be missing.
std::string_view typeOf(std::string_view parameter) {
  if (const std::size_t colon = parameter.find(": "); colon != std::string_view::npos)
    parameter.remove_prefix(colon + 2);
  return parameter.substr(0, parameter.find(" ["));
}

/// Reads typed texts among the arguments as the types that the method expects (Value::readAs).
std::vector<Value> readTyped(const Method& m, std::span<const Value> arguments) {
  constexpr std::string_view kListOf = "list of ";
  // Plain arguments that are the elements of a list have its element type; those of a vector have no type name.
  const bool each = arguments.size() == m.parameters.size();
  std::string_view type;
  if (!each && m.parameters.size() == 1 && typeOf(m.parameters[0]).starts_with(kListOf))
    type = typeOf(m.parameters[0]).substr(kListOf.size());
  std::vector<Value> out;
  for (std::size_t i = 0; i < arguments.size(); ++i)
    out.push_back(arguments[i].readAs(each ? typeOf(m.parameters[i]) : type));
  return out;
}
ClassObject& classFor(const Leaf& leaf) {
  if (!leaf.classObject()) throw Error(fmt::format("{} has no class", leaf.path()));
  return *leaf.classObject();
}

const Property& findProperty(const Leaf& leaf, std::string_view name) {
  ClassObject& c = classFor(leaf);
  if (const Property* p = c.property(name)) return *p;
  std::vector<std::string> names;
  for (const Property* p : c.properties()) names.push_back(p->name);
  throw Error(
      fmt::format("{} (class {}) has no property '{}'.{}", leaf.path(), c.name(), name, didYouMean(name, names)));
}

/// The method with its parameters, for messages.
std::string signature(const Method& m) { return fmt::format("{}({})", m.name, fmt::join(m.parameters, ", ")); }

/// The number of plain arguments, if lists are taken apart.
int scalarCount(std::span<const Value> arguments) {
  int n = 0;
  for (const Value& v : arguments) n += v.isList() ? static_cast<int>(v.toList().size()) : 1;
  return n;
}

/// "" unless there are clearly too few or too many arguments. A list may replace one argument or several.
std::string countProblem(const Method& m, std::span<const Value> arguments, bool loose) {
  const int scalars = scalarCount(arguments), count = static_cast<int>(arguments.size());
  const bool tooFew = scalars < m.minScalars && count < m.minScalars;
  const bool tooMany = m.maxScalars >= 0 && count > m.maxScalars && !(loose && m.surplusIgnored);
  if (!tooFew && !tooMany) return {};
  const std::string wanted = m.maxScalars < 0               ? fmt::format("at least {}", m.minScalars)
                             : m.maxScalars != m.minScalars ? fmt::format("{} to {}", m.minScalars, m.maxScalars)
                                                            : fmt::format("{}", m.minScalars);
  return fmt::format("{} expected {} arguments, found {}", signature(m), wanted, scalars);
}

/// One line for each text that loose conversion has read as a number although it is not one, if all parameters are
/// numbers.
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
      out += fmt::format("\n  '{}' is no number: it was read as {}.", v.toString(), Value(number).text());
  }
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

Value getProperty(const Leaf& leaf, std::string_view name) { return findProperty(leaf, name).get(leaf); }

void setProperty(Leaf& leaf, std::string_view name, const Value& value) {
  const Property& p = findProperty(leaf, name);
  if (!p.set) throw Error(fmt::format("{}.{} is read only", leaf.path(), name));
  const NowRunning now(p.name.c_str(), &leaf);
  try {
    const Value meant = value.readAs(p.type);
    Args args{std::span(&meant, 1)};
    writeProperty(p, leaf, args);
  } catch (const std::exception& e) {
    throw Error(fmt::format("cannot set {}.{}", leaf.path(), name), e);
  }
}

Value callMethod(Leaf& leaf, std::string_view name, std::span<const Value> arguments) {
  ClassObject& c = classFor(leaf);
  const Method* m = c.method(name);
  if (!m) {
    std::vector<std::string> names;
    for (const Method* q : c.methods()) names.push_back(q->name);
    throw Error(
        fmt::format("{} (class {}) has no method '{}'.{}", leaf.path(), c.name(), name, didYouMean(name, names)));
  }
  if (const std::string problem = countProblem(*m, arguments, false); !problem.empty())
    throw Error(fmt::format("cannot call {}: {}", leaf.path(), problem));
  const NowRunning now(m->name.c_str(), &leaf);
  try {
    std::vector<Value> meant;
    if (std::any_of(arguments.begin(), arguments.end(), [](const Value& v) { return v.isTyped(); }))
      arguments = meant = readTyped(*m, arguments);
    Args args{arguments};
    Value result = m->call(leaf, args);
    if (!args.atEnd())
      throw Error(fmt::format("{} expected fewer arguments, found {}", signature(*m), arguments.size()));
    return result;
  } catch (const std::exception& e) {
    throw Error(fmt::format("cannot call {} of {}", name, leaf.path()), e);
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
    whyNot = fmt::format("{}: {}{}", signature(method), e.what(), readAsNumbers(method, arguments));
    return false;
  }
}

}  // namespace spark
