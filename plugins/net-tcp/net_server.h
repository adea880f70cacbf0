#pragma once
/// \file
/// The network server: an I/O context that the run loop polls, with ports below it.

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <memory>
#include <vector>

#include "api/inputs.h"
#include "api/phases.h"
#include "net-tcp/handler_memory.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {

class StreamPort;

/// At /sys/server/net. It works only within calls of the run loop, in the simulation thread: a cycle sees the input
/// that had arrived when the run loop polled.
class NetServer : public Node, public IInputSource {
  SPARK_CLASS(NetServer, Node)
 public:
  NetServer();
  static void describe(Description<NetServer>& d);

  /// Opens all ports below it, unless property `open` is false. Throws Error if one cannot be opened.
  void listen();
  void poll() override;
  /// Polls until a port has delivered something, a stop is requested or `seconds` of wall time have passed.
  bool wait(double seconds) override;

  /// The I/O context of all ports. Simulation thread.
  const std::shared_ptr<boost::asio::io_context>& io() const { return io_; }

 private:
  bool pollPorts();
  /// False as well while recorded inputs are played, which come instead.
  bool isOpen() const { return open_ && !(tape_ && tape_->playing()); }
  /// At the end of a cycle, and when nothing arrives: input is acknowledged, so that no client waits with its next
  /// bytes. In a cycle most input is acknowledged by output, at no cost.
  void acknowledge();
  void endCycle(const Event&) { acknowledge(); }

  std::shared_ptr<boost::asio::io_context> io_ = std::make_shared<boost::asio::io_context>(1);
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{io_->get_executor()};
  boost::asio::steady_timer timer_{*io_};
  net::HandlerMemory timerMemory_;
  Links<StreamPort> ports_;
  Link<IInputTape> tape_;
  bool open_ = true;
  std::chrono::steady_clock::time_point heardAt_{};  ///< when a port last delivered something
};

}  // namespace spark
