#pragma once
/// \file
/// What loads plugins.

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
  std::map<std::string, std::string, std::less<>> unloaded_;  // files by name
  std::vector<std::string> leaving_;
};

}  // namespace spark
