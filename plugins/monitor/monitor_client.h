#pragma once

#include <string>

#include "api/net.h"
#include "monitor_view.h"

namespace spark {

/// A monitor behind a connection. There is no queue of frames: only when the last message has left is the next one
/// made, from the newest frame.
class MonitorClient {
 public:
  /// Both must outlive the client.
  MonitorClient(IConnection& connection, const NewestFrame& newest) : view(newest), connection_(connection) {}

  MonitorView view;

  IConnection& connection() const { return connection_; }
  /// Makes the next message. Touches only this client: clients may do it at the same time.
  void encode(IMonitorEncoder& encoder) {
    message_.clear();
    view.encode(encoder, message_);
  }
  const std::string& message() const { return message_; }
  /// Hands a message to the connection: its own, or that of a client whose view is like its own.
  void send(const std::string& message) {
    if (connection_.send(message))
      view.delivered();
    else
      view.requestFull();  // it was not taken: nothing is known of what the client has
  }

 private:
  IConnection& connection_;
  std::string message_;
};

}  // namespace spark
