#pragma once
/// \file
/// Private to the script server: a Lua function that handles an event.

#include <memory>

#include "spark/event.h"
#include "state.h"

namespace spark::script {

/// A handler of an event. The channel owns it; it is removed with its node and with the node of the script that made
/// it.
struct Subscription {
  std::shared_ptr<State> state;
  int function = LUA_NOREF;    ///< reference to the handler
  Ref<Leaf> node;              ///< where the event is handled
  Ref<Leaf> owner;             ///< node of the script that made it
  Channel* channel = nullptr;  ///< of the kernel
  std::uint64_t number = 0;    ///< in the channel
  bool removed = false;
  bool off = false;  ///< it used up its budget and is not called any more

  ~Subscription();
  /// Removes the handler from its channel.
  void remove();
  /// Calls the handler. What it returns is appended to the list that the emitter wants to have answered, or replaces
  /// the answer. A failure is logged and counted. A handler that used up its budget is switched off until it is
  /// removed: each event that wants an answer of it is a further failure.
  void run(const Event& event);
};

}  // namespace spark::script
