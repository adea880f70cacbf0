#pragma once
/// \file
/// The drawing server.

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <optional>

#include "api/phases.h"
#include "draw_board.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {

/// Keeps agents' drawings for viewers. They come from a UDP port in the format of RoboViz, from effectors and from
/// other plugins. At /sys/server/drawing. The match does not depend on drawings, and they are not state.
///
///     agents ─► UDP port ─► poll, a limited number each ─┐
///     agents ─► DrawEffector, act phase ─────────────────┼─► DrawBoard ─► the browser's viewer, the log
///     plugins ─► draw() ─────────────────────────────────┘       └─────► packets to another viewer (`forward`)
class DrawingServer : public Leaf, public IDrawings, public IInputSource {
  SPARK_CLASS(DrawingServer, Leaf)
 public:
  static void describe(Description<DrawingServer>& d);

  std::uint64_t version() const override { return board_.version(); }
  std::span<const Set> sets() const override { return board_.sets(); }
  void draw(std::span<const std::byte> packet) override;
  void record(std::uint64_t since, std::string& out) const override { board_.record(since, out); }

  /// Replaces the shapes of a set; agents' texts are set.
  void show(std::string_view set, std::vector<Drawing> shapes);

  void poll() override;
  /// Does not wait; see canWait().
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
  bool opened_ = false;  ///< ports are open, or could not be opened; false after a change of their properties
  drawing::DrawBoard board_;
  boost::asio::io_context io_;
  std::optional<Udp::socket> in_, out_;  ///< the UDP port; to the viewer of `forward`
  Udp::endpoint forwardedFrom_;          ///< local endpoint of out_
  std::int64_t packets_ = 0, refused_ = 0;
};

}  // namespace spark
