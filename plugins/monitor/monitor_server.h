#pragma once
/// \file
/// The monitor server.

#include <memory>
#include <optional>
#include <vector>

#include "api/agents.h"
#include "api/mistakes.h"
#include "api/monitor.h"
#include "api/net.h"
#include "api/phases.h"
#include "frame_source.h"
#include "monitor_client.h"
#include "spark/predicates.h"
#include "spark/state_stream.h"
#include "visible_nodes.h"

namespace spark {

/// Makes frames of the scene, sends each client what has changed since its last message, executes trainer commands.
///
///     items ─┐ contribute (time 1.2)(round 3)...
///     scene ─┴► frame, every `interval` cycles in the publish phase (or a frame source makes it)
///                 ├─► client: what changed since *its* last message ─► encoder ─► connection, when idle
///                 ├─► client ...
///                 └─► frame takers inside the host: logs, the web server
///     clients ─► commands, parsed on arrival ─► act phase of the cycle after a frame ─► built-in ones, then trainers
///
/// A frame is due in cycles whose number is a multiple of `interval`. Commands are executed in the cycle after, so that
/// the next frame shows their effect after `interval` steps. In the tree game control must precede the monitor server,
/// so that agents act before trainers. As in SimSpark, a frame is skipped if its scene changed after the act phase of
/// the same cycle; the next one is full. Two frames are never skipped in a row.
///
/// A client that does not read is never disconnected: utilities open the port only to send commands, viewers pause. It
/// skips frames, and costs one unsent message and some waiting events. The transport detects clients whose machine has
/// failed.
class MonitorServer : public Node, public IMonitorServer, public IConnectionConsumer {
  SPARK_CLASS(MonitorServer, Node)
 public:
  static void describe(Description<MonitorServer>& d);

  void requestFullState() override;
  const MonitorFrame& frame() const override { return newest_.frame; }
  const NewestFrame& newest() const override { return newest_; }
  std::string command(std::string_view from, std::string_view message) override;

  void connected(IConnection& connection) override;
  void received(IConnection& connection, std::string_view message) override;
  void disconnected(IConnection& connection) override;

 protected:
  /// Commands that wait are state; clients are not.
  void saveState(StateWriter& out) const override { out.write(Value(toList(commands_))); }
  void loadState(StateReader& in) override {
    commands_.clear();
    append(in.readValue().toList(), commands_);
  }

 private:
  void act(const Event& event);
  void publish(const Event& event);
  bool due(const Event& event) const { return event.cycle % interval_ == 0; }
  bool takesCommands(const Event& event) const { return event.cycle % interval_ == 1 % interval_; }
  int clientCount() const { return static_cast<int>(clients_.size()); }

  void updateKnownCommands();
  void makeFrame(const Event& event);
  void fillFromScene();
  void sendTo(const std::vector<MonitorClient*>& clients);
  IMonitorEncoder* encoderFor(const MonitorClient& client) const;
  void execute(const Element& command);
  /// Parses a message (`parser` nullptr: S-expressions) and queues its commands. Returns as command().
  std::string queueCommands(IParser* parser, std::string_view from, std::string_view message);
  std::string dropMessage(std::string_view from);
  /// Calls add(name, sentence) for each of the first mistakes in `commands_` from token `first` on.
  template <typename Add>
  void addMistakes(std::uint32_t first, Add add);
  /// Why not all of `command` will have an effect, as a sentence; "" if it will.
  std::string mistakeOf(const Element& command) const;
  /// Logs a mistake in the command `name` once for each kind.
  void logOnce(std::string_view from, std::string_view name, std::string_view why);
  void ignored(const Element& command, std::string_view why);
  /// As command(), for scripts and sparkctl. Throws Error if a command will not be executed.
  void commandOrThrow(const std::string& text);

  /// Versions of the tree and of the scene.
  struct Version {
    std::uint64_t structure = 0, modified = 0;
    bool operator==(const Version&) const = default;
  };
  Version version() const;

  int interval_ = 2;
  double precision_ = 0.005;

  NewestFrame newest_;
  VisibleNodes nodes_;
  Version versionAtAct_;                                 ///< in the act phase of the last cycle with a frame
  bool changed_ = false;                                 ///< the newest frame has another shape than the one before
  bool skipped_ = false;                                 ///< the last frame that was due was skipped
  std::vector<std::unique_ptr<MonitorClient>> clients_;  ///< in order of arrival
  Predicates commands_;                                  ///< wait for the next cycle that executes commands
  std::int64_t dropped_ = 0;                             ///< messages since the last log line about them
  std::optional<std::int64_t> droppedLoggedAt_;          ///< cycle of the last line about them
  std::vector<std::uint32_t> mistaken_;                  ///< tokens in `commands_` whose mistakes are logged; ascending
  Mistakes logged_;                                      ///< the kinds of mistakes that are logged

  // Used by publish() and sendTo(); members, so that they keep their capacity. Indices refer to the clients of
  // sendTo().
  std::vector<MonitorClient*> ready_;
  std::vector<IMonitorEncoder*> encoders_;  ///< of each client
  std::vector<std::size_t> leaders_;        ///< of each client: the first equivalent one
  std::vector<std::size_t> encoding_;       ///< clients that are encoded: the leaders

  Link<IMonitorEncoder> encoder_;
  Link<IFrameSource> source_;
  Link<ISceneServer> scene_;
  Links<IFrameTaker> takers_;
  Links<IMonitorItem> items_;
  Links<ITrainer> trainers_;
  TreeWatch tree_;                          ///< `knownCommands_` is updated when the tree changes
  std::vector<std::string> knownCommands_;  ///< empty if a trainer has no property `commands`
  Event last_;                              ///< of the last publish phase
  bool noEncoderLogged_ = false;
};

}  // namespace spark
