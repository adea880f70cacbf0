#pragma once
/// \file
/// A kernel with every built plugin registered, and the order in which plugins need each other.

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

/// True if a property of this type holds numbers that may have a unit.
inline bool isNumeric(const std::string& type) {
  return type == "number" || type == "vec3" || type == "list of number";
}

}  // namespace spark::test
