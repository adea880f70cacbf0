#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <optional>

#include "api/phases.h"
#include "draw_board.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {

/// Keeps what agents draw, for the viewers that ask: from a UDP port in the format of the installed base's viewer, from
/// effectors, from other plugins. At /sys/server/drawing. The match does not depend on it, it is no state.
///
///     agents ─► UDP port ─► poll, so many packets each ─┐
///     agents ─► DrawEffector, act phase ────────────────┼─► board ─► the browser's viewer, the log
///     plugins ─► draw() ────────────────────────────────┘       └─► packets to another viewer (`forward`)
class DrawingServer : public Leaf, public IDrawings, public IInputSource {
  SPARK_CLASS(DrawingServer, Leaf)
 public:
  static void describe(Description<DrawingServer>& d);

  std::uint64_t version() const override { return board_.version(); }
  std::span<const Set> sets() const override { return board_.sets(); }
  void draw(std::span<const std::byte> packet) override;
  void record(std::uint64_t since, std::string& out) const override { board_.record(since, out); }

  /// Shows these shapes under a name, instead of what was there; texts of agents are set.
  void show(std::string_view set, std::vector<Drawing> shapes);

  void poll() override;
  /// Does not wait: poll() is all it has.
  bool wait(double) override { return false; }
  bool canWait() const override { return false; }

 protected:
  void onUnlink() override;

 private:
  using Udp = boost::asio::ip::udp;
  void open();
  void openPort();
  void openForward();
  void forward(std::string_view packet);
  void clear() { board_.clear(); }
  int port() const { return port_; }
  void setPort(int port);
  const std::string& address() const { return address_; }
  void setAddress(std::string address);
  const std::string& forwardTo() const { return forwardTo_; }
  void setForwardTo(std::string to);
  std::int64_t packets() const { return packets_; }
  std::int64_t refused() const { return refused_; }
  std::vector<std::string> names() const;

  int port_ = -1;
  std::string address_ = "127.0.0.1", forwardTo_;
  bool opened_ = false;
  drawing::DrawBoard board_;
  boost::asio::io_context io_;
  std::optional<Udp::socket> in_, out_;
  Udp::endpoint forwardedFrom_;  ///< of out_
  std::int64_t packets_ = 0, refused_ = 0;
};

}  // namespace spark
