#pragma once
/// \file
/// A connected monitor.

#include <string>

#include "api/net.h"
#include "monitor_view.h"

namespace spark {

/// A monitor behind a connection. There is no queue of frames: the next message is encoded when the last one has been
/// sent, from the newest frame.
class MonitorClient {
 public:
  /// `connection` and `newest` must outlive it.
  MonitorClient(IConnection& connection, const NewestFrame& newest) : view(newest), connection_(connection) {}

  MonitorView view;  ///< what the client was sent

  IConnection& connection() const { return connection_; }
  /// Encodes the next message. Changes only this client: several clients may be encoded in parallel.
  void encode(IMonitorEncoder& encoder) {
    message_.clear();
    view.encode(encoder, message_);
  }
  /// The message that was encoded last.
  const std::string& message() const { return message_; }
  /// Sends a message: its own, or that of a client with an equivalent view.
  void send(const std::string& message) {
    if (connection_.send(message))
      view.delivered();
    else
      view.requestFull();  // the message was dropped, so the view does not describe what the client has
  }

 private:
  IConnection& connection_;
  std::string message_;
};

}  // namespace spark
