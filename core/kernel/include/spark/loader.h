#pragma once
/// \file
/// The loader of plugins.

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "spark/abi/spark/loader.h"

namespace spark {

class ClassObject;
class Kernel;
class Plugin;

/// Finds, registers and unloads plugins. A plugin is loaded as a private copy of its file: overwriting the file does
/// not affect it, and unload() followed by use() loads the new version. The simulation's thread only.
class Loader {
 public:
  /// Made by the kernel only.
  explicit Loader(Kernel& kernel);
  /// Removes all classes of plugins and unloads the plugins.
  ~Loader();
  /// Loads all files `*.so` of a folder in order of name, reads their descriptors and lists them as /plugins/<name>.
  /// Files that are listed already are skipped. Files that cannot be used are logged and skipped; returns these
  /// messages.
  std::vector<std::string> scan(const std::filesystem::path& folder);
  /// Registers the classes of a plugin unless they are registered already. A plugin that was unloaded or has been
  /// rebuilt, and a file NAME.so that is new in a scanned folder, is loaded first. Throws Error if there is no such
  /// plugin (with the nearest names and the folders that were searched), if a class exists already, or if registering
  /// fails.
  Plugin& use(std::string_view name);
  /// Loads one file and registers its classes. Throws Error if either fails.
  Plugin& useFile(const std::filesystem::path& file);
  /// Removes the classes of a plugin and unmaps its file. Throws Error if objects of its classes exist (with the
  /// paths of some), if classes of other plugins derive from its classes, or if event handlers run.
  void unload(std::string_view name);
  /// As unload(), but while event handlers run it only checks, and the next settle() unloads the plugin or logs why it
  /// cannot. Throws Error as unload().
  void unloadLater(std::string_view name);
  /// Unloads the plugins for which unloadLater() was called by handlers. Run loops call it between two cycles.
  void settle() {
    if (!leaving_.empty()) unloadLeaving();
  }
  /// The listed plugin that provides a class, registered or not; nullptr if there is none.
  Plugin* providerOf(std::string_view className) const;
  /// The folders that were scanned.
  const std::vector<std::filesystem::path>& folders() const { return folders_; }

 private:
  Plugin& open(const std::filesystem::path& file);
  void registerPlugin(Plugin& plugin);
  void close(Plugin& plugin);
  void runActions(Plugin& plugin);
  Plugin* fromFile(const std::filesystem::path& file) const;
  Plugin* openAgain(std::string_view name);
  Plugin& unused(std::string_view name) const;
  std::vector<ClassObject*> classesOf(const Plugin& plugin) const;
  void unloadLeaving();
  Kernel& kernel_;
  std::vector<std::filesystem::path> folders_;
  std::map<std::string, std::string, std::less<>> unloaded_;  // files of unloaded plugins, by the plugins' names
  std::vector<std::string> leaving_;                          // names of plugins that settle() unloads
};

}  // namespace spark
