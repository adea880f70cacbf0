#pragma once
/// \file
/// Plugins in the tree.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "spark/abi/spark/plugin_object.h"
#include "spark/leaf.h"

namespace spark {

class LoadedLibrary;
struct PluginDescriptor;

/// A plugin in the tree, `/plugins/<name>`. The loader makes it when it finds the file; a config registers it.
class Plugin : public Leaf {
  SPARK_CLASS(Plugin, Leaf)
 public:
  /// Describes the class.
  static void describe(Description<Plugin>& d);
  /// The plugin's own version.
  const std::string& version() const { return version_; }
  /// One sentence about the plugin.
  const std::string& doc() const { return doc_; }
  /// The absolute path of its file.
  const std::string& file() const { return file_; }
  /// The names of the classes it provides, also before they are registered.
  const std::vector<std::string>& classes() const { return classes_; }
  /// True if its classes are registered.
  bool registered() const { return registered_; }
  /// True if its file has other code by now than the one that was loaded from it.
  bool hasOtherCode() const;

 private:
  friend class Loader;
  void unload();
  std::string version_, doc_, file_;
  std::vector<std::string> classes_;
  std::vector<std::function<void()>> atUnload_;
  std::shared_ptr<LoadedLibrary> library_;
  const PluginDescriptor* descriptor_ = nullptr;
  bool registered_ = false;
};

}  // namespace spark
