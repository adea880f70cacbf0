#include "members.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "spark/class_object.h"
#include "spark/error.h"
#include "spark/kernel.h"

namespace spark::script {

// A group is recognised by its members, because core has no interface for it.

bool isGroup(const Leaf& leaf) {
  ClassObject& c = *leaf.classObject();
  return c.method("get") && c.method("set") && c.property("names");
}

bool hasMember(const Leaf& leaf, std::string_view name) {
  if (leaf.classObject()->property(name)) return true;
  if (!isGroup(leaf)) return false;
  const std::vector<std::string> names = memberNames(leaf);
  return std::find(names.begin(), names.end(), name) != names.end();
}

void setMember(Leaf& leaf, std::string_view name, const Value& value) {
  if (!leaf.classObject()->property(name) && isGroup(leaf))
    callMethod(leaf, "set", std::array<Value, 2>{Value(name), value});
  else
    setProperty(leaf, name, value);
}

std::vector<std::string> memberNames(const Leaf& leaf) {
  std::vector<std::string> names;
  for (const Property* p : leaf.classObject()->properties()) names.push_back(p->name);
  if (isGroup(leaf)) {
    const Value variables = getProperty(leaf, "names");
    for (const Value& n : variables.toList()) names.push_back(n.plain());
  }
  return names;
}

std::string memberHint(const Leaf& leaf, std::string_view name, const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 3;
  std::vector<std::string> owners;
  for (ClassObject* c : leaf.kernel().classes())
    if (c->property(name) && !(c->base() && c->base()->property(name))) owners.push_back(c->name());
  std::string hint = didYouMean(name, names);
  if (owners.empty() || owners.size() > kMost) return hint;
  std::sort(owners.begin(), owners.end());
  return fmt::format("{} {} {} a property of that name.", hint, fmt::join(owners, ", "),
                     owners.size() == 1 ? "has" : "have");
}

}  // namespace spark::script
