#pragma once
/// \file
/// A host that has mounted a part of this one's tree.

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "api/inputs.h"
#include "scene_feed.h"
#include "spark/event.h"
#include "spark/kernel.h"
#include "spark/link.h"
#include "tree_feed.h"
#include "wire.h"

namespace spark::remote {

/// How long a host waits for the handlers of a remote one.
struct Patience {
  double seconds = 0;    ///< at most, for one event
  bool givesUp = false;  ///< the remote host is given up then; else the simulation goes on without its answer
};

/// What all sessions of a server share; it must outlive them.
struct Host {
  Node& server;
  const Link<IInputTape>& tape;  ///< records what remote hosts change, or plays it
  const Link<ISimulation>& simulation;
  Patience patience;
};

/// Answers the requests of a remote host, and passes events to its handlers. Simulation thread.
class Session {
 public:
  /// `wire`: nullptr while a recording is played: what is sent then goes nowhere. `key`: of the connection on the tape.
  Session(const Host& host, std::uint64_t key, std::unique_ptr<Wire> wire, std::string peer);
  /// Removes its handlers.
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Receives and answers what has arrived, and sends changes of the tree. For clients that still have to say hello,
  /// `token` is what they must know; "": nothing.
  void poll(std::string_view token);
  /// Handles a message of a played recording.
  void replay(std::string_view message);
  /// The connection is over. `why` is a sentence for the log.
  void lose(std::string why);

  std::uint64_t key() const { return key_; }
  bool isLost() const { return !why_.empty(); }
  /// The last words: why it was lost.
  const std::string& why() const { return why_; }
  /// True once it has said hello.
  bool isOpen() const { return open_; }
  /// True once all its handlers are there.
  bool isReady() const { return ready_; }
  const std::string& name() const { return name_; }
  const std::string& peer() const { return peer_; }
  /// As of the system, for waiting; -1 while a recording is played.
  int descriptor() const { return wire_ ? wire_->descriptor() : -1; }
  /// Number of events to which it answered too late.
  std::int64_t lateEvents() const { return lateEvents_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Listener {
    Channel* channel = nullptr;
    std::uint64_t subscription = 0;
  };
  void receive(std::string_view token);
  void handle(std::string_view bytes, std::string_view token);
  void hello(const List& message, std::string_view token);
  void answer(const List& message);
  Value perform(const List& message);
  void listen(const List& message);
  void pass(std::uint64_t number, bool waits, const Event& event);
  void await(std::uint64_t event);
  void fail(const Event& event, std::string_view why);
  void note(Input::Kind kind, std::string_view text);
  void send(const List& message);
  void feed(bool now);
  Leaf& leafAt(const Value& path) const;

  const Host& host_;
  std::uint64_t key_;
  std::unique_ptr<Wire> wire_;
  std::string peer_, name_, why_;
  Ref<Node> root_;
  TreeFeed tree_;
  SceneFeed scene_;
  std::map<std::uint64_t, Listener> listeners_;  ///< by the remote host's number
  std::uint64_t asked_ = 0, done_ = 0;           ///< numbers of the last event that is awaited, and that was answered
  Value reply_;                                  ///< what each of its handlers answered
  bool replyFails_ = false;                      ///< one of its handlers failed
  bool saidFailure_ = false;                     ///< the log has an answer that is missing or failed
  std::int64_t lateEvents_ = 0;
  bool open_ = false;      ///< it has said hello
  bool ready_ = false;     ///< it has said so
  bool handling_ = false;  ///< a request is being answered
  Clock::time_point began_ = Clock::now();
};

}  // namespace spark::remote
