#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "api/agents.h"
#include "api/monitor.h"
#include "api/net.h"
#include "api/phases.h"
#include "monitor_client.h"
#include "visible_nodes.h"

namespace spark {

/// Makes frames of the scene and sends each client what it lacks; takes trainer commands.
///
///     items ─┐ contribute (time 1.2)(play_mode 3)...
///     scene ─┴► frame, every `interval` cycles in the publish phase
///                 ├─► client: what changed since *its* last message ─► encoder ─► connection, when idle
///                 └─► client ...
///     clients ─► commands, read when they arrive ─► act phase of the next cycle that is due ─► built in, then trainers in order
///
/// A frame is due in the cycles whose number is a multiple of `interval`. In such a cycle commands act first and count for the step that
/// follows; game control must stand before the monitor server in the tree for agents to act before trainers.
class MonitorServer : public Node, public IMonitorServer, public IConnectionConsumer {
  SPARK_CLASS(MonitorServer, Node)
 public:
  static void describe(Description<MonitorServer>& d);

  void requestFullState() override;
  const MonitorFrame& frame() const override { return frame_; }

  void connected(IConnection& connection) override;
  void received(IConnection& connection, std::string_view message) override;
  void disconnected(IConnection& connection) override;

 private:
  void act(const Event& event);
  void publish(const Event& event);
  bool due(const Event& event) const { return event.cycle % interval_ == 0; }
  int clientCount() const { return static_cast<int>(clients_.size()); }

  void lookUpHelpers();
  void makeFrame();
  void sendTo(const std::vector<MonitorClient*>& clients);
  IMonitorEncoder* encoderFor(const MonitorClient& client) const;
  void execute(const Element& command);
  void dropMessage(IConnection& connection);

  int interval_ = 2;
  double stallTimeout_ = 10, precision_ = 0.005;

  MonitorFrame frame_;
  std::vector<EntryKey> keys_;  ///< of frame_.env.entries
  VisibleNodes nodes_;
  std::vector<std::unique_ptr<MonitorClient>> clients_;  ///< in order of arrival
  std::vector<MonitorClient*> ready_;
  std::vector<IMonitorEncoder*> encoders_;
  Predicates commands_;
  std::int64_t dropped_ = 0;  ///< messages since the last line about it
  std::optional<std::int64_t> toldDroppedAt_;

  std::uint64_t helpersAt_ = 0;
  IMonitorEncoder* encoder_ = nullptr;
  std::vector<IMonitorItem*> items_;
  std::vector<ITrainer*> trainers_;
  double time_ = 0;
  std::int64_t cycle_ = 0;
  bool toldNoEncoder_ = false;
};

}  // namespace spark
