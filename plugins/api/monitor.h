#pragma once
/// \file
/// Monitors. Monitor items contribute to a frame; the monitor server builds one immutable frame in each publish phase
/// and computes the update of each client; encoders below it write the updates; trainers below it execute commands;
/// viewers inside the host receive the frames themselves.

#include <vector>

#include "api/scene.h"
#include "spark/abi/api/monitor.h"
#include "spark/event.h"
#include "spark/predicates.h"

namespace spark {

/// When an entry of the environment is sent.
enum class EnvPolicy {
  full,    ///< in full messages only
  change,  ///< in full messages, and whenever it changed
  always,  ///< in every message
  once     ///< an event: to each client exactly once
};

/// The environment part of a frame: `(time 0.8)(round 3)`, each entry with a policy.
struct Environment {
  /// One entry.
  struct Entry {
    EnvPolicy policy;
    std::uint32_t token;  ///< index of its list in `predicates`
  };
  Predicates predicates;
  std::vector<Entry> entries;
  /// Opens an entry. The caller adds atoms to the returned predicates and then calls close().
  Predicates& open(EnvPolicy policy, std::string_view name) {
    entries.push_back({policy, predicates.size()});
    return predicates.open(name);
  }
  /// Adds the entry `(name value)`.
  template <class T>
  void put(EnvPolicy policy, std::string_view name, const T& value) {
    open(policy, name).add(value).close();
  }
};

/// Adds entries to the environment. A child of the monitor server.
class IMonitorItem {
 public:
  SPARK_INTERFACE(IMonitorItem, 1);
  virtual ~IMonitorItem() = default;
  /// Adds the entries, in the publish phase: the same entries in the same order every time, `once` entries excepted.
  virtual void contribute(Environment& env) = 0;
};

/// A visible node of a frame. Nodes are in depth-first order.
struct FrameNode {
  enum class Kind { transform, light, mesh, singleMaterial } kind = Kind::transform;
  int depth = 0;                      ///< 0: top level; its children follow with depth + 1
  Matrix local = Matrix::Identity();  ///< transforms: relative to the enclosing transform of the frame
  bool visible = true, transparent = false;
  IVisual* visual = nullptr;       ///< lights and meshes; valid during the publish phase
  Transform* transform = nullptr;  ///< transforms; valid during the publish phase; nullptr in recorded scenes
};

/// The scene and the environment at one instant. Immutable after the publish phase.
struct MonitorFrame {
  std::int64_t cycle = 0;
  std::uint64_t shape = 0;  ///< differs when nodes, meshes or materials changed: clients need a full message
  std::vector<FrameNode> nodes;
  Environment env;
};

/// Hashes of name and content of one entry of the environment, to see which entries changed.
struct EntryKey {
  std::uint64_t name = 0, content = 0;
};

/// The newest frame and the data that is computed once for all viewers. Owned by the monitor server.
struct NewestFrame {
  MonitorFrame frame;
  std::uint64_t serial = 0;        ///< number of frames made so far
  std::vector<std::uint64_t> ids;  ///< of each node, unique for the lifetime of the host; newer nodes have higher ids
  std::vector<EntryKey> keys;      ///< of frame.env.entries; valid for `change` entries only
  float precision = 0.005f;        ///< a matrix is sent again when an element changed by more
};

/// The update of one client.
struct MonitorUpdate {
  const MonitorFrame& frame;
  bool full = false;                  ///< a full message; else a difference to the client's last one
  std::vector<std::uint8_t> changed;  ///< differences: 1 for each node whose transform or visibility changed
  std::vector<std::uint32_t> env;     ///< tokens of the entries in frame.env.predicates to send, in order
  Predicates events;                  ///< pending `once` entries, to be sent after env
};

/// Writes updates as messages. A child of the monitor server.
class IMonitorEncoder {
 public:
  SPARK_INTERFACE(IMonitorEncoder, 1);
  virtual ~IMonitorEncoder() = default;
  /// Appends the message of `update` to `out`.
  virtual void encode(const MonitorUpdate& update, std::string& out) = 0;
};

/// Executes trainer commands. A child of the monitor server, which tries its trainers in order.
class ITrainer {
 public:
  SPARK_INTERFACE(ITrainer, 1);
  virtual ~ITrainer() = default;
  /// Executes `command` and returns true when it is one of this trainer's. Sets `why` when the command is malformed.
  virtual bool command(const Element& command, std::string& why) = 0;
};

/// A viewer inside the host, such as a log or the web server; it receives frames in the publish phase. A child of the
/// monitor server.
class IFrameTaker {
 public:
  SPARK_INTERFACE(IFrameTaker, 1);
  virtual ~IFrameTaker() = default;
  /// Receives a `once` entry of the frame that the next take() delivers. Valid during the call.
  virtual void event(const Element& event) = 0;
  /// Receives the newest frame, in cycles in which one is due. All pointers in it are valid during the call. `encoder`
  /// is the server's, nullptr when it has none; `event` is that of the publish phase.
  virtual void take(const NewestFrame& newest, IMonitorEncoder* encoder, const Event& event) = 0;
};

/// The monitor server, at /sys/server/monitor.
class IMonitorServer {
 public:
  SPARK_INTERFACE(IMonitorServer, 2);
  static constexpr const char* kPath = "/sys/server/monitor";
  virtual ~IMonitorServer() = default;
  /// Makes the next message to every client a full one.
  virtual void requestFullState() = 0;
  /// The newest frame; valid until the next publish phase.
  virtual const MonitorFrame& frame() const = 0;
  /// The same with what was computed for viewers. Its `frame.cycle` tells whether it was made in this cycle: then its
  /// pointers are valid in the rest of the publish phase.
  virtual const NewestFrame& newest() const = 0;
  /// Queues commands as if a monitor had sent them: S-expressions, executed in the next act phase that takes commands.
  /// `from` names the sender in log messages. Returns "" or why some commands will not be executed: they could not be
  /// read, or the queue is full.
  virtual std::string command(std::string_view from, std::string_view message) = 0;
};

}  // namespace spark
