#pragma once
/// \file
/// Private to the kernel: all classes by name, owned by /classes.

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "spark/class_object.h"

namespace spark::detail {

/// The classes of one kernel.
class ClassRegistry {
 public:
  explicit ClassRegistry(Kernel& kernel) : kernel_(kernel) {}
  /// Registers a class; `plugin` nullptr: the program's own. Throws Error when there is one of its name.
  ClassObject& add(ClassDescription description, Plugin* plugin);
  /// Removes a class. `leak`: its object stays in memory, since objects of it are left.
  void drop(ClassObject& c, bool leak);
  /// Hangs the classes that came before the tree into /classes.
  void hang();
  /// Takes all class objects out of /classes: they outlive the tree.
  std::vector<std::unique_ptr<Leaf>> takeAll();
  /// nullptr when there is none. A leading path is ignored.
  ClassObject* find(std::string_view name) const;
  const std::map<std::string, ClassObject*, std::less<>>& all() const { return index_; }

 private:
  Kernel& kernel_;
  std::map<std::string, ClassObject*, std::less<>> index_;
  ClassObject* classOfClasses_ = nullptr;
};

}  // namespace spark::detail
