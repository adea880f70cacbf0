#include <fmt/format.h>

#include <array>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <vector>

#include "team.h"

// Load for a server: agents that load a robot, join a team and then only send (syn); monitors that discard what they
// read. One process and one thread that use almost no processor time, so that measurements show the server.

namespace {
namespace asio = boost::asio;
using asio::ip::tcp;
using spark::Predicates;

class Idler : public spark::agent::Player {
 public:
  Idler(std::string team, int unum, const std::string& robot, int type)
      : team_(std::move(team)), unum_(unum), robot_(robot), type_(type) {}
  void start(Predicates& actions) override {
    actions.open("scene").add(robot_);
    if (type_ >= 0) actions.add(type_);
    actions.close();
    actions.open("syn").close();
  }
  void think(const Predicates&, Predicates& actions) override {
    if (answered_++ == 0) actions.open("init").pair("unum", unum_).pair("teamname", team_).close();
  }
  bool listens() const override { return false; }
  bool placed() const override { return answered_ > 0; }
  std::string name() const override { return fmt::format("{} {}", team_, unum_); }
  std::string result() const override { return fmt::format("{} messages for each", answered_); }

 private:
  std::string team_;
  int unum_;
  std::string robot_;
  int type_;
  std::int64_t answered_ = 0;
};

/// A monitor that reads as fast as it can.
class Watcher {
 public:
  Watcher(asio::io_context& io, const std::string& host, int port) : socket_(io) {
    asio::connect(socket_, tcp::resolver(io).resolve(host, std::to_string(port)));
    read();
  }

 private:
  void read() {
    socket_.async_read_some(asio::buffer(bytes_), [this](const boost::system::error_code& ec, std::size_t) {
      if (!ec) read();
    });
  }
  tcp::socket socket_;
  std::array<char, 65536> bytes_;
};
}  // namespace

int main(int argc, char** argv) {
  constexpr int kTeam = 11, kTypes = 5;
  spark::agent::TeamProgram program(
      "idle-team", "Load for a server: agents that stand about, and monitors that look on.", 2 * kTeam);
  const std::string nao = "rsg/agent/nao/nao_hetero.rsg";
  std::string robot = nao, other = "Idle";
  int type = -1, monitors = 0, monitorPort = 3200;
  program.addText("--robot", robot, "Scene file of the robot");
  program.addNumber("--type", type, 0, 1000,
                    "Argument of the robot's file; without it Naos are of types 0 to 4 in turn");
  program.addText("--other-team", other, "Name of the team of players 12 to 22");
  program.addNumber("--monitors", monitors, 0, 1000, "Monitors to connect");
  program.addNumber("--monitor-port", monitorPort, 1, 65535, "The server's monitor port");
  std::vector<std::unique_ptr<Watcher>> watchers;
  return program.run(argc, argv, [&](int number) {
    while (static_cast<int>(watchers.size()) < monitors)
      watchers.push_back(std::make_unique<Watcher>(program.io(), program.options().host, monitorPort));
    const bool first = number <= kTeam, mixed = type < 0 && robot == nao;
    return std::make_unique<Idler>(first ? program.options().team : other, first ? number : number - kTeam, robot,
                                   mixed ? number % kTypes : type);
  });
}
