#pragma once
/// \file
/// One browser, or program, that watches: what waits to be sent to it and what is known of it. I/O thread only.

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>

#include "exchange.h"

namespace spark::web {

using Clock = std::chrono::steady_clock;

/// A message on its way; viewers that get the same share it.
struct Message {
  enum class Kind { text, scene, frame } kind = Kind::text;
  std::shared_ptr<const std::string> bytes;
  bool binary() const { return kind == Kind::frame; }
};

/// Bytes that may wait for a viewer; one that lets more pile up is closed.
inline constexpr std::size_t kMostWaiting = 16u << 20;
/// Questions of a viewer that may wait for the simulation's thread; until there are fewer, nothing more is read from
/// it.
inline constexpr std::size_t kMostAsked = 16;

/// A viewer behind some transport. Messages leave one after the other.
class Viewer {
 public:
  Viewer(std::uint64_t id, std::string peer) : id_(id), peer_(std::move(peer)) {}
  virtual ~Viewer() = default;
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  std::uint64_t id() const { return id_; }
  const std::string& peer() const { return peer_; }

  /// Puts a message behind those that wait. A viewer that does not take them is closed.
  void send(Message message);
  void sendText(std::string text) { send({Message::Kind::text, std::make_shared<const std::string>(std::move(text))}); }
  /// True when nothing waits.
  bool idle() const { return queue_.empty(); }
  /// True while a frame or scene waits: it gets no other until that has left.
  bool lags() const { return large_ > 0; }
  /// Since when the message that is leaving has been leaving; `now` when none is.
  Clock::time_point leavingSince(Clock::time_point now) const { return queue_.empty() ? now : leavingSince_; }
  /// Ends it, with a reason of at most 120 bytes that it is told.
  void close(std::string_view reason);
  bool closing() const { return closing_; }
  /// True when more may be read from it: its questions do not pile up, it takes its answers.
  bool mayRead() const { return asked.size() < kMostAsked && queue_.size() < 4 * kMostAsked; }

  // What the audience keeps of it.
  std::size_t lane = 0;
  std::uint64_t shape = 0;  ///< of the scene it was sent; 0: none
  bool needsKey = true, referee = false, wantsDrawings = false;
  int wrongTokens = 0;
  double allowance = 0;  ///< messages that it may send now
  Clock::time_point allowanceAt{};
  std::deque<Question> asked;  ///< the first is with the simulation's thread

 protected:
  /// The transport has sent the message it was given.
  void sent();

 private:
  /// Begins to send; sent() or close() follows, never from within.
  virtual void transmit(const Message& message) = 0;
  virtual void hangUp(std::string_view reason) = 0;
  /// mayRead() may be true again.
  virtual void resume() = 0;

  friend class Audience;
  const std::uint64_t id_;
  const std::string peer_;
  std::deque<Message> queue_;  ///< the first is leaving
  std::size_t waiting_ = 0;    ///< bytes
  int large_ = 0;              ///< scenes and frames that wait
  Clock::time_point leavingSince_{};
  bool closing_ = false;
};

}  // namespace spark::web
