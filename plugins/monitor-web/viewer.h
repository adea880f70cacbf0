#pragma once
/// \file
/// One connected viewer (a browser or another client of the stream): its outgoing queue and its settings. I/O thread
/// only.

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>

#include "exchange.h"

namespace spark::web {

using Clock = std::chrono::steady_clock;

/// An outgoing message. The bytes are shared by all viewers that get the same message.
struct Message {
  enum class Kind { text, scene, frame, outline, piece } kind = Kind::text;
  std::shared_ptr<const std::string> bytes;
  /// True for frames and pieces of the past, which are WebSocket binary messages; the others are text messages.
  bool binary() const { return kind == Kind::frame || kind == Kind::piece; }
  /// Frames are skipped for a viewer while one of these is queued for it.
  bool isPicture() const { return kind == Kind::scene || kind == Kind::frame; }
  /// While one of these is queued for a viewer, nothing is read from it: it gets one at a time.
  bool isPast() const { return kind == Kind::outline || kind == Kind::piece; }
};

/// Maximum number of queued bytes of a viewer; beyond it the viewer is disconnected.
inline constexpr std::size_t kMaxQueuedBytes = 16u << 20;
/// Maximum number of requests of a viewer that wait for the simulation thread; at this number reading from it pauses.
inline constexpr std::size_t kMaxPendingRequests = 16;

/// A viewer behind a transport that a derived class implements. Messages are sent one at a time, in order.
class Viewer {
 public:
  /// `id`: unique in this process, never 0. `peer`: "address:port", for the log.
  Viewer(std::uint64_t id, std::string peer) : id_(id), peer_(std::move(peer)) {}
  virtual ~Viewer() = default;
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  std::uint64_t id() const { return id_; }
  const std::string& peer() const { return peer_; }

  /// Appends a message to the queue. Closes the viewer if the queue exceeds kMaxQueuedBytes. Does nothing after
  /// close().
  void send(Message message);
  /// Sends a text message.
  void sendText(std::string text) { send({Message::Kind::text, std::make_shared<const std::string>(std::move(text))}); }
  /// True if the queue is empty.
  bool idle() const { return queue_.empty(); }
  /// True while a frame or a scene is queued: the viewer gets no other frame until it has been sent.
  bool lags() const { return queuedFrames_ > 0; }
  /// When sending of the current message began; `now` if the queue is empty.
  Clock::time_point sendingSince(Clock::time_point now) const { return queue_.empty() ? now : sendingSince_; }
  /// Disconnects it. `reason`: at most 120 bytes, sent in the close frame if nothing else is queued.
  void close(std::string_view reason);
  bool closing() const { return closing_; }
  /// True if the transport may read the next message: few requests are pending, few messages and nothing of the past
  /// are queued.
  bool mayRead() const {
    return pending.size() < kMaxPendingRequests && queue_.size() < 4 * kMaxPendingRequests && queuedPast_ == 0;
  }

  // State that the ViewerHub keeps per viewer.
  std::size_t lane = 0;     ///< index of the hub's lane
  std::uint64_t shape = 0;  ///< of the scene that was sent to it last; 0: none yet
  bool needsKey = true, referee = false, wantsDrawings = false;
  int wrongTokens = 0;                    ///< failed logins
  double messageBudget = 0;               ///< messages that it may send now; negative: too many
  Clock::time_point budgetUpdatedAt{};    ///< when `messageBudget` was refilled last
  std::deque<SimulationRequest> pending;  ///< the first one is with the simulation thread

 protected:
  /// The transport calls this after it has sent the message passed to transmit().
  void sent();

 private:
  /// Starts to send a message. sent() or close() follows asynchronously, not within this call.
  virtual void transmit(const Message& message) = 0;
  /// Closes the connection.
  virtual void disconnect(std::string_view reason) = 0;
  /// Called when mayRead() may have become true.
  virtual void resume() = 0;

  friend class ViewerHub;
  const std::uint64_t id_;
  const std::string peer_;
  std::deque<Message> queue_;    ///< the first one is being sent
  std::size_t queuedBytes_ = 0;  ///< of all messages in the queue
  int queuedFrames_ = 0;         ///< scenes and frames in the queue
  int queuedPast_ = 0;           ///< messages of the past in the queue
  Clock::time_point sendingSince_{};
  bool closing_ = false;
};

}  // namespace spark::web
