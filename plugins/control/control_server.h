#pragma once
/// \file
/// The local socket through which sparkctl looks at a running house.

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "api/phases.h"
#include "control_client.h"
#include "spark/describe.h"

namespace spark {

/// At /sys/server/control. Works only in the run loop's poll, between two cycles: what it changes is an input like any
/// other. Other servers that hear clients let it answer for them; its children answer further requests.
class ControlServer : public Node, public IInputSource, public IRequests {
  SPARK_CLASS(ControlServer, Node)
 public:
  static void describe(Description<ControlServer>& d);

  void poll() override;
  /// Does not wait: poll() is all it has.
  bool wait(double) override { return false; }
  bool canWait() const override { return false; }

  std::string answer(std::string_view request, control::Watch& watch, bool mayChange) override;
  std::string nextOf(control::Watch& watch, bool& done) override;

 protected:
  void onLink() override;
  void onUnlink() override;

 private:
  using Protocol = boost::asio::local::stream_protocol;

  void open();
  void accept();
  const std::string& socket() const { return socket_; }
  int clients() const { return static_cast<int>(clients_.size()); }

  boost::asio::io_context io_;
  std::optional<Protocol::acceptor> acceptor_;
  std::vector<std::unique_ptr<control::ControlClient>> clients_;
  std::string socket_;
};

}  // namespace spark
