#pragma once
/// \file
/// All viewers, and what each is to get. I/O thread only; knows no sockets.
///
/// Viewers that want the same rate and detail share a lane: a frame is quantised and encoded once for all of them, as a
/// delta and, when somebody needs one, as a key. A viewer that has not taken the last frame misses the next ones and
/// gets a key when it is back.
///
/// The simulation's thread is asked for a snapshot shortly before the next lane is due, and not at all while nobody
/// watches.

#include <functional>
#include <map>
#include <vector>

#include "messages.h"
#include "stream_encoder.h"
#include "viewer.h"
#include "viewer_message.h"

namespace spark {
class Log;
}

namespace spark::web {

/// What the audience is told once.
struct AudienceSettings {
  std::string token;         ///< of the referee
  double step = 0.02;        ///< s, of a cycle
  double rate = 20;          ///< frames a second, unless a viewer asks for another
  double stallTimeout = 10;  ///< s; a viewer that takes nothing for so long is closed
};

class Audience {
 public:
  /// Both must outlive it.
  Audience(Exchange& exchange, Log& log, AudienceSettings settings);
  ~Audience();

  /// A viewer has come: it is greeted.
  void arrived(const std::shared_ptr<Viewer>& viewer, Clock::time_point now);
  /// A viewer is gone; its transport sends no more.
  void left(Viewer& viewer);
  /// Forgets all viewers and whoever waits, when nothing is served any more.
  void dismiss();
  /// A viewer has sent a frame that says nothing, a ping; false when it sends too many.
  bool knocked(Viewer& viewer, Clock::time_point now) { return allowed(viewer, now); }
  /// A viewer has said something.
  void said(Viewer& viewer, std::string_view message, Clock::time_point now);
  /// Takes what the simulation's thread has handed over, and sends what follows from it.
  void collect(Clock::time_point now);
  /// What is due by now: wants a snapshot, closes who stalls, asks how the host is doing. Returns when to call again.
  Clock::time_point tick(Clock::time_point now);

  std::size_t size() const { return viewers_.size(); }
  /// Tells how the host is doing, `{"type":"status",...}`, as soon as that is known; at once if it was asked a moment
  /// ago.
  void whenStatus(Clock::time_point now, std::function<void(const std::string&)> hear);

 private:
  struct Lane {
    double rate;
    bool fine;
    StreamEncoder encoder;
    Clock::time_point due{};
    int viewers = 0;
    /// Of the last frame; made when somebody needs it.
    std::shared_ptr<const std::string> key{}, delta{};
  };
  Viewer* find(std::uint64_t id);
  std::size_t laneFor(double rate, bool fine);
  void enter(Viewer& viewer, double rate, bool fine);
  bool allowed(Viewer& viewer, Clock::time_point now);
  void act(Viewer& viewer, ViewerMessage message);
  void login(Viewer& viewer, std::string_view token);
  void ask(Viewer& viewer, Question question);

  void takeSnapshot(Clock::time_point now);
  void takeAnswers();
  void tellEnvironment(Clock::time_point now);
  void takeScene(Clock::time_point now);
  void noteFlickers();
  void sendLane(std::size_t lane, Clock::time_point now);
  void sendFrame(Viewer& viewer, Lane& lane);
  void sendScene(Viewer& viewer);
  Clock::time_point wantSnapshot(Clock::time_point now);
  void takeStatus(std::string text);
  void giveUpOnStatus(Clock::time_point now);
  void broadcast(std::string text);
  void tellSome(Answer answer);

  Exchange& exchange_;
  Log& log_;
  const AudienceSettings settings_;
  std::map<std::uint64_t, std::shared_ptr<Viewer>> viewers_;  ///< in order of arrival
  std::vector<Lane> lanes_;

  Snapshot snapshot_;                         ///< ours, while it is not with the simulation's thread
  bool away_ = false;                         ///< it is
  std::shared_ptr<const std::string> scene_;  ///< the message
  std::uint64_t shape_ = 0;                   ///< of scene_
  std::uint32_t shapeNumber_ = 0;             ///< as viewers know it
  Clock::time_point sceneAt_{};
  std::vector<std::uint8_t> visible_;    ///< as the scene was sent
  std::vector<std::uint32_t> flickers_;  ///< nodes that were otherwise since
  EnvironmentDiary diary_;
  Clock::time_point alwaysDue_{};
  std::string status_;
  bool statusAsked_ = false;
  std::vector<std::pair<std::function<void(const std::string&)>, Clock::time_point>>
      statusWaiters_;  ///< and since when
  Clock::time_point statusAt_{}, statusDue_{}, stallsDue_{};
};

}  // namespace spark::web
