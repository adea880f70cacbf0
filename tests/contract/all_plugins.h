#pragma once
/// \file
/// A kernel with every built plugin registered, and the order in which plugins need each other.

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "spark/error.h"
#include "test_support.h"

namespace spark::test {

/// All plugins found by the scan.
inline std::vector<Plugin*> pluginsOf(Kernel& kernel) {
  std::vector<Plugin*> out;
  for (const auto& p : kernel.root().child("plugins")->asNode()->children()) out.push_back(p->as<Plugin>());
  return out;
}

/// A kernel in which every built plugin is registered.
struct AllPlugins : TestHost {
  AllPlugins() {
    for (Plugin* p : pluginsOf(kernel)) kernel.plugins().use(p->name());
  }
  /// The classes of one plugin.
  std::vector<ClassObject*> classesOf(const Plugin& plugin) {
    std::vector<ClassObject*> out;
    for (ClassObject* c : kernel.classes())
      if (c->plugin() == &plugin) out.push_back(c);
    return out;
  }
};

/// A different valid value of the property; nil if none is known.
inline Value another(const Property& p, const Value& v) {
  if (v.isBool()) return !v.toBool();
  if (!p.choices.empty()) return p.choices.front() == v.plain() ? p.choices.back() : p.choices.front();
  if (!v.isNumber()) return {};
  double d = v.toNumber() + 1;
  if (p.max && d > *p.max) d = *p.max;
  if (p.min && d < *p.min) d = *p.min;
  return v.isInteger() ? Value(static_cast<std::int64_t>(d)) : Value(d);
}

/// As another(), and for lists of numbers with another first one.
inline Value anotherOrList(const Property& p, const Value& v) {
  if (!v.isList() || v.toList().empty() || !v.toList()[0].isNumber()) return another(p, v);
  List list = v.toList();
  list[0] = another(p, list[0]);
  return list;
}

/// True if a property of this type holds numbers that may have a unit.
inline bool isNumeric(const std::string& type) {
  return type == "number" || type == "vec3" || type == "list of number";
}

}  // namespace spark::test
