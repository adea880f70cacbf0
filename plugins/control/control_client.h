#pragma once
/// \file
/// A connected sparkctl.

#include <boost/asio/local/stream_protocol.hpp>
#include <string>

#include "requests.h"

namespace spark::control {

/// Reads requests and writes answers, one per line, without blocking. Owned by the ControlServer.
class ControlClient {
 public:
  using Socket = boost::asio::local::stream_protocol::socket;
  /// `socket`: connected.
  explicit ControlClient(Socket socket);

  /// Writes unsent output, then answers at most one request or, without one, polls the watch. False if the connection
  /// is to be closed: it ended, or a request is too long. `self`: the server's node.
  bool serve(Kernel& kernel, const Node& self);
  /// True if it has sent a request.
  bool hasAsked() const { return asked_; }

 private:
  bool flush();
  bool read();
  void writeLine(const std::string& line);

  Socket socket_;
  std::string in_, out_;  ///< received and not handled; not sent yet
  Watch watch_;           ///< of the last watch request
  bool asked_ = false;
};

}  // namespace spark::control
