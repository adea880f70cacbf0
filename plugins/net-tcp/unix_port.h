#pragma once
/// \file
/// A port for clients on the same machine: a Unix socket.

#include <string>

#include "net-tcp/stream_port.h"

namespace spark {

/// Listens on a Unix socket, which only the user of this host can open. Simulation thread only.
class UnixPort : public StreamPort {
  SPARK_CLASS(UnixPort, StreamPort)
 public:
  static void describe(Description<UnixPort>& d);

  const std::string& file() const { return file_; }
  /// Throws Error if it listens already.
  void setFile(std::string file);
  std::string where() const override { return file_; }

 protected:
  void open(Acceptor& acceptor) override;
  Accepted accepted(net::Stream::socket socket) const override;
  void closed() override;

 private:
  std::string file_;
  std::string bound_;  ///< the file of the open socket, absolute
};

}  // namespace spark
