#pragma once
/// \file
/// The kernel: the tree, the class registry and the loader of plugins, with events, log, random seed and worker
/// threads. There is no global state, so that several kernels can run in one process.

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
#include "spark/sources.h"

namespace spark {

namespace detail {
class ClassRegistry;
}

/// One simulation: its tree and everything that belongs to it. Unless stated otherwise, only the simulation's thread
/// may use it.
class Kernel {
 public:
  /// A kernel with the classes and folders of an empty simulation.
  Kernel();
  /// Destroys the tree, then class objects, then unloads plugins.
  ~Kernel();
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;

  /// The root "/" with the children classes, plugins, sys and usr.
  Node& root();
  /// The event channels.
  Events& events();
  /// The log.
  Log& log();
  /// The loader of plugins.
  Loader& plugins();
  /// The worker threads.
  Jobs& jobs();

  /// The class of that name; a leading path as in "oxygen/Box" is ignored. Throws Error if there is none, with the
  /// plugin that provides it or the nearest names.
  ClassObject& classOf(std::string_view name);
  /// As classOf(), but returns nullptr if there is none.
  ClassObject* findClass(std::string_view name) const;
  /// Registers a class of the program itself. Throws Error if there is a class of that name.
  template <class T>
  void registerClass() {
    registerClass(describeClass<T>(), nullptr);
  }
  /// Registers a class that was described at run time, as one of a plugin (nullptr: of the program).
  ClassObject& registerClass(ClassDescription description, Plugin* plugin);
  /// All classes in order of name.
  std::vector<ClassObject*> classes() const;
  /// Makes an object of a class at an absolute path; missing parents are made as Nodes. Throws Error if there is no
  /// such class, if the path is not absolute or exists, and as Node::add().
  Leaf& create(std::string_view className, std::string_view path);
  /// As above, and returns the object as T. Throws Error also if the object is not a T.
  template <class T>
  T& create(std::string_view className, std::string_view path) {
    return *static_cast<T*>(create(className, path).requireAs(T::kInterface));
  }

  /// Sets the seed of all random streams (default 1). Must be called before the first draw.
  void setSeed(std::uint64_t seed);
  /// The seed of all random streams.
  std::uint64_t seed() const;
  /// A new seed for a RandomStream of `owner`: a hash of the kernel's seed, the owner's path and class, the purpose,
  /// and the number of earlier calls with the same three. Thread safe.
  std::uint64_t streamSeed(const Leaf& owner, std::string_view purpose);

  /// A counter of changes of the tree: objects that are added, removed, moved or renamed. A cache is valid while the
  /// counter is unchanged. The reference is valid for the lifetime of the kernel.
  const std::uint64_t& structureVersion() const;
  /// Lists and numbers all linked objects in tree order, if the tree has changed since the last call. Channel::emit
  /// calls it; so should code that changes the tree and then collects from large parts of it.
  void updateOrder();
  /// Increments structureVersion() although the tree is the same, because something that routes depend on has changed
  /// at `leaf`: for example which scene is the active one.
  void markChanged(Leaf& leaf);
  /// The id of the newest object, see Leaf::id.
  std::uint64_t lastId() const;

  /// Requests the end of the run. Safe in signal handlers and from any thread.
  void requestStop();
  /// True after requestStop(). Safe from any thread.
  bool stopRequested() const;
  /// True while the kernel is being destroyed: objects that are removed then need not be replaced or reported. Safe
  /// from any thread.
  bool isEnding() const;

  /// Counts an exception of a plugin or a script that was caught while the simulation ran; only the first one of each
  /// place is logged. Thread safe.
  void countFault();
  /// The number of faults so far. Not part of the state. Thread safe.
  std::int64_t faults() const;

  /// The texts that the simulation was made of.
  Sources& sources();
  /// Writes the state that no node has: how many streams have been seeded for which owner and purpose.
  void saveState(StateWriter& out) const;
  /// Reads what saveState() wrote. Throws Error where it does not fit.
  void loadState(StateReader& in);

  /// The class that changes the tree; defined in the kernel's own sources only.
  detail::Tree& tree();
  /// The class registry; defined in the kernel's own sources only.
  detail::ClassRegistry& registry();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace spark
