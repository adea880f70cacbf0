#include "state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "environment.h"
#include "nodes.h"
#include "runtime.h"
#include "values.h"

// How limits work. A count hook runs every kHookInterval instructions and subtracts them from the budget of the run.
// The allocator subtracts a share for the bytes that it allocates, so that few instructions cannot move much memory.
// When the budget is used up, every further instruction of the run fails, so that catching the error does not help. A
// coroutine inherits the hook from the thread that makes it, so its instructions count too.

namespace spark::script {

namespace {
constexpr int kHookInterval = 1000;  // instructions
constexpr int kTracebackLines = 8;
constexpr std::size_t kLongestError = 4096;  // bytes of a message, without the traceback

/// The C function that a run calls. Its argument is the body.
int callBody(lua_State* L) {
  const auto* body = static_cast<const State::Body*>(lua_touserdata(L, 1));
  lua_settop(L, 0);
  (*body)(L);
  return 0;
}

/// True for Lua's own error of calls that are too deep, which has no other mark. Where it is caught and raised again,
/// the handler takes as long.
bool isStackOverflow(const Failure& failure) { return failure.text.find("stack overflow") != std::string::npos; }

std::string megabytes(std::size_t bytes) { return fmt::format("{} MiB", bytes >> 20); }
}  // namespace

State::State(Runtime& runtime, Leaf* sandbox) : runtime_(runtime), sandbox_(sandbox), trusted_(!sandbox) {
  main_ = lua_newstate(&State::allocate, this);
  if (!main_) throw Error("cannot start Lua: no memory");
  lua_atpanic(main_, [](lua_State* L) -> int {
    const char* text = lua_tostring(L, -1);
    throw std::runtime_error(fmt::format("Lua failed outside a script: {}", text ? text : "no message"));
  });
  *static_cast<State**>(lua_getextraspace(main_)) = this;
  lua_sethook(main_, &State::countHook, LUA_MASKCOUNT, kHookInterval);
  // The registry keeps the threads from the garbage collector.
  for (lua_State*& thread : threads_) {
    thread = lua_newthread(main_);
    luaL_ref(main_, LUA_REGISTRYINDEX);
  }
  openNodes(main_);
  openLibrary(main_, trusted_);
}

State::~State() { close(); }

void State::close() {
  ending_ = true;
  if (depth_ > 0) return;
  if (main_) lua_close(main_);
  main_ = nullptr;
}

bool State::allows(const Leaf& leaf) const {
  if (trusted_) return true;
  for (const Leaf* at = &leaf; at; at = at->parent())
    if (at == sandbox_.get()) return true;
  return false;
}

void* State::allocate(void* self, void* block, std::size_t oldSize, std::size_t newSize) {
  auto& state = *static_cast<State*>(self);
  if (!block) oldSize = 0;  // for a new block Lua passes the type of the object
  if (newSize == 0) {
    std::free(block);
    state.memory_ -= oldSize;
    return nullptr;
  }
  if (newSize > oldSize) {
    if (state.memoryLimit_ != 0 && state.memory_ + newSize - oldSize > state.memoryLimit_) return nullptr;
    state.left_ -= static_cast<std::int64_t>(newSize / kBytesPerInstruction);
    // Count after the next instruction: many more blocks could be allocated until the regular count.
    if ((state.left_ <= 0 || state.isFull()) && state.depth_ > 0)
      lua_sethook(state.threads_[state.depth_ - 1], &State::countHook, LUA_MASKCOUNT, 1);
  }
  void* made = std::realloc(block, newSize);
  if (made) state.memory_ += newSize - oldSize;
  return made;
}

void State::countHook(lua_State* L, lua_Debug* ar) {
  State& state = of(L);
  state.left_ -= lua_gethookcount(L);
  if (state.left_ <= 0) state.throwExhausted(L, ar);
  if (state.isFull()) lua_gc(L, LUA_GCCOLLECT);
  if (state.isFull())
    throwForGood(L, ar, fmt::format("the scripts of a host may hold {}", megabytes(kTrustedMemory)).c_str());
  // A config has no budget and may loop forever, so a stop request must end it.
  if (state.runtime_.inConfig && state.runtime_.kernel.stopRequested())
    throwForGood(L, ar, "stopped before the config was done: the host was asked to end. Does this loop end?");
  if (lua_gethookcount(L) != kHookInterval) lua_sethook(L, &State::countHook, LUA_MASKCOUNT, kHookInterval);
}

/// Raises a Lua error that pcall cannot end: every further instruction raises it again.
void State::throwForGood(lua_State* L, lua_Debug* ar, const char* text) {
  lua_sethook(L, &State::countHook, LUA_MASKCOUNT, 1);
  lua_getinfo(L, "Sl", ar);
  if (ar->currentline > 0)
    lua_pushfstring(L, "%s:%d: %s", ar->short_src, ar->currentline, text);
  else
    lua_pushstring(L, text);
  lua_error(L);
  std::abort();  // lua_error never returns, but is not declared [[noreturn]]
}

void State::throwExhausted(lua_State* L, lua_Debug* ar) {
  throwForGood(L, ar, fmt::format("stopped after {} instructions: is there an endless loop?", budget_).c_str());
}

void State::charge(lua_State* L, std::uint64_t instructions) {
  left_ -= static_cast<std::int64_t>(std::min<std::uint64_t>(instructions, kHandlerBudget));
  if (left_ > 0) return;
  // The location in the script that called the C function.
  lua_Debug ar{};
  if (!lua_getstack(L, 1, &ar)) lua_getstack(L, 0, &ar);
  throwExhausted(L, &ar);
}

void State::release(int reference) {
  if (main_) luaL_unref(main_, LUA_REGISTRYINDEX, reference);
}

/// A hint for an error message about a global that is nil: the nearest names in the environment of the function that
/// failed. "" for other messages.
std::string State::nearGlobals(lua_State* L, std::string_view text) {
  constexpr std::string_view kMark = "a nil value (global '";
  const std::size_t mark = text.find(kMark);
  lua_Debug ar{};
  if (mark == std::string_view::npos || !lua_checkstack(L, 5) || !lua_getstack(L, 1, &ar) || !lua_getinfo(L, "f", &ar))
    return {};
  std::string_view name = text.substr(mark + kMark.size());
  name = name.substr(0, name.find('\''));
  // The environment is the upvalue _ENV.
  std::vector<std::string> names;
  const int function = lua_gettop(L);
  for (int i = 1; const char* upvalue = lua_getupvalue(L, function, i); ++i) {
    if (std::string_view(upvalue) == "_ENV" && lua_istable(L, -1))
      for (lua_pushnil(L); lua_next(L, -2); lua_pop(L, 1))
        if (lua_type(L, -2) == LUA_TSTRING) names.emplace_back(lua_tostring(L, -2));
    lua_pop(L, 1);
  }
  lua_pop(L, 1);
  const std::string near = didYouMean(name, names);
  return near.empty() ? near : "." + near;
}

// The message handler: it runs where the error is raised, when the stack is still complete. The text is kept outside of
// Lua, whose memory may be used up.
int State::describeError(lua_State* L) {
  State& state = of(L);
  Failure failure;
  appendText(L, 1, failure.text);
  failure.text = shortened(failure.text, kLongestError);
  failure.text += nearGlobals(L, failure.text);
  // The traceback: one line for each Lua function. The first is omitted if the message begins with its location.
  lua_Debug ar{};
  int lines = 0;
  for (int level = 1; lua_getstack(L, level, &ar); ++level) {
    lua_getinfo(L, "Sln", &ar);
    if (ar.currentline <= 0) continue;
    const std::string where = fmt::format("{}:{}", ar.short_src, ar.currentline);
    const bool first = failure.where.empty();
    if (first) failure.where = where;
    if (first && failure.text.starts_with(where + ":")) continue;
    if (++lines > kTracebackLines) {
      failure.text += "\n  from ...";
      break;
    }
    failure.text += fmt::format("\n  from {}", where);
    if (ar.name) failure.text += fmt::format(" in '{}'", ar.name);
  }
  state.failure_ = std::move(failure);
  return 1;
}

std::optional<Failure> State::run(std::int64_t budget, const Body& body) {
  if (closed()) return Failure{"the scripts have ended", ""};
  if (depth_ == kMaxDepth)
    return Failure{
        fmt::format("scripts entered each other more than {} deep: does a handler raise its own event?", kMaxDepth),
        ""};

  // Each nesting depth has a Lua thread and a budget of its own.
  const std::int64_t outerLeft = left_, outerBudget = budget_;
  const std::size_t outerLimit = memoryLimit_;
  lua_State* L = threads_[depth_++];
  left_ = budget_ = budget;
  memoryLimit_ = trusted_ ? 2 * kTrustedMemory : kSandboxMemory;
  lua_sethook(L, &State::countHook, LUA_MASKCOUNT, kHookInterval);
  lua_settop(L, 0);

  lua_pushcfunction(L, &State::describeError);
  lua_pushcfunction(L, &guarded<callBody>);
  lua_pushlightuserdata(L, const_cast<Body*>(&body));
  failure_.reset();
  const int status = lua_pcall(L, 1, 0, 1);

  std::optional<Failure> result;
  if (status != LUA_OK) result = std::move(failure_).value_or(Failure{});
  if (result) result->exhausted = left_ <= 0 || isStackOverflow(*result);
  if (status == LUA_ERRMEM)
    result = Failure{
        trusted_ ? fmt::format("used up the memory: the scripts of a host may hold {}", megabytes(kTrustedMemory))
                 : fmt::format("used up its memory: an untrusted script may hold {}", megabytes(kSandboxMemory)),
        ""};
  if (result && result->text.empty()) result->text = "failed without a message";

  failure_.reset();
  lua_settop(L, 0);
  --depth_;
  memoryLimit_ = outerLimit;
  left_ = outerLeft - (budget - left_);  // the outer run pays for the inner one
  budget_ = outerBudget;
  if (ending_ && depth_ == 0) close();
  return result;
}

}  // namespace spark::script
