// The field: what monitors receive of it, in which order, and that leagues can change its size.

#include <catch2/catch.hpp>

#include "api/physics.h"
#include "league.h"

using namespace spark;
using namespace spark::test;

namespace {

/// The monitor's view of a subtree: transforms as [...], visual nodes by the name of their mesh.
std::string printed(const Node& root) {
  std::string out;
  for (const auto& child : root.children()) {
    auto visual = child->as<IVisual>();
    if (visual)
      out += (out.empty() || out.back() == ']' ? "" : " ") + (visual->load().empty() ? "light" : visual->load());
    if (!child->asNode()) continue;
    const std::string inner = printed(*child->asNode());
    out += child->as<Transform>() ? "[" + inner + "]" : inner;
  }
  return out;
}

std::string times(int n, const std::string& text) {
  std::string out;
  for (int i = 0; i < n; ++i) out += text;
  return out;
}

Vec3 pointAt(League& league, const std::string& path) {
  return toPose(league.scene().require<Transform>(path).world()).position;
}

}  // namespace

TEST_CASE("Monitors get the parts of the field in the expected order") {
  League league;
  league.import("rsg/soccer/field.rsg", league.scene());
  const auto goal = [](const std::string& side) {
    return "[[models/" + side + "soccergoal.obj]" + times(6, "[]") + "]";
  };
  CHECK(printed(league.scene()) == "[light][light][models/naosoccerfield.obj][models/skybox.obj]" + goal("left") +
                                       goal("right") + times(4, "[StdUnitBox]") + times(4, "[]") + times(21, "[]") +
                                       "[models/soccerball.obj]");
}

TEST_CASE("Positions of goals, flags and walls follow the league's sizes") {
  League league({}, "FieldLength = 9, FieldWidth = 6, GoalWidth = 1.5, GoalDepth = 0.4");
  league.import("rsg/soccer/field.rsg", league.scene());
  CHECK((pointAt(league, "F1L") - Vec3(-4.5, 3, 0)).norm() < 1e-6);
  CHECK((pointAt(league, "leftgoal/GoalBox/G1L") - Vec3(-4.5, 0.75, 0.8)).norm() < 1e-6);
  CHECK((pointAt(league, "rightgoal/GoalBox/G1R") - Vec3(4.5, 0.75, 0.8)).norm() < 1e-6);
  Vec3 low, high;
  league.scene().require<ICollider>("rightgoal/GoalBox/BoxCollider").bounds(low, high);
  CHECK((low - Vec3(4.542, -0.708, 0)).norm() < 1e-5);
  CHECK((high - Vec3(4.858, 0.708, 0.8)).norm() < 1e-5);
}

TEST_CASE("The field of 2004 has goals of plates and walls near the field") {
  League league;
  league.import("rsg/soccer/field_2004.rsg", league.scene());
  CHECK_THAT(printed(league.scene()), Catch::Contains("[" + times(4, "[StdUnitBox]") + "[][]]"));
  std::vector<ICollider*> colliders;
  league.scene().collect(colliders);
  double farthest = 0;
  for (ICollider* c : colliders) {
    Vec3 low, high;
    c->bounds(low, high);
    if (std::isfinite(high.x())) farthest = std::max(farthest, high.x());
  }
  CHECK(farthest == Approx(25.5));
}
