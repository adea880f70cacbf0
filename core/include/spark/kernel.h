#pragma once
/// \file
/// The kernel: root of the tree, class registry, plugins, events, random seed, log, Lua, worker threads. No global
/// state: several kernels live in one process.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "spark/abi/spark/kernel.h"
#include "spark/class_object.h"
#include "spark/event.h"
#include "spark/log.h"
#include "spark/node.h"
#include "spark/plugin.h"

namespace spark {

class Lua;
class Kernel;
class LoadedLibrary;

/// A plugin in the tree, `/plugins/<name>`: found by a scan, registered by a config line.
class Plugin : public Leaf {
  SPARK_CLASS(Plugin, Leaf)
 public:
  static void describe(Description<Plugin>& d);
  const std::string& version() const { return version_; }
  const std::string& doc() const { return doc_; }
  const std::string& file() const { return file_; }
  /// Names of the classes it provides, registered or not.
  const std::vector<std::string>& classes() const { return classes_; }
  bool registered() const { return registered_; }

 private:
  friend class Loader;
  std::string version_, doc_, file_;
  std::vector<std::string> classes_;
  std::vector<std::function<void()>> atUnload_;
  std::shared_ptr<LoadedLibrary> library_;
  const PluginDescriptor* descriptor_ = nullptr;
  bool registered_ = false;
};

/// Finds, registers and unloads plugins (libltdl). What is loaded is a private copy of the file as it was: whoever
/// overwrites the file does no harm, and loading again after unload() gives the new version.
class Loader {
 public:
  explicit Loader(Kernel& kernel);
  ~Loader();
  /// Reads the descriptors of all `*.so` in a folder (by name) and lists them under /plugins. What is no good is logged
  /// and skipped; returns the sentences that were logged. A file that is listed already is left alone.
  std::vector<std::string> scan(const std::filesystem::path& folder);
  /// Registers a scanned plugin's classes; does nothing when it is registered. A plugin that was unloaded, and a
  /// NAME.so that came into a scanned folder since, is loaded first. Throws Error: unknown name (with the nearest and
  /// the folders that were searched), duplicate class, what the plugin threw.
  Plugin& use(std::string_view name);
  /// Loads and registers one file. Throws Error.
  Plugin& useFile(const std::filesystem::path& file);
  /// Removes a plugin's classes and unmaps its file. Throws Error when objects of its classes live (lists their paths),
  /// classes of other plugins derive from them, or handlers of events run.
  void unload(std::string_view name);
  /// As unload; while handlers of events run it happens in the next settle(), where a late refusal is logged. Throws
  /// Error when it is refused already.
  void unloadLater(std::string_view name);
  /// Between two cycles, outside of all handlers: unloads what handlers asked for. For run loops.
  void settle() {
    if (!leaving_.empty()) unloadLeaving();
  }
  /// The scanned plugin that provides a class, nullptr when none does.
  Plugin* providerOf(std::string_view className) const;
  const std::vector<std::filesystem::path>& folders() const { return folders_; }

 private:
  friend class Kernel;
  Plugin& open(const std::filesystem::path& file);
  void registerPlugin(Plugin& plugin);
  void close(Plugin& plugin);
  void runActions(Plugin& plugin);
  void drop(ClassObject& c, bool leak);
  Plugin* fromFile(const std::filesystem::path& file) const;
  Plugin* openAgain(std::string_view name);
  Plugin& unused(std::string_view name) const;
  std::vector<ClassObject*> classesOf(const Plugin& plugin) const;
  void unloadLeaving();
  Kernel& kernel_;
  std::vector<std::filesystem::path> folders_;
  std::map<std::string, std::string, std::less<>> unloaded_;  // files by name
  std::vector<std::string> leaving_;
};

/// Runs the same function for 0..n-1 on several threads. Results must not depend on how many.
class Jobs {
 public:
  Jobs();
  ~Jobs();
  /// Total number of threads, the caller's included (1..64). Joins and starts threads; not to be called while run()
  /// runs.
  void setThreads(int count);
  int threads() const;
  /// Calls job(i) once for every i in [0, n) and returns when all are done. `job` must not throw and not change the
  /// tree.
  void run(std::size_t n, const std::function<void(std::size_t)>& job);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One house.
class Kernel {
 public:
  Kernel();
  ~Kernel();
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;

  /// The root "/". It has the children classes, plugins, sys, usr.
  Node& root() { return *root_; }
  Events& events() { return *events_; }
  Log& log() { return log_; }
  Loader& plugins() { return *loader_; }
  Lua& lua() { return *lua_; }
  Jobs& jobs() { return jobs_; }

  /// The class of that name (a leading path as in "oxygen/Box" is ignored). Throws Error with the nearest names and the
  /// plugin that has it.
  ClassObject& classOf(std::string_view name);
  /// As classOf, nullptr when there is none.
  ClassObject* findClass(std::string_view name) const;
  /// Registers a class that is part of the host program itself.
  template <class T>
  void registerClass() {
    addClass(describeClass<T>(), nullptr);
  }
  /// All classes by name.
  std::vector<ClassObject*> classes() const;
  /// Makes an object of `className` at an absolute path; missing parents are made as plain Nodes. Throws Error.
  Leaf& create(std::string_view className, std::string_view path);
  template <class T>
  T& create(std::string_view className, std::string_view path) {
    Leaf& leaf = create(className, path);
    if (T* t = leaf.as<T>()) return *t;
    throwLacks(leaf, T::kInterface);
  }

