#pragma once
/// \file
/// One sparkctl that is connected.

#include <boost/asio/local/stream_protocol.hpp>
#include <string>

#include "requests.h"

namespace spark::control {

/// Reads lines and writes answers without ever waiting. Owned by the server.
class ControlClient {
 public:
  using Socket = boost::asio::local::stream_protocol::socket;
  explicit ControlClient(Socket socket);

  /// Writes what waits, then answers at most one request and looks at its watch. Returns false when the client is gone
  /// or misbehaves.
  bool serve(Kernel& kernel, const Node& self);

 private:
  bool flush();
  bool read();
  void say(const std::string& line);

  Socket socket_;
  std::string in_, out_;
  Watch watch_;
};

}  // namespace spark::control
