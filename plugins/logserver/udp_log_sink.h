#pragma once

#include "log_sink.h"

namespace spark {

/// Sends each message as a datagram to another program, which may be slow, absent, or on another machine: the
/// simulation never waits for it.
class UdpLogSink : public LogSink {
  SPARK_CLASS(UdpLogSink, LogSink)
 public:
  static void describe(Description<UdpLogSink>& d);

 protected:
  std::shared_ptr<spdlog::logger> open() override;
  const char* advice() const override { return "Check host and port"; }
  std::size_t longest() const override { return 65000; }  // what a datagram holds, with time and level

 private:
  const std::string& host() const { return host_; }
  void setHost(std::string host);
  int port() const { return port_; }
  void setPort(int port);
  std::string host_ = "127.0.0.1";
  int port_ = 0;
};

}  // namespace spark
