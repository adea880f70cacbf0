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
  /// Registers a class. `plugin` nullptr: a class of the program itself. Throws Error if there is a class of that name.
  ClassObject& add(ClassDescription description, Plugin* plugin);
  /// Removes a class. `leak`: its class object stays in memory, because objects of the class still exist.
  void drop(ClassObject& c, bool leak);
  /// Moves the classes that were registered before the tree existed to /classes.
  void hang();
  /// Removes all class objects from /classes and returns them: they must outlive the tree.
  std::vector<std::unique_ptr<Leaf>> takeAll();
  /// The class of that name, without a leading path; nullptr if there is none.
  ClassObject* find(std::string_view name) const;
  /// All classes in order of name.
  const std::map<std::string, ClassObject*, std::less<>>& all() const { return index_; }

 private:
  Kernel& kernel_;
  std::map<std::string, ClassObject*, std::less<>> index_;
  ClassObject* classOfClasses_ = nullptr;  ///< nullptr until it is registered
};

}  // namespace spark::detail
