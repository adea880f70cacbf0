#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "api/agents.h"
#include "api/monitor.h"
#include "api/net.h"
#include "api/phases.h"
#include "frame_source.h"
#include "monitor_client.h"
#include "visible_nodes.h"

namespace spark {

/// Makes frames of the scene and sends each client what it lacks; takes trainer commands.
///
///     items ─┐ contribute (time 1.2)(round 3)...
///     scene ─┴► frame, every `interval` cycles in the publish phase (or a frame source makes it)
///                 ├─► client: what changed since *its* last message ─► encoder ─► connection, when idle
///                 ├─► client ...
///                 └─► log: another viewer, in the host
///     clients ─► commands, read when they arrive ─► act phase of the cycle after a due one ─► built in, then trainers
///
/// A frame is due in the cycles whose number is a multiple of `interval`. Commands act in the cycle after, so that a
/// frame shows what `interval` steps made of them; game control must stand before the monitor server in the tree for
/// agents to act before trainers. As in the installed base a frame of a scene that changed after the act phase of its
/// own cycle is left out, the next one is full; two are never left out in a row.
///
/// A client that does not read is never closed: utilities open the port only to send commands, viewers pause. Frames
/// are left out for it, and it costs one unsent message and some waiting events. Whose machine has gone is the
/// transport's business.
class MonitorServer : public Node, public IMonitorServer, public IConnectionConsumer {
  SPARK_CLASS(MonitorServer, Node)
 public:
  static void describe(Description<MonitorServer>& d);

  void requestFullState() override;
  const MonitorFrame& frame() const override { return newest_.frame; }
  std::string command(std::string_view from, std::string_view message) override;

  void connected(IConnection& connection) override;
  void received(IConnection& connection, std::string_view message) override;
  void disconnected(IConnection& connection) override;

 private:
  void act(const Event& event);
  void publish(const Event& event);
  bool due(const Event& event) const { return event.cycle % interval_ == 0; }
  bool takesCommands(const Event& event) const { return event.cycle % interval_ == 1 % interval_; }
  int clientCount() const { return static_cast<int>(clients_.size()); }

  void learnCommands();
  void makeFrame(const Event& event);
  void fillFromScene();
  void sendTo(const std::vector<MonitorClient*>& clients);
  IMonitorEncoder* encoderFor(const MonitorClient& client) const;
  void execute(const Element& command);
  /// Keeps what a parser (nullptr: S-expressions) makes of a message until it is due.
  std::string keepCommands(IParser* parser, std::string_view from, std::string_view message);
  std::string dropMessage(std::string_view from);
  /// Which of the commands from token `first` on nobody takes, with the nearest that somebody does; "" when all are
  /// known.
  std::string unknownFrom(std::uint32_t first) const;
  /// As command(), for scripts and sparkctl. Throws Error.
  void commandOrThrow(std::string text);

  /// Of tree and scene.
  struct Version {
    std::uint64_t structure = 0, modified = 0;
    bool operator==(const Version&) const = default;
  };
  Version version() const;

  int interval_ = 2;
  double precision_ = 0.005;

  NewestFrame newest_;
  VisibleNodes nodes_;
  Version atAct_;                                        ///< in the act phase of the last due cycle
  bool changed_ = false;                                 ///< the newest frame has another shape than the one before
  bool leftOut_ = false;                                 ///< the last frame that was due was not sent
  std::vector<std::unique_ptr<MonitorClient>> clients_;  ///< in order of arrival
  std::vector<MonitorClient*> ready_;
  std::vector<IMonitorEncoder*> encoders_;  ///< of the clients that are sent to
  std::vector<std::size_t> leaders_;        ///< for each of these, the first that is like it
  std::vector<std::size_t> encoding_;       ///< those that are encoded
  Predicates commands_;
  std::int64_t dropped_ = 0;  ///< messages since the last line about it
  std::optional<std::int64_t> toldDroppedAt_, toldUnknownAt_;

  Link<IMonitorEncoder> encoder_;
  Link<IFrameSource> source_;
  Link<ISceneServer> scene_;
  Links<IFrameTaker> takers_;
  Links<IMonitorItem> items_;
  Links<ITrainer> trainers_;
  TreeWatch tree_;                  ///< in which known_ was learnt
  std::vector<std::string> known_;  ///< commands; empty when a trainer does not say what it takes
  Event last_;                      ///< of the last publish phase
  bool toldNoEncoder_ = false;
};

}  // namespace spark
