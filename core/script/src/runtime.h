#pragma once
/// \file
/// Private to the script server: states with limits, environments, nodes as userdata, settings.
///
/// Trusted scripts (configs, attached files) share one Lua state. Every untrusted script has a state of its own with a
/// memory limit, so that nothing it does to its tables reaches the others. A state is entered through State::run only:
/// it gives the script a stack of its own, an instruction budget and a traceback. Lua's errors are C++ exceptions
/// (lua5.4-c++): destructors run, and `guarded` turns std::exception into Lua errors with file:line.

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <lua.hpp>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "spark/error.h"
#include "spark/event.h"
#include "spark/kernel.h"
#include "spark/random.h"

namespace spark::script {

class Runtime;

/// Instructions that a run may take: set-up of trusted scripts, one trusted event handler, anything untrusted.
inline constexpr std::int64_t kUnlimited = std::numeric_limits<std::int64_t>::max() / 4;
inline constexpr std::int64_t kHandlerBudget = 50'000'000;
inline constexpr std::int64_t kSandboxBudget = 1'000'000;
/// Bytes of memory or text that cost as much as an instruction.
inline constexpr std::size_t kBytesPerInstruction = 16;
/// Bytes that an untrusted script may hold.
inline constexpr std::size_t kSandboxMemory = 2u << 20;
/// How often scripts may enter each other (a handler that raises an event that ...).
inline constexpr std::size_t kMaxDepth = 16;

/// What went wrong in a run. `text` starts with file:line and ends with the traceback; `where` is file:line alone, ""
/// when unknown.
struct Failure {
  std::string text, where;
  bool exhausted = false;  ///< the budget was used up
};

/// Gives a variable a value for a while.
template <class T>
class Restore {
 public:
  template <class U>
  Restore(T& variable, U&& value) : variable_(variable), before_(variable) {
    variable = std::forward<U>(value);
  }
  ~Restore() { variable_ = before_; }
  Restore(const Restore&) = delete;
  Restore& operator=(const Restore&) = delete;

 private:
  T& variable_;
  T before_;
};
template <class T, class U>
Restore(T&, U&&) -> Restore<T>;

/// One Lua state.
class State : public std::enable_shared_from_this<State> {
 public:
  using Body = std::function<void(lua_State*)>;

  /// `sandbox`: the node of an untrusted script; nullptr makes the trusted state.
  State(Runtime& runtime, Leaf* sandbox);
  ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  /// The state that a Lua thread belongs to.
  static State& of(lua_State* L) { return **static_cast<State**>(lua_getextraspace(L)); }
  Runtime& runtime() { return runtime_; }
  bool trusted() const { return trusted_; }
  /// True when scripts of this state may touch `leaf`: all may the trusted one, its node and what is below an untrusted
  /// one.
  bool allows(const Leaf& leaf) const;

  /// Runs `body` in protected mode on an empty stack. Nothing when all went well.
  std::optional<Failure> run(std::int64_t budget, const Body& body);
  /// Takes instructions off the running script's budget, for C functions whose work depends on their arguments. Lua
  /// error when it is used up.
  void charge(lua_State* L, std::uint64_t instructions);
  /// As charge, one instruction: for each small step of a C function.
  void charge(lua_State* L) {
    if (--left_ <= 0) charge(L, 0);
  }
  /// Frees a reference of luaL_ref. Never fails.
  void release(int reference);
  /// Ends the Lua state, after the script that runs; what still refers to it finds it closed.
  void close();
  bool closed() const { return ending_ || !main_; }

 private:
  static void* allocate(void* self, void* block, std::size_t oldSize, std::size_t newSize);
  static void countHook(lua_State* L, lua_Debug* ar);
  static int describeError(lua_State* L);
  static std::string nearGlobals(lua_State* L, std::string_view text);
  [[noreturn]] static void throwForGood(lua_State* L, lua_Debug* ar, const char* text);
  [[noreturn]] void throwExhausted(lua_State* L, lua_Debug* ar);