  /// The seed of all random streams. To be set before the first draw.
  void setSeed(std::uint64_t seed) { seed_ = seed; }
  std::uint64_t seed() const { return seed_; }

  /// Counts every change of the tree's shape and names: caches are valid while it stays.
  const std::uint64_t& structureVersion() const { return structureVersion_; }
  /// Lists and numbers all linked nodes in tree order if the shape changed since the last call; every emit begins with
  /// it. Whoever changes the tree and then collects from much of it calls it in between. The simulation's thread only.
  void updateOrder();
  /// Makes all caches that go by structureVersion() be looked up again, although nobody came or went: what stands for
  /// something else changed at `leaf`, such as which scene is the active one.
  void markChanged(Leaf& leaf);
  /// The id of the object that was made last; whatever is made from now on has a greater one.
  std::uint64_t lastId() const { return nextId_ - 1; }

  /// Asks the host to end; safe from signal handlers and threads.
  void requestStop() { stop_.store(true); }
  bool stopRequested() const { return stop_.load(); }

  /// Counts a fault of a plugin or a script that was caught while the simulation ran: the log tells the first of each
  /// place only.
  void countFault() { faults_.fetch_add(1, std::memory_order_relaxed); }
  /// Faults caught so far. No state.
  std::int64_t faults() const { return faults_.load(std::memory_order_relaxed); }

 private:
  friend class Leaf;
  friend class Node;
  friend class Loader;
  friend class RandomStream;
  friend class ClassObject;
  friend class InUse;
  [[noreturn]] static void throwLacks(const Leaf& leaf, const InterfaceId& id);
  ClassObject& addClass(ClassDescription description, Plugin* plugin);
  /// Throws Error when `leaf`, or what is below it, is in use; to be renamed: also when its name is kept. `doing`:
  /// "cannot remove /a now".
  static void refuseUsed(const Leaf& leaf, bool rename, const std::string& doing);
  std::uint64_t streamSeed(const Leaf& owner, std::string_view purpose);
  /// The shape, or a name, changed at `node` or right below it.
  void changed(Node* node);
  void enumerate(Leaf& leaf, std::uint32_t& post);

  Log log_;
  Jobs jobs_;
  std::unique_ptr<Events> events_;
  std::unique_ptr<Node> root_;
  std::unique_ptr<Loader> loader_;
  std::unique_ptr<Lua> lua_;
  std::map<std::string, ClassObject*, std::less<>> classIndex_;
  Node* classesNode_ = nullptr;
  Node* pluginsNode_ = nullptr;
  std::uint64_t seed_ = 1, structureVersion_ = 1, orderedAt_ = 0, nextId_ = 1;
  std::vector<Leaf*> order_;  // by preOrder_; valid while orderedAt_ is the structure's version
  int changing_ = 0;          // leaves that are being linked, moved or unlinked
  InUse* inUse_ = nullptr;    // the newest first
  std::map<std::uint64_t, std::uint32_t> streamOrdinals_;
  std::mutex streamMutex_;
  std::atomic<bool> stop_{false};
  std::atomic<std::int64_t> faults_{0};
};

/// The script side, Lua 5.4. Configs and trusted scripts share one state; every untrusted script has a limited one of
/// its own.
///
/// Globals of a config: plugin, new, get, delete, option, include, log, on, groups of variables (see lua/README.md).
/// Deterministic: `pairs` goes by key, `math.random` draws from a kernel stream, no clock, no io; only text chunks.
class Lua {
 public:
  explicit Lua(Kernel& kernel);
  ~Lua();
  /// Folders in which configs, `include` and attached scripts are looked up, in order; the working folder comes first.
  void addFolder(std::filesystem::path folder);
  /// What `--set KEY=VALUE` gives: an option, `Namespace.Name` or `/path.property`. An override wins over what the
  /// config sets.
  void addOverride(std::string key, Value value);
  /// Sets a global of configs before one runs, such as `host` of house.lua, which describes the program. A list of
  /// pairs whose keys are words is a table there ({{"limit", 3}} is {limit = 3}), at any depth.
  void setGlobal(std::string_view name, const Value& value);
  /// Runs a config: a file name, looked up as said. Throws Error with the script's file:line. Afterwards all overrides
  /// must have met their target, else Error with the nearest names.
  void runConfig(std::string_view file);
  /// Runs a chunk of text in the config's environment and returns its first result. Throws Error.
  Value run(std::string_view text, std::string_view chunkName);
  /// Attaches a script file to a node: it runs at once with `self` set to the node, in an environment of its own, and
  /// may subscribe to events with on(). It goes with the node. `arguments`: what the script reads with `local args =
  /// ...`; a list of pairs whose keys are words is a table there ({{"limit", 3}} is {limit = 3}). Throws Error.
  void attach(Leaf& node, std::string_view file, const Value& arguments = {});
  /// As attach for text. `trusted` false: nothing but computation and `self`, with limits on instructions and memory.
  void attachText(Leaf& node, std::string_view text, std::string_view chunkName, bool trusted);
  /// The options that the config declared: [name, default, doc, value] each.
  std::vector<List> options() const;

 private:
  friend class Kernel;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spark
