#pragma once
/// \file
/// The kernel: the tree's root, the class registry, the loader of plugins; beside them events, log, random seed and
/// worker threads. No global state: several kernels live in one process.

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "spark/abi/spark/kernel.h"
#include "spark/class_object.h"
#include "spark/describe.h"
#include "spark/event.h"
#include "spark/in_use.h"
#include "spark/jobs.h"
#include "spark/loader.h"
#include "spark/log.h"
#include "spark/node.h"
#include "spark/plugin.h"
#include "spark/plugin_object.h"

namespace spark {

namespace detail {
class ClassRegistry;
}

/// One simulation's tree and what it is made with.
class Kernel {
 public:
  Kernel();
  ~Kernel();
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;

  /// The root "/". It has the children classes, plugins, sys, usr.
  Node& root();
  Events& events();
  Log& log();
  Loader& plugins();
  Jobs& jobs();

  /// The class of that name (a leading path as in "oxygen/Box" is ignored). Throws Error with the nearest names and the
  /// plugin that has it.
  ClassObject& classOf(std::string_view name);
  /// As classOf, nullptr when there is none.
  ClassObject* findClass(std::string_view name) const;
  /// Registers a class that is part of the host program itself. Throws Error when there is one of its name.
  template <class T>
  void registerClass() {
    addClass(describeClass<T>());
  }
  /// All classes by name.
  std::vector<ClassObject*> classes() const;
  /// Makes an object of `className` at an absolute path; missing parents are made as plain Nodes. Throws Error.
  Leaf& create(std::string_view className, std::string_view path);
  template <class T>
  T& create(std::string_view className, std::string_view path) {
    return *static_cast<T*>(create(className, path).requireAs(T::kInterface));
  }

  /// The seed of all random streams. To be set before the first draw.
  void setSeed(std::uint64_t seed);
  std::uint64_t seed() const;
  /// What a RandomStream of `owner` starts with: the seed, the owner's path and class, the purpose, and how many such
  /// streams there are. Thread safe.
  std::uint64_t streamSeed(const Leaf& owner, std::string_view purpose);

  /// Counts every change of the tree's shape and names: caches are valid while it stays. Valid as long as the kernel.
  const std::uint64_t& structureVersion() const;
  /// Lists and numbers all linked nodes in tree order if the shape changed since the last call; every emit begins with
  /// it. To be called by code that changes the tree and then collects from much of it. The simulation's thread only.
  void updateOrder();
  /// Makes all caches that go by structureVersion() be looked up again although the shape stays: what stands for
  /// something else changed at `leaf`, such as which scene is the active one.
  void markChanged(Leaf& leaf);
  /// The id of the object that was made last; later objects have greater ones.
  std::uint64_t lastId() const;

  /// Asks the host to end; safe from signal handlers and threads.
  void requestStop();
  bool stopRequested() const;
  /// True while the kernel is being destroyed: what leaves the tree then need not be replaced nor reported.
  bool isEnding() const;

  /// Counts a fault of a plugin or a script that was caught while the simulation ran: the log tells the first of each
  /// place only. Thread safe.
  void countFault();
  /// Faults caught so far. No state.
  std::int64_t faults() const;

  /// For the kernel's own sources, which alone know these classes.
  detail::Tree& tree();
  detail::ClassRegistry& registry();

 private:
  ClassObject& addClass(ClassDescription description);
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace spark
