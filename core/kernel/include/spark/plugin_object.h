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

}  // namespace spark
