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
#include "spark/script_text.h"

namespace spark {

/// Runs the scripts of one kernel, at /sys/server/script. Configs and trusted scripts share one Lua state; each
/// untrusted script has a state of its own with limits. The simulation's thread only.
///
/// Globals of a config: plugin, new, get, delete, option, include, log, on, and groups of variables (lua/README.md).
/// Scripts are deterministic: `pairs` is in order of key, `math.random` draws from a kernel stream, and there is no
/// clock and no access to files. Binary chunks are refused. State are the random numbers of each script and its table
/// `state`; what it keeps in other globals and in locals is not.
class ScriptServer : public Leaf, public IScriptServer, public IScriptText {
  SPARK_CLASS(ScriptServer, Leaf)
 public:
  /// Describes the class.
  static void describe(Description<ScriptServer>& d);
  ScriptServer();
  ~ScriptServer() override;
  /// Adds a folder in which scripts are searched. Folders are searched in the order in which they were added, and for
  /// configs after the working folder.
  void addFolder(std::filesystem::path folder);
  /// The folder in which configs are searched before all others, and scripts to attach after all others; without it
  /// that is the working folder.
  void setWorkingFolder(std::filesystem::path folder);
  /// Adds an override, as `--set KEY=VALUE` does. The key is an option, `Namespace.Name` or `/path.property`. What the
  /// config assigns to it is ignored. Throws Error for a malformed key.
  void addOverride(std::string key, Value value);
  /// Sets the members of nodes that were added by addOverride() since the config ran. Throws Error for an unknown
  /// member or a value that does not fit.
  void applyOverrides();
  /// Sets a global of configs, to be called before one runs. A list of pairs whose keys are strings becomes a table
  /// ({{"limit", 3}} is {limit = 3}), at any depth.
  void setGlobal(std::string_view name, const Value& value);
  /// Finds a config and runs it. Throws Error with file:line if it fails. Throws Error with the nearest names if an
  /// override has had no effect, or if a handler's channel does not exist.
  void runConfig(std::string_view file);
  /// Runs a chunk of text in the environment of configs and returns its first result. Throws Error if it fails.
  Value run(std::string_view text, std::string_view chunkName);
  void attach(Leaf& node, std::string_view file, const Value& arguments = {}) override;
  List attachText(Leaf& node, std::string_view text, std::string_view chunkName, bool trusted,
                  const Value& arguments = {}) override;
  /// From now on handlers that scripts add are looked through: a warning names each global and local in which one keeps
  /// what is neither saved nor hashed.
  void warnOfUnsaved();
  /// The options that configs have declared: [name, default, doc, value] each. Values of secrets are "".
  std::vector<List> options() const;
  /// The names of those that are secrets, such as tokens: recordings and spectators must not get their values.
  std::vector<std::string> secrets() const;

 protected:
  void onLink() override;
  void onUnlink() override;
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;  ///< also owned by the functions that run a script now
};

/// The script server of a kernel. The first call makes it.
ScriptServer& scripts(Kernel& kernel);

}  // namespace spark
