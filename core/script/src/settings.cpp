#include "settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "members.h"

// The key of an override is `option`, `Namespace.Name` (short for /sys/variables/Namespace.Name) or `/path.property`. A
// member of a node is set as soon as the node exists, so that a scene that is imported next already uses it. What the
// config assigns to it is ignored.

namespace spark::script {

namespace {
/// Converts a value to the type of the default. Throws Error if that is not possible.
Value fitted(const Value& given, const Value& defaultValue) {
  using Type = Value::Type;
  Value value = given.readAs(defaultValue.isNil() ? std::string_view() : typeName(defaultValue.type()));
  if (defaultValue.isNil() || value.type() == defaultValue.type()) return value;
  switch (defaultValue.type()) {
    case Type::number:
      if (value.isInteger()) return value.toNumber();
      break;
    case Type::integer:
      // A double without fraction that an integer can hold.
      if (value.isNumber() && std::floor(value.toNumber()) == value.toNumber() && std::fabs(value.toNumber()) < 0x1p62)
        return static_cast<std::int64_t>(value.toNumber());
      break;
    case Type::string:
      if (!value.isList() && !value.isNil()) return value.plain();
      break;
    default:
      break;
  }
  throw Error(fmt::format("expected {} (its default is {}), found {} {}", typeName(defaultValue.type()),
                          defaultValue.text(), typeName(value.type()), value.text()));
}

void checkChoice(const Value& value, const List& choices) {
  if (choices.empty() || std::find(choices.begin(), choices.end(), value) != choices.end()) return;
  std::vector<std::string> texts;
  for (const Value& c : choices) texts.push_back(c.text());
  throw Error(fmt::format("expected one of {}, found {}", fmt::join(texts, ", "), value.text()));
}

void collectPaths(const Leaf& leaf, std::vector<std::string>& out) {
  out.push_back(leaf.path());
  if (const Node* node = leaf.asNode())
    for (const auto& c : node->children()) collectPaths(*c, out);
}
}  // namespace

void Settings::add(std::string key, Value value) {
  Override o;
  o.key = std::move(key);
  o.value = std::move(value);
  const std::size_t dot = o.key.rfind('.');
  if (!o.key.empty() && o.key.front() == '/') {
    if (dot == std::string::npos || dot < o.key.rfind('/') || dot + 1 == o.key.size())
      throw Error(fmt::format("cannot set '{}': expected /path.property, as in /sys/server/simulation.step", o.key));
    o.path = o.key.substr(0, dot);
    if (o.path.empty()) o.path = "/";
    o.member = o.key.substr(dot + 1);
  } else if (dot != std::string::npos) {
    o.path = fmt::format("/sys/variables/{}", o.key.substr(0, dot));
    o.member = o.key.substr(dot + 1);
  }
  std::erase_if(overrides_, [&](const Override& other) { return other.key == o.key; });
  overrides_.push_back(std::move(o));
}

Value Settings::declare(const std::string& name, const Value& defaultValue, const std::string& doc, const List& choices,
                        bool secret) {
  if (name.empty() || name.find_first_of("./= ") != std::string::npos)
    throw Error(fmt::format(
        "cannot declare option '{}': a name must be there and must not hold '.', '/', '=' or a blank", name));

  // Two configs may declare an option in the same way.
  const auto same = std::find_if(options_.begin(), options_.end(), [&](const Option& o) { return o.name == name; });
  if (same != options_.end()) {
    same->secret |= secret;
    if (same->defaultValue == defaultValue && same->choices == choices) return same->value;
    throw Error(
        fmt::format("option '{}' is declared already, with another default or other choices (its default was {})", name,
                    same->defaultValue.text()));
  }

  Option option{name, doc, defaultValue, defaultValue, choices, secret};
  try {
    if (!defaultValue.isNil()) checkChoice(defaultValue, choices);
  } catch (const Error& e) {
    throw Error(fmt::format("the default of option '{}' is not among its choices", name), e);
  }
  for (Override& o : overrides_) {
    if (!o.path.empty() || o.key != name) continue;
    try {
      option.value = fitted(o.value, defaultValue);
      checkChoice(option.value, choices);
    } catch (const Error& e) {
      throw Error(fmt::format("cannot set option '{}'", name), e);
    }
    o.met = true;
  }
  options_.push_back(option);
  return option.value;
}

/// Sets the member of a node.
void Settings::set(Override& o, Leaf& target) {
  if (isGroup(target)) {
    o.met = o.met || hasMember(target, o.member);
  } else if (!hasMember(target, o.member)) {
    throw Error(fmt::format("unknown setting '{}': {} (class {}) has no property '{}'.{}", o.key, target.path(),
                            target.classObject()->name(), o.member, memberHint(target, o.member, memberNames(target))));
  } else {
    o.met = true;
  }
  setMember(target, o.member, o.value);
  o.target = Ref<Leaf>(&target);
}

void Settings::apply() {
  for (Override& o : overrides_) {
    if (o.path.empty()) continue;
    Leaf* target = kernel_.root().find(o.path);
    if (target && target != o.target.get()) set(o, *target);
  }
}

bool Settings::shields(const Leaf& leaf, std::string_view member) {
  for (Override& o : overrides_) {
    if (o.path.empty() || o.member != member) continue;
    Leaf* target = kernel_.root().find(o.path);
    if (target != &leaf) continue;
    if (target != o.target.get()) set(o, *target);
    o.met = true;
    kernel_.log().debug("{} stays {}: it was set from outside the config", o.key, o.value.text());
    return true;
  }
  return false;
}

/// The keys most similar to one that has had no effect, as a sentence.
std::string Settings::hint(const Override& o) const {
  std::vector<std::string> names;
  // Options, and variables as Namespace.Name.
  if (o.key.empty() || o.key.front() != '/') {
    for (const Option& option : options_) names.push_back(option.name);
    if (const auto* groups = kernel_.root().find<Node>("/sys/variables"))
      for (const auto& g : groups->children())
        for (const std::string& n : memberNames(*g)) names.push_back(fmt::format("{}.{}", g->name(), n));
    std::erase(names, o.key);
    // A property of a server is set by its path.
    if (const auto* servers = kernel_.root().find<Node>("/sys/server"))
      for (const auto& s : servers->children())
        if (s->classObject()->property(o.key)) return fmt::format(" Did you mean '{}.{}'?", s->path(), o.key);
    return didYouMean(o.key, names);
  }
  // The same member of other nodes.
  collectPaths(kernel_.root(), names);
  for (std::string& n : names) n.append(".").append(o.member);
  return didYouMean(o.key, names);
}

void Settings::finish() {
  apply();
  std::vector<std::string> problems;
  for (const Override& o : overrides_) {
    if (o.met) continue;
    std::string what = "the config declares no option of that name.";
    if (!o.path.empty())
      what =
          o.target ? fmt::format("{} has no variable of that name.", o.path) : fmt::format("there is no {}.", o.path);
    problems.push_back(fmt::format("unknown setting '{}': {}{}", o.key, what, hint(o)));
  }
  if (!problems.empty()) throw Error(fmt::format("{}", fmt::join(problems, "\n")));
}

std::vector<List> Settings::options() const {
  std::vector<List> out;
  for (const Option& o : options_) out.push_back({o.name, o.defaultValue, o.doc, o.secret ? Value("") : o.value});
  return out;
}

std::vector<std::string> Settings::secrets() const {
  std::vector<std::string> out;
  for (const Option& o : options_)
    if (o.secret) out.push_back(o.name);
  return out;
}

}  // namespace spark::script
