#pragma once
/// \file
/// Private to the script server: a Lua state with limits.
///
/// Trusted scripts (configs, attached files) share one Lua state. Each untrusted script has a state of its own with a
/// memory limit, so that nothing it does to its tables affects other scripts. Code enters a state by State::run only,
/// which gives it an empty stack, a budget of instructions and a traceback. Lua is compiled as C++ (lua5.4-c++), so its
/// errors are exceptions and destructors run; `guarded` turns std::exception into a Lua error with file:line.

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <lua.hpp>
#include <memory>
#include <optional>
#include <string>

#include "spark/ref.h"

namespace spark {
class Leaf;
}

namespace spark::script {

class Runtime;

/// Budgets of a run in instructions: the set-up of trusted scripts, one event in a trusted handler, and any run of an
/// untrusted script.
inline constexpr std::int64_t kUnlimited = std::numeric_limits<std::int64_t>::max() / 4;
inline constexpr std::int64_t kHandlerBudget = 50'000'000;
inline constexpr std::int64_t kSandboxBudget = 1'000'000;
/// Bytes of memory or text that cost as much as one instruction.
inline constexpr std::size_t kBytesPerInstruction = 16;
/// Memory of all trusted scripts [bytes], which one allocation may exceed to the double.
inline constexpr std::size_t kTrustedMemory = 1u << 30;
/// Memory of an untrusted script [bytes].
inline constexpr std::size_t kSandboxMemory = 2u << 20;
/// How deep runs may be nested: a handler may raise an event that has a handler, and so on.
inline constexpr std::size_t kMaxDepth = 16;

/// The error that ended a run.
struct Failure {
  std::string text;        ///< begins with file:line and ends with the traceback
  std::string where;       ///< file:line, "" if unknown
  bool exhausted = false;  ///< the budget or the stack was used up
};

/// A Lua state.
class State : public std::enable_shared_from_this<State> {
 public:
  /// Code that runs in the state, on an empty stack. It may raise Lua errors and throw std::exception.
  using Body = std::function<void(lua_State*)>;

  /// `sandbox`: the node of an untrusted script; nullptr for the trusted state. Throws Error if there is no memory.
  State(Runtime& runtime, Leaf* sandbox);
  ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  /// The state of a Lua thread.
  static State& of(lua_State* L) { return **static_cast<State**>(lua_getextraspace(L)); }
  Runtime& runtime() { return runtime_; }
  /// True for the state of trusted scripts.
  bool trusted() const { return trusted_; }
  /// True if scripts of this state may use `leaf`. Untrusted scripts may use their node and its descendants.
  bool allows(const Leaf& leaf) const;

  /// Runs `body` in protected mode with a budget of instructions. Returns nothing if it succeeded.
  std::optional<Failure> run(std::int64_t budget, const Body& body);
  /// Subtracts instructions from the budget of the current run, for C functions whose work depends on their arguments.
  /// Raises a Lua error if the budget is used up.
  void charge(lua_State* L, std::uint64_t instructions);
  /// Subtracts one instruction, for each small step of a C function.
  void charge(lua_State* L) {
    if (--left_ <= 0) charge(L, 0);
  }
  /// Frees a reference of luaL_ref. Never fails.
  void release(int reference);
  /// Closes the Lua state, as soon as no script runs in it. Runs then fail, and releasing references does nothing.
  void close();
  /// True if the state is closed, or will be when the current script ends.
  bool closed() const { return ending_ || !main_; }

 private:
  static void* allocate(void* self, void* block, std::size_t oldSize, std::size_t newSize);
  static void countHook(lua_State* L, lua_Debug* ar);
  static int describeError(lua_State* L);
  static std::string nearGlobals(lua_State* L, std::string_view text);
  [[noreturn]] static void throwForGood(lua_State* L, lua_Debug* ar, const char* text);
  [[noreturn]] void throwExhausted(lua_State* L, lua_Debug* ar);
  bool isFull() const { return trusted_ && memory_ > kTrustedMemory; }

  Runtime& runtime_;
  Ref<Leaf> sandbox_;
  bool trusted_;
  lua_State* main_ = nullptr;
  std::array<lua_State*, kMaxDepth> threads_{};  ///< the Lua thread of each depth
  std::size_t depth_ = 0;                        ///< nested runs
  std::size_t memory_ = 0;                       ///< allocated [bytes]
  std::size_t memoryLimit_ = 0;                  ///< [bytes], beyond which nothing is allocated; 0: none
  bool ending_ = false;                          ///< close() was called
  std::int64_t left_ = kUnlimited;               ///< instructions left of the current run
  std::int64_t budget_ = kUnlimited;             ///< instructions of the current run
  std::optional<Failure> failure_;               ///< of the current run, kept by describeError()
};

/// Wraps a C function: a std::exception becomes a Lua error that begins with file:line of the caller.
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

}  // namespace spark::script
