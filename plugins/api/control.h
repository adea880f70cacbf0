#pragma once
/// \file
/// Requests about the tree, as sparkctl and the browser make them: JSON in, JSON out, answered from the tree's own
/// descriptions.

#include <span>
#include <string>
#include <string_view>

#include "spark/abi/api/control.h"
#include "spark/node.h"
#include "spark/value.h"

namespace spark {

namespace control {

/// A property that somebody watches; looked at again when nextOf() is called. Owned by who asks.
struct Watch {
  std::string path, property, unit;
  Ref<Leaf> leaf;        ///< empty when the node is gone
  Value last;            ///< as told last
  bool started = false;  ///< there is something to watch
};

}  // namespace control

/// Answers requests; offered by the control server, at /sys/server/control. To be asked between two cycles
/// (IInputSource::poll), in the simulation's thread: what a request changes is an input like any other.
class IRequests {
 public:
  SPARK_INTERFACE(IRequests, 1);
  static constexpr const char* kPath = "/sys/server/control";
  virtual ~IRequests() = default;
  /// The answer to one request, in one line: `{"ok":true,...}` or `{"ok":false,"error":"..."}`. Nothing is thrown. A
  /// request "watch" fills `watch` in, and the answer is its first value. `mayChange` false refuses "set" and "call".
  virtual std::string answer(std::string_view request, control::Watch& watch, bool mayChange) = 0;
  /// The next line of a watch, "" while the value is as before. An error when the property is gone: then `done` is set.
  virtual std::string nextOf(control::Watch& watch, bool& done) = 0;
};

/// Answers further kinds of requests; a child of the control server, which asks it between two cycles, in the
/// simulation's thread.
class IRequestHandler {
 public:
  SPARK_INTERFACE(IRequestHandler, 1);
  virtual ~IRequestHandler() = default;
  /// What "do" says in the requests that it answers. Valid as long as the handler.
  virtual std::span<const std::string_view> requests() const = 0;
  /// The answer to one of them, in one line as IRequests::answer(). Changes nothing in the match: spectators ask, too.
  virtual std::string answer(std::string_view request) = 0;
  /// Called between every two cycles.
  virtual void poll() {}
};

}  // namespace spark
