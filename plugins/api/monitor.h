#pragma once
/// \file
/// Monitors: items contribute to a frame, the monitor server makes one immutable frame a publish phase and works out what each client
/// lacks, encoders below it write that, trainers below it take commands.

#include <vector>

#include "api/scene.h"
#include "spark/predicates.h"

namespace spark {

/// When an entry of the environment is sent.
enum class EnvPolicy { full, change, always, once };

/// The environment part of a frame: `(time 0.8)(play_mode 3)`, each with a policy.
struct Environment {
  struct Entry {
    EnvPolicy policy;
    std::uint32_t token;           ///< index of its list in `predicates`
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
  int depth = 0;                   ///< 0: top level; its children follow with depth + 1
  Matrix local = Matrix::Identity();  ///< transforms: relative to the enclosing printed transform
  bool visible = true, transparent = false;
  IVisual* visual = nullptr;       ///< lights and meshes; valid during the publish phase
};

/// One instant as monitors see it. Immutable after the publish phase.
struct MonitorFrame {
  std::int64_t cycle = 0;
  std::uint64_t shape = 0;         ///< changes when nodes, meshes or materials changed: clients need a full message
  std::vector<FrameNode> nodes;
  Environment env;
};

/// What one client is to get.
struct MonitorUpdate {
  const MonitorFrame& frame;
  bool full = false;
  std::vector<std::uint8_t> changed;    ///< per node, diffs only: transform moved, or visibility changed
  std::vector<std::uint32_t> env;       ///< tokens of frame.env.predicates to send, in order
  Predicates events;                    ///< waiting `once` entries, to be sent after env
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

/// The monitor server, at /sys/server/monitor.
class IMonitorServer {
 public:
  SPARK_INTERFACE(IMonitorServer, 1);
  virtual ~IMonitorServer() = default;
  /// The next message to every client is full.
  virtual void requestFullState() = 0;
  /// The newest frame; valid until the next publish phase.
  virtual const MonitorFrame& frame() const = 0;
};

}  // namespace spark
