#pragma once
/// \file
/// A port for clients over TCP.

#include <string>

#include "net-tcp/stream_port.h"

namespace spark {

/// Listens on a TCP port. Simulation thread only.
class TcpPort : public StreamPort {
  SPARK_CLASS(TcpPort, StreamPort)
 public:
  static void describe(Description<TcpPort>& d);

  /// The port number: the open one if it listens, otherwise the property, where 0 means any free port.
  int port() const { return port_; }
  /// Throws Error if it listens already.
  void setPort(int port);
  std::string where() const override { return fmt::format("{}:{}", address_, port_); }

 protected:
  void open(Acceptor& acceptor) override;
  Accepted accepted(net::Stream::socket socket) const override;

 private:
  int port_ = 0;
  std::string address_ = "0.0.0.0";
};

}  // namespace spark
