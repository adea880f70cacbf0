#pragma once
/// \file
/// The network server: one I/O context that the run loop polls, ports below it.

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <vector>

#include "api/phases.h"
#include "net-tcp/handler_memory.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {

class TcpPort;

/// At /sys/server/net. Works in the simulation's thread only: nothing happens between the run loop's calls but what the
/// operating system does, so a cycle sees the input that was there when it asked.
class NetServer : public Node, public IInputSource {
  SPARK_CLASS(NetServer, Node)
 public:
  NetServer();
  static void describe(Description<NetServer>& d);

  /// Opens all ports below, unless the network is to stay closed. Throws Error.
  void listen();
  void poll() override;
  bool wait(double seconds) override;

  const std::shared_ptr<boost::asio::io_context>& io() const { return io_; }

 private:
  bool round();

  std::shared_ptr<boost::asio::io_context> io_ = std::make_shared<boost::asio::io_context>(1);
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{io_->get_executor()};
  boost::asio::steady_timer timer_{*io_};
  net::HandlerMemory timerMemory_;
  Links<TcpPort> ports_;
  bool open_ = true;
};

}  // namespace spark
