#pragma once
/// \file
/// A part of another host's tree, mounted in this one.

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>

#include "api/credentials.h"
#include "mirror.h"
#include "remote_node.h"
#include "spark/describe.h"
#include "spark/kernel.h"
#include "wire.h"

namespace spark {

/// The mount point: below it are nodes for those of another host.
class RemoteMount : public Node, public IRemoteLink {
  SPARK_CLASS(RemoteMount, Node)
 public:
  static void describe(Description<RemoteMount>& d);

  /// Connects to `address` and fetches the tree below `of`. `token`: see RemoteServer; a Unix socket needs none. Throws
  /// Error if the host cannot be reached or refuses.
  void connect(const Secret& token);
  /// Disconnects. The nodes stay, but cannot be used.
  void close();

  Value ask(std::string_view request, const Leaf& node, List arguments) override;
  void listen(Leaf& node, const std::string& channel) override;
  void poll() override;
  bool isPending() const override {
    return !events_.empty() || tellLost_ || (wire_ && (!saidReady_ || wire_->holds()));
  }
  int descriptor() override { return wire_ ? wire_->descriptor() : -1; }

 protected:
  void onUnlink() override;

 private:
  struct Listener {
    Ref<Leaf> node;
    Channel* channel = nullptr;
  };
  std::unique_ptr<remote::Wire> open();
  Value askAbout(std::string_view request, const Leaf& node, List arguments);
  std::string pathOf(const Leaf& node) const;
  List awaitReply(std::uint64_t number);
  bool receiveOne(List& reply, std::uint64_t number);
  bool handleWhatCame();
  void pass(const List& event);
  void lose(std::string why);
  bool connected() const { return wire_ != nullptr; }
  const std::string& lostBecause() const { return lostBecause_; }

  boost::asio::io_context io_;
  std::string address_ = "127.0.0.1:3400", of_ = "/", clientName_ = "remote";
  bool waits_ = true;
  double timeout_ = 5;
  std::unique_ptr<remote::Wire> wire_;
  remote::Mirror mirror_{*this};
  std::deque<List> events_;
  std::size_t eventBytes_ = 0;  ///< of those that came since none waited
  std::map<std::uint64_t, Listener> listeners_;
  std::uint64_t lastRequest_ = 0, lastListener_ = 0;
  std::string lostBecause_ = "it was never connected";
  bool tellLost_ = false, passing_ = false, saidReady_ = false;
};

}  // namespace spark
