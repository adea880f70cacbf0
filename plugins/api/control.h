#pragma once
/// \file
/// Requests about the tree, as sparkctl and the browser make them: JSON in, JSON out, answered from the tree's own
/// descriptions.

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

}  // namespace spark
