#pragma once
/// \file
/// Requests about the tree, as sparkctl and the browser send them: JSON in, JSON out, answered from the descriptions of
/// the classes.

#include <span>
#include <string>
#include <string_view>

#include "spark/abi/api/control.h"
#include "spark/node.h"
#include "spark/value.h"

namespace spark {

namespace control {

/// A property that a client watches; nextOf() reads it again. Owned by the caller.
struct Watch {
  std::string path, property, unit;
  Ref<Leaf> leaf;        ///< the node; empty once it was removed
  Value last;            ///< the value in the last line
  bool started = false;  ///< a request "watch" has filled this in
};

}  // namespace control

/// Answers requests. Offered by the control server, at /sys/server/control. Call it between two cycles
/// (IInputSource::poll), in the simulation's thread: a change by a request is an input like any other.
class IRequests {
 public:
  SPARK_INTERFACE(IRequests, 1);
  static constexpr const char* kPath = "/sys/server/control";
  virtual ~IRequests() = default;
  /// The answer to one request, as one line: `{"ok":true,...}` or `{"ok":false,"error":"..."}`. Does not throw. A
  /// request "watch" fills in `watch`, and the answer holds its first value. `mayChange` false refuses requests that
  /// change something, such as "set" and "call".
  virtual std::string answer(std::string_view request, control::Watch& watch, bool mayChange) = 0;
  /// The next line of a watch; "" while the value is unchanged. When the property is gone it sets `done` and returns an
  /// error answer.
  virtual std::string nextOf(control::Watch& watch, bool& done) = 0;
};

/// Answers further kinds of requests. A child of the control server, which calls it between two cycles, in the
/// simulation's thread.
class IRequestHandler {
 public:
  SPARK_INTERFACE(IRequestHandler, 1);
  virtual ~IRequestHandler() = default;
  /// Values of "do" in the requests that it answers. Valid as long as the handler lives.
  virtual std::span<const std::string_view> requests() const = 0;
  /// The answer to one of them, as one line like that of IRequests::answer(). Must not change the match: spectators may
  /// send these requests, too.
  virtual std::string answer(std::string_view request) = 0;
  /// Called once between any two cycles.
  virtual void poll() {}
};

}  // namespace spark
