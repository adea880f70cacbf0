#pragma once
/// \file
/// All connected viewers and what is sent to each of them. I/O thread only; independent of sockets.
///
/// Viewers with the same rate and detail share a lane: a frame is quantised and encoded once per lane, as a delta and,
/// if one of its viewers needs it, as a key frame. A viewer that is still busy with an earlier frame skips frames and
/// resumes with a key frame.
///
/// The hub requests a snapshot from the simulation thread shortly before the next lane is due, and whenever simulated
/// time has advanced enough for the history's next frame. Without viewers and history it requests none. Those that only
/// the history wants come several at once.

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "asset_list.h"
#include "history.h"
#include "stream/messages.h"
#include "stream/stream_encoder.h"
#include "viewer.h"
#include "viewer_message.h"

namespace spark {
class Log;
}

namespace spark::web {

/// Settings of a ViewerHub; fixed while it lives.
struct ViewerHubSettings {
  std::string token;                     ///< the referee's
  double step = 0.02;                    ///< s, simulated time of a cycle
  double rate = 20;                      ///< frames a second, unless a viewer requests another rate
  double stallTimeout = 10;              ///< s; a viewer whose current message takes longer to send is disconnected
  double history = 0;                    ///< s, simulated time that is kept for viewers; 0: none
  std::size_t historyBytes = 64u << 20;  ///< most memory for it
};

class ViewerHub {
 public:
  using StatusCallback = std::function<void(const std::string& status)>;

  /// `exchange` and `log` must outlive it.
  ViewerHub(Exchange& exchange, Log& log, ViewerHubSettings settings);
  ~ViewerHub();

  /// Adds a viewer whose handshake is done, and sends the greeting.
  void onConnect(const std::shared_ptr<Viewer>& viewer, Clock::time_point now);
  /// Removes a viewer whose connection ended.
  void onDisconnect(Viewer& viewer);
  /// Counts a control frame (ping, pong) against the viewer's message budget; false if the budget is exceeded.
  bool onPing(Viewer& viewer, Clock::time_point now) { return charge(viewer, now); }
  /// Handles a text message of a viewer.
  void onMessage(Viewer& viewer, std::string_view message, Clock::time_point now);
  /// Removes all viewers and status callbacks, on shutdown.
  void clear();

  /// Takes the snapshot and the replies that the simulation thread has put into the exchange, and sends them.
  void collect(Clock::time_point now);
  /// Does what is due: requests a snapshot and the status, disconnects viewers that stall. Returns when to call it
  /// again.
  Clock::time_point tick(Clock::time_point now);

  /// The meshes and textures of all scenes so far.
  AssetList& assets() { return assets_; }
  /// Number of viewers.
  std::size_t size() const { return viewers_.size(); }
  /// Calls `callback` once with the status message, `{"type":"status",...}`: at once if one of the last second is
  /// known, otherwise when the simulation thread has replied. After two seconds without a reply it gets the last known
  /// status, or "{}".
  void requestStatus(Clock::time_point now, StatusCallback callback);

 private:
  struct Lane {
    double rate;
    bool fine;
    StreamEncoder encoder;
    Clock::time_point due{};
    int viewers = 0;
    std::shared_ptr<const std::string> key{}, delta{};  ///< of the last frame; nullptr: not encoded yet
  };
  struct StatusWaiter {
    StatusCallback callback;
    Clock::time_point since;
  };
  Viewer* find(std::uint64_t id);
  std::size_t laneFor(double rate, bool fine);
  void enterLane(Viewer& viewer, double rate, bool fine);
  bool charge(Viewer& viewer, Clock::time_point now);
  bool keepsHistory() const { return history_.has_value(); }
  void handle(Viewer& viewer, ViewerMessage message);
  void login(Viewer& viewer, std::string_view token);
  void sendPast(Viewer& viewer, const ViewerMessage& message);
  void sendOutline(Viewer& viewer, std::int64_t id);
  void enqueue(Viewer& viewer, SimulationRequest request);

  bool takeSnapshot(Snapshot& snapshot, Clock::time_point now);
  void takeScene(Snapshot& snapshot, Clock::time_point now);
  void sendEnvironment(const Snapshot& snapshot, Clock::time_point now);
  void sendLane(std::size_t lane, const Snapshot& snapshot, Clock::time_point now);
  void sendFrame(Viewer& viewer, Lane& lane, const Snapshot& snapshot);
  void sendScene(Viewer& viewer, const Snapshot& snapshot);

  void takeBatch(Clock::time_point now);
  void takeReplies();
  void completeRequest(Viewer& viewer);
  void takeStatus(std::string text);
  void broadcast(std::string text);
  void multicast(SimulationReply reply);

  Clock::time_point requestSnapshot(Clock::time_point now);
  void expireStatusWaiters(Clock::time_point now);
  void disconnectStalled(Clock::time_point now);

  Exchange& exchange_;
  Log& log_;
  const ViewerHubSettings settings_;
  AssetList assets_;
  std::map<std::uint64_t, std::shared_ptr<Viewer>> viewers_;  ///< by id, which is the order of arrival
  std::vector<Lane> lanes_;                                   ///< lanes without viewers stay for reuse

  SnapshotBatch batch_;                       ///< not to be touched while `batchLent_`
  bool batchLent_ = false;                    ///< the simulation thread has it
  std::shared_ptr<const std::string> scene_;  ///< the scene message
  std::uint64_t shape_ = 0;                   ///< MonitorFrame::shape of `scene_`
  std::uint32_t shapeNumber_ = 0;             ///< the same in messages: counts from 1
  Clock::time_point sceneAt_{};               ///< when `scene_` was made
  FrameScene frameScene_;                     ///< the same for frames
  ChangeTracker environment_;
  Clock::time_point alwaysDue_{};  ///< when entries with policy `always` are sent again

  std::optional<History> history_;  ///< of the last minutes; empty: none is kept

  std::string status_;  ///< the last status message; "": none yet
  bool statusRequested_ = false;
  std::vector<StatusWaiter> statusWaiters_;
  Clock::time_point statusAt_{};   ///< when `status_` came
  Clock::time_point statusDue_{};  ///< when the status is requested again
  Clock::time_point stallsDue_{};  ///< when to check for stalled viewers again
};

}  // namespace spark::web
