#pragma once
/// \file
/// Monitors: items contribute to a frame, the monitor server makes one immutable frame a publish phase and works out
/// what each client lacks, encoders below it write that, trainers below it take commands, viewers inside the host take
/// the frames themselves.

#include <vector>

#include "api/scene.h"
#include "spark/abi/api/monitor.h"
#include "spark/event.h"
#include "spark/predicates.h"

namespace spark {

/// When an entry of the environment is sent.
enum class EnvPolicy { full, change, always, once };

/// The environment part of a frame: `(time 0.8)(round 3)`, each with a policy.
struct Environment {
  struct Entry {
    EnvPolicy policy;
    std::uint32_t token;  ///< index of its list in `predicates`
  };
  Predicates predicates;
  std::vector<Entry> entries;
  /// Opens an entry; add atoms to `predicates`, then close().
  Predicates& open(EnvPolicy policy, std::string_view name) {
    entries.push_back({policy, predicates.size()});
    return predicates.open(name);
  }
  template <class T>
  void put(EnvPolicy policy, std::string_view name, const T& value) {
    open(policy, name).add(value).close();
  }
};

/// Child of the monitor server: adds entries. `once` entries are events: each client gets them exactly once.
class IMonitorItem {
 public:
  SPARK_INTERFACE(IMonitorItem, 1);
  virtual ~IMonitorItem() = default;
  /// Publish phase. Entries in a fixed order, the same entries every time but for `once`.
  virtual void contribute(Environment& env) = 0;
};

/// A visible node of a frame, in depth-first order.
struct FrameNode {
  enum class Kind { transform, light, mesh, singleMaterial } kind = Kind::transform;
  int depth = 0;                      ///< 0: top level; its children follow with depth + 1
  Matrix local = Matrix::Identity();  ///< transforms: relative to the enclosing printed transform
  bool visible = true, transparent = false;
  IVisual* visual = nullptr;       ///< lights and meshes; valid during the publish phase
  Transform* transform = nullptr;  ///< transforms; valid during the publish phase; nullptr in recorded scenes
};

/// One instant as monitors see it. Immutable after the publish phase.
struct MonitorFrame {
  std::int64_t cycle = 0;
  std::uint64_t shape = 0;  ///< changes when nodes, meshes or materials changed: clients need a full message
  std::vector<FrameNode> nodes;
  Environment env;
};

/// Name and content of one entry of the environment, as hashes: to know what a viewer was told.
struct EntryKey {
  std::uint64_t name = 0, content = 0;
};

/// The newest frame and what is worked out once for all viewers. Owned by the monitor server.
struct NewestFrame {
  MonitorFrame frame;
  std::uint64_t serial = 0;  ///< counts frames that were made
  std::vector<std::uint64_t>
      ids;                     ///< per node, a number that no other node ever has; later made nodes have higher ones
  std::vector<EntryKey> keys;  ///< of frame.env.entries; only those of `change` entries count
  float precision = 0.005f;    ///< a matrix is sent again when an element moved by more
};

/// What one client is to get.
struct MonitorUpdate {
  const MonitorFrame& frame;
  bool full = false;
  std::vector<std::uint8_t> changed;  ///< per node, diffs only: transform moved, or visibility changed
  std::vector<std::uint32_t> env;     ///< tokens of frame.env.predicates to send, in order
  Predicates events;                  ///< waiting `once` entries, to be sent after env
};

/// Writes updates; child of the monitor server.
class IMonitorEncoder {
 public:
  SPARK_INTERFACE(IMonitorEncoder, 1);
  virtual ~IMonitorEncoder() = default;
  virtual void encode(const MonitorUpdate& update, std::string& out) = 0;
};

/// Takes trainer commands; child of the monitor server, asked in order.
class ITrainer {
 public:
  SPARK_INTERFACE(ITrainer, 1);
  virtual ~ITrainer() = default;
  /// True when the command is this trainer's. `why` says what is wrong with a malformed one.
  virtual bool command(const Element& command, std::string& why) = 0;
};

/// Child of the monitor server: a viewer inside the host (a log, the browser's), which takes frames in the publish
/// phase.
class IFrameTaker {
 public:
  SPARK_INTERFACE(IFrameTaker, 1);
  virtual ~IFrameTaker() = default;
  /// A `once` entry of the frame that follows; valid during the call.
  virtual void event(const Element& event) = 0;
  /// The newest frame, in cycles in which one is due; what it points to is valid during the call. `encoder` is the
  /// server's, nullptr when it has none; `event` the publish phase's.
  virtual void take(const NewestFrame& newest, IMonitorEncoder* encoder, const Event& event) = 0;
};

/// The monitor server, at /sys/server/monitor.
class IMonitorServer {
 public:
  SPARK_INTERFACE(IMonitorServer, 1);
  static constexpr const char* kPath = "/sys/server/monitor";
  virtual ~IMonitorServer() = default;
  /// The next message to every client is full.
  virtual void requestFullState() = 0;
  /// The newest frame; valid until the next publish phase.
  virtual const MonitorFrame& frame() const = 0;
  /// Takes commands as if a monitor had sent them: S-expressions, executed in the next act phase that takes commands.
  /// `from` is said where something is wrong with them. Returns "" or why some of it will not be executed: what could
  /// not be read, or that too much waits.
  virtual std::string command(std::string_view from, std::string_view message) = 0;
};

}  // namespace spark
