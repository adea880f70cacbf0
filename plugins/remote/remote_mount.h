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
class RemoteMount : public Node, public IRemoteLink, public IConnectionConsumer {
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

  // What a recording that is played passes on.
  void connected(IConnection&) override {}
  void received(IConnection& connection, std::string_view message) override;
  void disconnected(IConnection& connection) override;

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
  List awaitRecorded(std::uint64_t number, bool patient);
  std::string silence() const;
  void refuseIfFrozen(const Leaf& node);
  bool isQuiet();
  bool isQuietNow();
  std::optional<std::string_view> take();
  void note(std::string_view message);
  void endWait();
  void keep(const List& conversation);
  void nextConversation();
  std::string conversationName() const;
  void send(const List& message) {
    if (wire_) wire_->send(message);
  }
  void acknowledge();
  double age() const;
  bool receiveOne(List& reply, std::uint64_t number);
  bool handleWhatCame();
  void pass(const List& event);
  void lose(std::string why);
  /// There is a link, or a recording of one.
  bool isConnected() const { return wire_ || replays_; }
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
  Link<IInputTape> tape_;
  bool replays_ = false;              ///< a recording is played: what the other host sent is on the tape
  bool ended_ = false;                ///< the recorded link has
  std::deque<std::string> replayed_;  ///< messages of the recording, to be handled
  std::string taken_;                 ///< the last one of them
  List conversation_;                 ///< messages while the config runs
  std::size_t conversations_ = 0;     ///< number of the last wait while a config ran
  std::uint64_t key_ = 0;             ///< of the link on the tape
  bool tellLost_ = false, passing_ = false, saidReady_ = false;
};

}  // namespace spark
