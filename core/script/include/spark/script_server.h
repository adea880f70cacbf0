#pragma once
/// \file
/// The script server: Lua 5.4.

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "spark/abi/spark/script_server.h"
#include "spark/kernel.h"
#include "spark/script.h"

namespace spark {

/// The scripts of one kernel, at /sys/server/script. Configs and trusted scripts share one Lua state; every untrusted
/// script has a limited one of its own.
///
/// Globals of a config: plugin, new, get, delete, option, include, log, on, groups of variables (see lua/README.md).
/// Deterministic: `pairs` goes by key, `math.random` draws from a kernel stream, no clock, no io; only text chunks.
class ScriptServer : public Leaf, public IScriptServer {
  SPARK_CLASS(ScriptServer, Leaf)
 public:
  static void describe(Description<ScriptServer>& d);
  ScriptServer();
  ~ScriptServer() override;
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
  void attach(Leaf& node, std::string_view file, const Value& arguments = {}) override;
  /// As attach for text. `trusted` false: nothing but computation and `self`, with limits on instructions and memory.
  void attachText(Leaf& node, std::string_view text, std::string_view chunkName, bool trusted);
  /// The options that the config declared: [name, default, doc, value] each.
  std::vector<List> options() const;

 protected:
  void onLink() override;
  void onUnlink() override;

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;  ///< kept by a script that runs
};

/// The kernel's script server; the first call makes it.
ScriptServer& scripts(Kernel& kernel);

}  // namespace spark
