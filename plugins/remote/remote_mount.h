#pragma once
/// \file
/// A part of another host's tree, mounted in this one.

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "api/credentials.h"
#include "api/phases.h"
#include "mirror.h"
#include "remote_node.h"
#include "remote_server.h"
#include "spark/describe.h"
#include "spark/kernel.h"
#include "spark/link.h"
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
  Value read(const Leaf& node, const std::string& property) override;
  void listen(Leaf& node, const std::string& channel) override;
  IEventSource* eventsOf(Leaf& node) override;
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
  using Clock = std::chrono::steady_clock;
  /// Events of a scene node.
  struct Source : IEventSource {
    Source(RemoteMount& m, Leaf& n) : mount(m), node(&n) {}
    void listened(const std::string& channel) override {
      if (node) mount.listen(*node, channel);
    }
    RemoteMount& mount;
    Ref<Leaf> node;
  };
  std::unique_ptr<remote::Wire> open();
  List askAbout(std::string_view request, const Leaf& node, List arguments, std::optional<double> patience = {});
  std::string pathOf(const Leaf& node) const;
  List awaitReply(std::uint64_t number, std::optional<double> patience = {});
  bool isQuiet();
  void acknowledge();
  double age() const;
  bool receiveOne(List& reply, std::uint64_t number);
  bool handleWhatCame();
  void pass(const List& event);
  void lose(std::string why);
  bool connected() const { return wire_ != nullptr; }
  const std::string& lostBecause() const { return lostBecause_; }

  boost::asio::io_context io_;
  std::string address_ = "127.0.0.1:3400", of_ = "/", clientName_ = "remote";
  bool waits_ = true;
  double timeout_ = 5, patience_ = 0.1;
  std::unique_ptr<remote::Wire> wire_;
  remote::Mirror mirror_{*this};
  std::deque<List> events_;
  std::size_t eventBytes_ = 0;  ///< of those that came since none waited
  std::map<std::uint64_t, Listener> listeners_;
  std::map<std::uint64_t, std::unique_ptr<Source>> sources_;  ///< by Leaf::id
  std::uint64_t lastRequest_ = 0, lastListener_ = 0;
  std::uint64_t handled_ = 0;  ///< the last message of values that was acknowledged
  Clock::time_point came_;     ///< when the last message came
  double cameAt_ = 0;          ///< the same in simulated time [s]
  bool quiet_ = false;         ///< an answer was late, and nothing has come since
  std::string lostBecause_ = "it was never connected";
  Link<ISimulation> simulation_;
  Link<RemoteServer> server_;
  bool tellLost_ = false, passing_ = false, saidReady_ = false;
};

}  // namespace spark
