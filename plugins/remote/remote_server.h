#pragma once
/// \file
/// Serves the tree to other hosts, and looks after the parts of other trees that are mounted in this one.

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/credentials.h"
#include "api/inputs.h"
#include "api/net.h"
#include "api/phases.h"
#include "remote_node.h"
#include "session.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {

/// Emitted at the server and at a mount when a remote host has gone; the data is {its name or address, why}.
inline constexpr ChannelName kRemoteLost{"remoteLost"};
/// Emitted at the server when a remote host has mounted a part of the tree; the data is its name.
inline constexpr ChannelName kRemoteJoined{"remoteJoined"};

/// The server of remote nodes, at /sys/server/remote. Hosts that mount this one's tree are its clients; the mounts in
/// this host's own tree are served by it, too.
class RemoteServer : public Node, public IInputSource, public IInputGate, public IConnectionConsumer {
  SPARK_CLASS(RemoteServer, Node)
 public:
  static constexpr const char* kPath = "/sys/server/remote";
  static void describe(Description<RemoteServer>& d);

  /// Listens for hosts. `address`: see remote::Address; port 0 is a free one. `token`: what they must know; "" makes
  /// one up. A Unix socket is open to the user of this host only and needs none. Does nothing while a recording is
  /// played. Throws Error if it listens already, or if the address cannot be used.
  void listen(const std::string& address, const Secret& secret);
  /// The token, for what prints it.
  const std::string& token() const { return token_; }

  /// The number of a wait for an answer while a config runs, from 1: mounts name by it what they heard.
  std::size_t nextConversation() { return ++conversations_; }

  void poll() override;
  bool wait(double seconds) override;
  bool canWait() const override { return !mounts_.empty(); }

  bool ready(bool lockstep) override;
  /// True in a cycle, from its beginning to its last phase: what a mount has then is what it has for this cycle.
  bool inCycle() const { return inCycle_; }

  // What a recording that is played passes on.
  void connected(IConnection& connection) override;
  void received(IConnection& connection, std::string_view message) override;
  void disconnected(IConnection& connection) override;

 protected:
  void onLink() override;
  void onUnlink() override;

 private:
  template <class Acceptor>
  void acceptFrom(std::optional<Acceptor>& acceptor);
  template <class Acceptor>
  bool acceptOne(Acceptor& acceptor);
  bool makeRoom();
  void listenAt(const boost::asio::ip::tcp::endpoint& endpoint);
  void listenAt(const std::string& path);
  void dismiss();
  void beginCycle(const Event&) { inCycle_ = true; }
  void endCycle(const Event&) { inCycle_ = false; }
  void setPatience();
  remote::Session* sessionOf(std::uint64_t key);
  std::int64_t clients() const { return static_cast<std::int64_t>(sessions_.size()); }
  std::int64_t lateEvents() const;

  boost::asio::io_context io_;
  std::optional<boost::asio::ip::tcp::acceptor> tcp_;
  std::optional<boost::asio::local::stream_protocol::acceptor> local_;
  std::string address_, token_;
  double patience_ = 0.005, lockstepPatience_ = 10;
  Link<IInputTape> tape_;
  remote::Host host_{*this, tape_, simulation_, {}};  ///< its patience as the run loop runs now
  std::vector<std::unique_ptr<remote::Session>> sessions_;
  std::uint64_t lastKey_ = 0;
  int expect_ = 0;
  bool inCycle_ = false;
  bool released_ = false;        ///< those that were expected have come
  std::int64_t lateEvents_ = 0;  ///< of those that have gone
  std::size_t conversations_ = 0;
  Channel* lost_ = nullptr;
  Channel* joined_ = nullptr;
  Link<ISimulation> simulation_;
  Links<IRemoteLink> mounts_;
};

}  // namespace spark