  Runtime& runtime_;
  Ref<Leaf> sandbox_;
  bool trusted_;
  lua_State* main_ = nullptr;
  std::array<lua_State*, kMaxDepth> threads_{};
  std::size_t depth_ = 0;
  std::size_t memory_ = 0, memoryLimit_ = 0;  // 0: none
  bool ending_ = false;
  std::int64_t left_ = kUnlimited, budget_ = kUnlimited;
  std::optional<Failure> failure_;
};

/// A handler of an event. Owned by the channel; gone when its node goes, or the node of the script that made it.
struct Subscription {
  std::shared_ptr<State> state;
  int function = LUA_NOREF;
  Ref<Leaf> node, owner;
  Channel* channel = nullptr;
  std::uint64_t number = 0;
  bool removed = false;
  ~Subscription();
  void remove();
  void run(const Event& event);
};

/// What `--set K=V` and `option{}` are about.
class Settings {
 public:
  explicit Settings(Kernel& kernel) : kernel_(kernel) {}
  void add(std::string key, Value value);
  /// `option{}`: notes it and returns the override or the default. Throws Error.
  Value declare(const std::string& name, const Value& defaultValue, const std::string& doc, const List& choices);
  /// Sets the overridden members of nodes that exist and were not set yet. Throws Error.
  void apply();
  /// True when `member` of `leaf` is overridden: what a config assigns is then ignored.
  bool shields(const Leaf& leaf, std::string_view member);
  /// After a config: throws Error for overrides that met nothing.
  void finish();
  std::vector<List> options() const;

 private:
  struct Override {
    std::string key;
    Value value;
    std::string path, member;  ///< empty path: an option
    Ref<Leaf> target;          ///< where it was set
    bool met = false;          ///< an option took it, or the target has the member
  };
  struct Option {
    std::string name, doc;
    Value defaultValue, value;
    List choices;
  };
  void set(Override& o, Leaf& target);
  std::string hint(const Override& o) const;
  Kernel& kernel_;
  std::vector<Override> overrides_;
  std::vector<Option> options_;
};

/// A script file.
struct Script {
  std::filesystem::path path;
  std::string text;
};

/// All of a kernel's scripting.
class Runtime : public std::enable_shared_from_this<Runtime> {
 public:
  explicit Runtime(Kernel& kernel);
  ~Runtime();
  /// Ends all Lua states.
  void close();

  /// Finds and reads a config: in the working folder, beside a config that runs, in the folders. Throws Error that says
  /// where it looked.
  Script readConfig(std::string_view file);
  /// Finds and reads what a script includes: beside that script, beside the running config, in the folders. Throws as
  /// readConfig.
  Script readInclude(std::string_view file, lua_State* includer);
  /// Finds a script (as an include, in the working folder at last) and attaches it; `from`: the Lua function that does,
  /// or nullptr. Throws Error.
  void attachFile(Leaf& node, std::string_view file, lua_State* from, const State::Body& pushArguments);
  /// At a config's end: throws Error for a handler of a channel that nobody defined and whose name is nearly another's,
  /// and warns of such a hook of a class that lives.
  void checkChannels();
  /// Loads text and leaves the function, with the environment at `environment` (an absolute or upvalue index), on the
  /// stack. Lua error.
  static void load(lua_State* L, std::string_view text, std::string_view chunkName, int environment);
  /// Leaves the environment that configs share on the stack of a trusted thread.
  void pushConfigEnvironment(lua_State* L);
  /// Lists of pairs whose keys are words become tables with these keys.
  void setGlobal(std::string_view name, const Value& value);
  /// Runs a chunk in the config's environment. Throws Error.
  Value run(std::string_view text, std::string_view chunkName);
  /// Runs a chunk in an environment of its own. `pushArguments` leaves on the stack what the chunk reads as `...`;
  /// empty: nothing. Throws Error; what it subscribed until then goes.
  void attach(Leaf& node, std::string_view text, std::string_view chunkName, bool trusted,
              const State::Body& pushArguments = {});
  /// Adds the function on top of the stack, which is popped, as a handler. Throws Error.
  std::shared_ptr<Subscription> subscribe(lua_State* L, Leaf& node, std::string_view channel);
  /// Logs a handler's failure, once for each line of a script, and that it is switched off always.
  void report(const Failure& failure, const Subscription& subscription);

