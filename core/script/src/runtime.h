#pragma once
/// \file
/// Private to the script server: all scripts of one kernel.

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "memory.h"
#include "settings.h"
#include "spark/kernel.h"
#include "state.h"
#include "subscription.h"

namespace spark::script {

/// A script file.
struct Script {
  std::filesystem::path path;
  std::string text;
};

/// Finds, reads and runs the scripts of a kernel.
class Runtime : public std::enable_shared_from_this<Runtime> {
 public:
  explicit Runtime(Kernel& kernel);
  ~Runtime();
  /// Closes all Lua states.
  void close();

  /// Finds and reads a config: in the working folder, in the folder of the running config, in the folders. Throws Error
  /// with the folders that were searched.
  Script readConfig(std::string_view file);
  /// Finds and reads a file that a script includes: in the folder of that script, in the folder of the running config,
  /// in the folders. `includer`: the Lua thread that calls include(). Throws as readConfig().
  Script readInclude(std::string_view file, lua_State* includer);
  /// Finds a script (as an include, then in the working folder) and attaches it. `from`: the Lua thread that attaches
  /// it, nullptr if none does. Throws as readConfig() and attach().
  void attachFile(Leaf& node, std::string_view file, lua_State* from, const State::Body& pushArguments);
  /// Checks the channels of handlers and hooks after a config. If a handler's channel is undefined and its name is
  /// similar to that of a defined one, throws Error; such a hook of a class that has objects is logged.
  void checkChannels();
  /// Compiles text and pushes the function, whose environment is the table at `environment` (an absolute index or an
  /// upvalue). Raises a Lua error.
  static void load(lua_State* L, std::string_view text, std::string_view chunkName, int environment);
  /// Pushes the environment that all configs share.
  void pushConfigEnvironment(lua_State* L);
  /// Sets a global of configs, see ScriptServer::setGlobal.
  void setGlobal(std::string_view name, const Value& value);
  /// Runs a chunk in the environment of configs and returns its first result. Throws Error.
  Value run(std::string_view text, std::string_view chunkName);
  /// Runs a chunk in an environment of its own for `node`. `pushArguments` pushes the chunk's arguments (`...`); empty:
  /// it has none. Returns its first result. Throws Error; handlers that the chunk has added are then removed.
  List attach(Leaf& node, std::string_view text, std::string_view chunkName, bool trusted,
              const State::Body& pushArguments = {});
  /// Pops a function and adds it as a handler at `node`. Throws Error if the channel does not exist and its name is
  /// similar to that of another one.
  std::shared_ptr<Subscription> subscribe(lua_State* L, Leaf& node, std::string_view channel);
  /// Logs the failure of a handler, unless it only repeats one of the same line.
  void report(const Failure& failure, const Subscription& subscription);

  Kernel& kernel;
  Settings settings;
  std::vector<std::filesystem::path> folders;                ///< searched for scripts
  std::filesystem::path workingFolder;                       ///< of the user; empty: that of the process
  std::shared_ptr<State> trusted;                            ///< the state of all trusted scripts
  std::vector<std::weak_ptr<State>> sandboxes;               ///< the states of untrusted scripts
  Memory memory;                                             ///< what scripts keep
  std::filesystem::path configFolder;                        ///< of the running config, or else of the last one
  bool warnsOfUnsaved = false;                               ///< see ScriptServer::warnOfUnsaved()
  bool inConfig = false;                                     ///< a config runs: overrides shield members
  Ref<Leaf> scriptNode;                                      ///< of the running script; the root for configs
  std::vector<std::weak_ptr<Subscription>>* made = nullptr;  ///< collects the handlers of a script that is attached now

 private:
  Script read(std::string_view file, std::string_view what, std::vector<std::filesystem::path> places);
  std::filesystem::path folderOf(lua_State* L) const;
  std::filesystem::path userFolder() const;
  bool isChannel(std::string_view name) const;
  std::string nearChannels(std::string_view name) const;

  int configEnvironment_ = LUA_NOREF;                                  ///< reference; made on demand
  std::set<std::string> reported_;                                     ///< places of failures that were logged
  std::map<std::string, std::filesystem::path, std::less<>> origins_;  ///< folders of the files read, by chunk name
  std::vector<std::pair<std::string, std::string>> listened_;  ///< undefined channels of handlers, and file:line
};

}  // namespace spark::script
