#pragma once
/// \file
/// The simulation of lua/soccer.lua in this process, with players and a trainer that connect over TCP like any client.
/// The test runs it cycle by cycle. Before a cycle all sent bytes have arrived, and after it all clients have read
/// their messages, so nothing depends on timing.

#include <catch2/catch.hpp>
#include <deque>

#include "api/phases.h"
#include "loopback_client.h"
#include "monitor_view.h"
#include "spark/script_server.h"
#include "spark/state.h"
#include "test_support.h"

namespace spark::test {

/// s; the time of play is summed in single precision, so a period of some seconds may end a cycle late.
constexpr double kCycle = 0.0201;

/// A player: an agent with a robot, and its last message.
struct Player {
  LoopbackClient client;
  Side side = Side::none;
  int unum = 0;
  std::string last;              ///< the last message
  std::vector<std::string> all;  ///< all messages

  /// The atom after `name` in the last GS, such as gs("pm"), gs("t"), gs("sl"); "" if there is none.
  std::string gs(const std::string& name) const {
    Predicates p;
    readSexp(last, p);
    for (const Element e : p)
      if (e.head() == "GS" && e.named(name)) return std::string(e.named(name).at(1).text());
    return {};
  }
  bool heard(std::string_view text) const { return last.find(text) != std::string::npos; }
};

class Stadium : TestHost {
 public:
  using Settings = std::vector<std::pair<std::string, Value>>;
  static constexpr double kStep = 0.02;  ///< s

  /// `settings`: options in the format of --set. Monitors get a message in every cycle, beams have no noise.
  explicit Stadium(const Settings& settings = {}) {
    ScriptServer& lua = scripts(kernel);
    lua.addFolder(SPARK_SOURCES "/lua");
    lua.run("host = { share = '" SPARK_SOURCES "', scenePaths = { '" SPARK_SOURCES "/tests/scenarios/scenes' } }",
            "stadium");
    std::map<std::string, Value> all{{"/sys/server/simulation.rate", "max"},
                                     {"/sys/server/net/agents.port", 0},
                                     {"/sys/server/net/monitors.port", 0},
                                     {"/sys/server/monitor.interval", 1},
                                     {"/sys/server/gamecontrol.idleLimit", 0},  // of wall time
                                     {"Soccer.BeamNoiseXY", 0},
                                     {"Soccer.BeamNoiseAngle", 0}};
    for (const auto& [key, value] : settings) all[key] = value;
    for (const auto& [key, value] : all) lua.addOverride(key, value);
    lua.runConfig("soccer.lua");
    callMethod(node("/sys/server/net"), "listen", {});
    net_ = &kernel.root().require<IInputSource>("/sys/server/net");
    trainer_.emplace(portOf("monitors"));
    admit(*trainer_);
    run(1);
  }

  // Players.
  /// An agent without a robot.
  Player& connect() {
    Player& p = players_.emplace_back(Player{LoopbackClient(portOf("agents")), Side::none, 0, {}, {}});
    admit(p.client);
    run(1);
    return p;
  }
  /// Adds a player of team A or B, beside the field until it is moved. `height`: of the robot [m].
  Player& join(const std::string& team, int unum, double height = 0.6, int type = -1) {
    return join(team, unum,
                "rsg/agent/scenario.rsg " + std::to_string(height) + " " + std::to_string(type < 0 ? unum % 3 : type));
  }
  /// Adds a player with another robot: `robot` is its scene file and arguments.
  Player& join(const std::string& team, int unum, const std::string& robot) {
    Player& p = connect();
    p.client.send("(scene " + robot + ")");
    run(3);
    p.client.send("(init (unum " + std::to_string(unum) + ")(teamname " + team + "))");
    run(3);
    for (const std::string& m : p.all)
      if (m.find("(team ") != std::string::npos)
        p.side = m.find("(team left)") != std::string::npos ? Side::left : Side::right;
    if (p.side != Side::none) p.unum = unum;
    return p;
  }
  /// Sends a player's actions, which act in the next cycle.
  void act(Player& p, const std::string& actions) { p.client.send(actions); }

  // The trainer, and what the monitor shows.
  /// Sends commands; they act in the next cycle.
  void command(const std::string& commands) { trainer_->send(commands); }
  /// Sends commands and runs the cycle in which they act.
  void trainer(const std::string& commands) {
    command(commands);
    run(1);
  }
  /// A command that moves a player and keeps it upright; `z`: of the torso [m].
  static std::string put(const Player& p, double x, double y, double z = 0.3) {
    return "(agent (unum " + std::to_string(p.unum) + ")(team " + (p.side == Side::left ? "Left" : "Right") + ")(pos " +
           std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "))";
  }
  static std::string ballTo(double x, double y, double z = 0.042, double vx = 0, double vy = 0, double vz = 0) {
    return "(ball (pos " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + ") (vel " +
           std::to_string(vx) + " " + std::to_string(vy) + " " + std::to_string(vz) + "))";
  }
  /// A command that moves a player against the ball, so that it touches the ball in the next cycle: on the ball's -x
  /// side for `side` -1, on its +x side for 1.
  std::string against(const Player& p, double side = -1) const {
    const Vec3 b = ball();
    return put(p, b.x() + side * (0.15 + 0.042 - 0.01), b.y());
  }

  const MonitorView& monitor() const { return view_; }
  std::string mode() const { return view_.mode(); }
  double time() const { return view_.number("time"); }
  std::pair<int, int> score() const { return {int(view_.number("score_left")), int(view_.number("score_right"))}; }
  Vec3 ball() const { return view_.ball(); }
  Vec3 at(const Player& p) const {
    const auto place = view_.player(p.side, p.unum);
    if (!place)
      throw Error("the monitor does not see number " + std::to_string(p.unum) + " of " +
                  (p.side == Side::left ? "left" : "right"));
    return *place;
  }
  /// Distance on the ground [m].
  static double distance(const Vec3& a, const Vec3& b) { return std::hypot(a.x() - b.x(), a.y() - b.y()); }

  // Time.
  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      const Value one(1);
      callMethod(node("/sys/server/simulation"), "runCycles", std::span(&one, 1));
      net_->poll();
      read();
    }
  }
  void seconds(double s) { run(static_cast<int>(std::lround(s / kStep))); }
  /// Runs until the monitor shows the mode, for at most `limit` seconds; returns the time that it took [s], or -1.
  double until(const std::string& wanted, double limit) {
    const int cycles = static_cast<int>(std::lround(limit / kStep));
    for (int n = 0; n <= cycles; ++n, run(1))
      if (mode() == wanted) return n * kStep;
    return -1;
  }
  /// True if the simulation was asked to end.
  bool over() { return kernel.stopRequested(); }

  // Access to the simulation, for state that no message shows.
  Leaf& node(std::string_view path) { return kernel.root().require<Leaf>(path); }
  Value get(std::string_view path, std::string_view property) { return getProperty(node(path), property); }
  const std::string& log() const { return text; }

 private:
  int portOf(const std::string& name) { return static_cast<int>(get("/sys/server/net/" + name, "port").toInteger()); }
  void admit(LoopbackClient& client) {
    while (!client.accepted()) net_->poll();
  }
  void read() {
    for (const std::string& m : trainer_->take()) view_.read(m);
    for (Player& p : players_)
      for (std::string& m : p.client.take()) {
        p.last = m;
        p.all.push_back(std::move(m));
      }
  }

  IInputSource* net_ = nullptr;
  std::optional<LoopbackClient> trainer_;
  std::deque<Player> players_;
  MonitorView view_;
};

}  // namespace spark::test