  Kernel& kernel;
  Settings settings;
  std::vector<std::filesystem::path> folders;
  std::shared_ptr<State> trusted;
  std::vector<std::weak_ptr<State>> sandboxes;
  std::filesystem::path configFolder;                        ///< of the running config, searched too
  bool inConfig = false;                                     ///< overrides shield what is assigned now
  Ref<Leaf> scriptNode;                                      ///< the node of the running script; the root for configs
  std::vector<std::weak_ptr<Subscription>>* made = nullptr;  ///< collects what a script subscribes while it is attached

 private:
  Script read(std::string_view file, std::string_view what, std::vector<std::filesystem::path> places);
  std::filesystem::path folderOf(lua_State* L) const;
  bool isChannel(std::string_view name) const;
  std::string nearChannels(std::string_view name) const;

  int configEnvironment_ = LUA_NOREF;
  std::set<std::string> reported_;
  std::map<std::string, std::filesystem::path, std::less<>> origins_;  ///< folders of the files read, by chunk name
  std::vector<std::pair<std::string, std::string>> listened_;  ///< channels nobody had defined then, and file:line
};

/// Wraps a C function: a std::exception becomes a Lua error that starts with the caller's file:line.
template <int (*F)(lua_State*)>
int guarded(lua_State* L) {
  try {
    return F(L);
  } catch (const std::exception& e) {
    luaL_where(L, 1);
    lua_pushstring(L, e.what());
    lua_concat(L, 2);
  }
  return lua_error(L);
}

/// The string at `index`; Lua error that names `what` when it is none. Valid while it is on the stack.
std::string_view checkString(lua_State* L, int index, const char* what);

// Values (value.cpp).
void pushValue(lua_State* L, const Value& value);
/// As pushValue for what a script is given: lists of pairs whose keys are words become tables with these keys.
void pushTables(lua_State* L, const Value& value);
/// As pushTables; nothing for nil.
void pushArguments(lua_State* L, const Value& arguments);
/// Throws Error when it is a function or too deep.
Value toValue(lua_State* L, int index);
/// Leaves a table's keys, sorted, as a sequence on the stack and returns their number. Throws Error for keys without an
/// order.
lua_Integer pushSortedKeys(lua_State* L, int table);
/// Leaves the first key after the one at `after` (0: the very first) on the stack, nil when there is none.
void pushNextKey(lua_State* L, int table, int after);
/// "table", "function", ... or "node", for messages.
std::string typeAt(lua_State* L, int index);

// Nodes (node.cpp).
/// Registers the metatables of nodes and subscriptions.
void openNodes(lua_State* L);
void pushNode(lua_State* L, Leaf* leaf);
/// The node at `index`, nullptr when there is another thing. Throws Error when it is dead.
Leaf* toNode(lua_State* L, int index);
/// Throws Error for what belongs to the kernel, and in untrusted scripts.
void deleteNode(lua_State* L, Leaf& node);
/// on(channel, function): the arguments are at `channelIndex` and above. Leaves the subscription's userdata; returns 1.
int subscribe(lua_State* L, Leaf& node, int channelIndex);

// Members of nodes by name: properties, and the variables of a group (a class with methods get and set and a property
// names).
bool isGroup(const Leaf& leaf);
bool hasMember(const Leaf& leaf, std::string_view name);
void setMember(Leaf& leaf, std::string_view name, const Value& value);
std::vector<std::string> memberNames(const Leaf& leaf);

// Environments (library.cpp, globals.cpp).
/// Replaces find, match, gmatch and gsub in the table on top of the stack by such that pay for what they compare
/// (patterns.cpp).
void openPatterns(lua_State* L);
/// Fills a new state's globals with the pure library.
void openLibrary(lua_State* L, bool trusted);
/// Leaves a new environment for scripts of `node` on the stack: the pure library, and for trusted scripts what reaches
/// the house.
void pushEnvironment(lua_State* L, Leaf& node, bool config);
/// Adds plugin, new, get, ... to the table on top of the stack.
void addGlobals(lua_State* L, Leaf& node, bool config);
/// Appends what print shows of the value at `index`: no addresses.
void appendText(lua_State* L, int index, std::string& out);

}  // namespace spark::script
