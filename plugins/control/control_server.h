#pragma once
/// \file
/// The local socket through which sparkctl inspects and controls a running simulation.

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

/// At /sys/server/control. It works only in the run loop's poll, between two cycles, so changes by requests are
/// ordinary inputs. Other servers use it to answer requests of their clients (IRequests). Children may answer further
/// requests (IRequestHandler).
class ControlServer : public Node, public IInputSource, public IRequests {
  SPARK_CLASS(ControlServer, Node)
 public:
  static void describe(Description<ControlServer>& d);

  void poll() override;
  /// Does not wait; see canWait().
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
  std::string socket_;  ///< path of the socket; "": none
};

}  // namespace spark
