#include "subscription.h"

#include <fmt/format.h>

#include "nodes.h"
#include "restore.h"
#include "runtime.h"
#include "spark/error.h"
#include "values.h"

namespace spark::script {

namespace {
/// The value on top of the stack, which `function` (a reference) has returned. Throws Error with the place of the
/// function if it is no value.
Value returned(lua_State* L, int function) {
  try {
    return toValue(L, -1);
  } catch (const Error& e) {
    lua_Debug ar{};
    lua_rawgeti(L, LUA_REGISTRYINDEX, function);
    lua_getinfo(L, ">S", &ar);
    throw Error(fmt::format("{}:{}: what this function returned: {}", ar.short_src, ar.linedefined, e.what()));
  }
}
}  // namespace

Subscription::~Subscription() { state->release(function); }

void Subscription::remove() {
  if (!removed && node) channel->remove(number);
  removed = true;
}

void Subscription::run(const Event& event) {
  if (removed || state->closed() || !node || node->kernel().isEnding()) return;
  if (!owner) return remove();  // the node of the script has been removed
  if (off) {
    if (event.answer) node->kernel().countFault();
    return;
  }
  Runtime& runtime = state->runtime();
  const auto keep = runtime.shared_from_this();  // the handler may remove the script server
  const Restore running(runtime.scriptNode, owner);
  const auto failure = state->run(state->trusted() ? kHandlerBudget : kSandboxBudget, [&](lua_State* L) {
    lua_rawgeti(L, LUA_REGISTRYINDEX, function);
    // The arguments: self and a table with the event.
    pushNode(L, node.get());
    lua_createtable(L, 0, 5);
    pushText(L, event.name);
    lua_setfield(L, -2, "name");
    lua_pushnumber(L, event.time);
    lua_setfield(L, -2, "time");
    lua_pushnumber(L, event.step);
    lua_setfield(L, -2, "step");
    lua_pushinteger(L, event.cycle);
    lua_setfield(L, -2, "cycle");
    if (event.data)
      pushValue(L, *event.data);
    else
      lua_pushnil(L);
    lua_setfield(L, -2, "data");
    lua_call(L, 2, event.answer ? 1 : 0);
    if (!event.answer) return;
    Value answer = returned(L, function);
    if (event.answer->isList())
      event.answer->toList().push_back(std::move(answer));
    else
      *event.answer = std::move(answer);
  });
  if (!failure) return;
  runtime.report(*failure, *this);
  off = off || failure->exhausted;
}

}  // namespace spark::script
