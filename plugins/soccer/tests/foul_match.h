#pragma once
/// \file
/// A match in which fouls are judged, and the fouls that monitors receive.

#include "match_house.h"

namespace spark::test {

/// Teams A (left) and B (right) of spheres on the league's field, in PlayOn, with the ball far from all players. Agents
/// are numbered A1, A2, ..., B1, B2, ... A sphere with a `radius` below 0.25 m counts as lying, a larger one as
/// standing. Players wait in a row at y = 8, 2 m apart.
struct FoulMatch : SoccerMatch {
  FoulMatch(std::initializer_list<const char*> fouls, int left, int right, double radius = 0.4)
      : SoccerMatch(false), left_(left) {
    set("AgentRadius", radius);
    set("AgentMass", 10);
    set("MaxRobotTypeCount", 11), set("MinRobotTypesCount", 1), set("MaxSumTwoRobotTypes", 22);
    Leaf& robots = kernel.create("DirectoryFileSystem", "/sys/server/file/robots");
    setProperty(robots, "path", SPARK_TEST_ROBOTS);
    setProperty(robots, "prefix", "rsg/agent/test");
    importField();
    kernel.create("PlayerContactAspect", "/sys/server/gamecontrol/PlayerContactAspect");
    for (const char* foul : fouls) kernel.create(foul, std::string("/sys/server/gamecontrol/") + foul);
    kernel.create("PenaltyAspect", "/sys/server/gamecontrol/PenaltyAspect");
    kernel.create("SoccerRuleItem", "/sys/fouls");
    for (int n = 1; n <= left; ++n) join("A", n);
    for (int n = 1; n <= right; ++n) join("B", n);
    for (int n = 1; n <= left + right; ++n) put(n, 2.0 * n - 8, 8);
    placeBall(0, -9, 0.042);
    setMode("PlayOn");
  }
  int a(int unum) const { return unum; }
  int b(int unum) const { return left_ + unum; }
  double radius() { return get("/sys/variables/Soccer", "AgentRadius").toNumber(); }
  void put(int agent, double x, double y, double vx = 0) {
    place(bodyOf(agent), x, y, radius());
    bodyOf(agent).setVelocity(Vec3(vx, 0, 0));
  }
  Vec3 position(int agent) { return bodyOf(agent).state().position; }
  /// The fouls since the last call, as monitors receive them: "index type team unum".
  std::vector<std::string> fouls() {
    Environment env;
    kernel.root().require<IMonitorItem>("/sys/fouls").contribute(env);
    std::vector<std::string> out;
    for (const Element e : env.predicates) {
      out.push_back(
          fmt::format("{} {} {} {}", e.at(1).integer(), e.at(2).integer(), e.at(3).integer(), e.at(4).integer()));
      CHECK(e.head() == "foul");
    }
    return out;
  }
  std::size_t countFouls() { return fouls().size(); }
  bool is(int agent, double x, double y, double tolerance = 1e-9) {
    const Vec3 p = position(agent);
    INFO("agent " << agent << " is at " << p.transpose());
    CHECK(p.x() == Approx(x).margin(tolerance));
    CHECK(p.y() == Approx(y).margin(tolerance));
    return true;
  }

 private:
  int left_;
};

using Fouls = std::vector<std::string>;

}  // namespace spark::test
