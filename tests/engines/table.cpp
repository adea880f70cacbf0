#include <chrono>
#include <fstream>

#include "bar_chart.h"
#include "engine_world.h"
#include "machine.h"

// Writes docs/engines.md and its chart: what each engine can do, how accurate it is, and what it costs.
//
//     build/release/tests/test-engines "[.table]"

using namespace spark;
using namespace spark::test;

namespace {

/// Which engine to take, for the beginning of the page.
constexpr const char* kWhich = R"(
## Which to take

`OdeEngine` is the default. A config that calls `physics(engineOption())`, as those of soccer do, takes another by
`--set engine=NAME`; your own writes `physics("NAME")`. Scenes, joints, sensors and rules stay as they are.

| you | take | because |
|---|---|---|
| repeat recorded sessions of the installed base, or want its soccer to the digit | `OdeEngine` with `exactReplay` | it is that base's own engine |
| train or simulate many robots on two cores | `ArticulatedEngine` | the same model of joints and contacts as ODE in a fraction of the time; joints that close loops are left to ODE |
| have a robot in MJCF, or compare with results of MuJoCo | `MujocoEngine` | its trajectories are those of MuJoCo 2.2.2; surfaces, actuators and tendons of MJCF act in full |
| want joints that do not come apart under load, of robots in URDF | `BulletEngine` | it solves a tree of joints as one (Featherstone) |
| write an engine | PointMassEngine or LateEngine as examples | the [tutorial](engine-tutorial.md) |

A run repeats bit for bit with each of them on one machine and with one version of its library; two engines never agree
to the last digit.

)";

/// Energy that a pendulum of 1 m and 1 kg has gained after 10 s, as a fraction of its potential energy at the start.
double pendulum(EngineWorld& w) {
  const BodyHandle b = w.body({1, 0, 2}, 1, Mat3::Identity() * 1e-4);
  w.joint(JointType::hinge, b, BodyHandle::none, {0, 0, 2}, Vec3::UnitY());
  const auto energy = [&] {
    return 0.5 * w.velocity(b).squaredNorm() + 0.5e-4 * w.spin(b).squaredNorm() + 9.81 * w.position(b).z();
  };
  const double before = energy();
  w.run(10);
  return (energy() - before) / 9.81;
}

/// Distance between the two anchors of a hinge that carries 100 kg [m].
double gap(EngineWorld& w) {
  const BodyHandle b = w.body({0.5, 0, 2}, 100, Mat3::Identity() * 10);
  const JointHandle j = w.joint(JointType::hinge, b, BodyHandle::none, {0, 0, 2}, Vec3::UnitZ());
  w.run(2);
  const engine::Joint& joint = w.world.model().joints[w.world.index(j)];
  const engine::DynamicState& a = w.world.state().bodies[joint.a];
  return (a.position + a.rotation * joint.inA.anchor - joint.inB.anchor).norm();
}

/// Overshoot of a motor of 5 rad/s and 20 Nm beyond its stop, with 1 kg m^2 on it [rad].
double overshoot(EngineWorld& w) {
  w.setGravity(0);
  const BodyHandle b = w.body({0, 0, 2}, 1, Mat3::Identity());
  const JointHandle j = w.joint(JointType::hinge, b, BodyHandle::none, {0, 0, 2});
  w.motor(j, 0, 5, 20);
  w.stops(j, 0, -0.5, 0.5);
  double farthest = 0;
  for (int i = 0; i < 200; ++i) {
    w.run(w.dt);
    farthest = std::max(farthest, w.world.at(j).angle(0) - 0.5);
  }
  return farthest;
}

/// Penetration of the lowest of ten stacked boxes of 1 kg into the ground [m].
double penetration(EngineWorld& w) {
  w.ground();
  std::vector<BodyHandle> stack;
  for (int i = 0; i < 10; ++i) stack.push_back(w.block({0, 0, 0.2 + 0.4 * i}, {0.4, 0.4, 0.4}));
  w.run(3);
  return 0.2 - w.position(stack[0]).z();
}

/// Time of a step of 100 boxes that lie on the ground [us].
double boxesCost(EngineWorld& w) {
  w.ground();
  for (int i = 0; i < 100; ++i) w.block({(i % 10) * 1.0, (i / 10) * 1.0, 0.2}, {0.4, 0.4, 0.4});
  w.run(0.2);
  const auto begin = std::chrono::steady_clock::now();
  w.run(1);
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count() * w.dt;
}

/// Time of a step of eight trees of 23 bodies with moving motors [us].
double treesCost(EngineWorld& w) {
  w.setGravity(0);
  std::vector<JointHandle> joints;
  for (int tree = 0; tree < 8; ++tree) {
    std::vector<BodyHandle> bodies;
    for (int i = 0; i < 23; ++i) {
      bodies.push_back(w.body({3.0 * tree, 0.2 * (i % 4), 0.2 * (i / 4)}, 0.5, Mat3::Identity() * 0.002));
      if (i == 0) continue;
      const BodyHandle above = bodies[static_cast<std::size_t>((i - 1) / 2)];
      joints.push_back(w.joint(JointType::hinge, bodies.back(), above,
                               (w.position(bodies.back()) + w.position(above)) / 2, Vec3::Unit(i % 3)));
      w.motor(joints.back(), 0, 0.3, 5);
    }
  }
  w.run(0.2);
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 100; ++i) {
    for (std::size_t k = 0; k < joints.size(); ++k)
      w.world.drive(joints[k], 0, 0.5 * std::sin(0.1 * i + 0.3 * double(k)));
    w.run(w.dt);
  }
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count() / 100;
}

}  // namespace

TEST_CASE("the table of engines", "[.table]") {
  std::string head = "| |", line = "|---|";
  std::vector<const EngineKind*> kinds;
  for (const EngineKind& k : kEngines)
    if (k.built()) kinds.push_back(&k), head += fmt::format(" {} |", k.name), line += "---|";
  const auto row = [&](const char* name, auto&& cell) {
    std::string out = fmt::format("| {} |", name);
    for (const EngineKind* k : kinds) out += fmt::format(" {} |", cell(*k));
    return out + "\n";
  };
  const auto capabilitiesOf = [](const EngineKind& k) { return EngineWorld(k).can; };
  std::string abilities;
  for (const engine::NamedCapability& c : engine::kNamedCapabilities)
    abilities += row(c.name, [&](const EngineKind& k) { return capabilitiesOf(k).*c.has ? "yes" : "no"; });
  const auto number = [&](const char* name, const char* format, auto&& measure,
                          bool engine::Capabilities::*needs = nullptr) {
    return row(name, [&](const EngineKind& k) {
      if (needs && !(capabilitiesOf(k).*needs)) return std::string("-");
      EngineWorld w(k);
      return fmt::format(fmt::runtime(format), measure(w));
    });
  };
  // What a step costs is measured once, for the chart and for the table.
  std::vector<BarGroup> groups;
  const auto cost = [&](const char* name, auto&& measure, bool engine::Capabilities::*needs = nullptr) {
    BarGroup group{name, {}};
    std::string out = fmt::format("| {} [us] |", name);
    for (const EngineKind* k : kinds) {
      if (needs && !(capabilitiesOf(*k).*needs)) {
        out += " - |";
        continue;
      }
      EngineWorld w(*k);
      const double micros = measure(w);
      out += fmt::format(" {:.0f} |", micros);
      group.bars.push_back(
          {k->name, micros, fmt::format("{:.0f} us", micros), std::string_view(k->name) == "OdeEngine"});
    }
    groups.push_back(std::move(group));
    return out + "\n";
  };
  std::string costs = cost("step of 8 robots of 23 bodies, in the air", treesCost, &engine::Capabilities::joints);
  costs += cost("step of 100 boxes on the ground", boxesCost);
  const std::string where = fmt::format("{}; {}", machine(), commitAndDate(SPARK_SOURCES));

  std::ofstream chart(SPARK_SOURCES "/docs/pictures/engines.svg");
  chart << barChart("CPU time of a step of 10 ms", groups, where + ".");
  std::ofstream out(SPARK_SOURCES "/docs/engines.md");
  out << "# Engines\n\n![CPU time of a step, by engine](pictures/engines.svg)\n\n"
      << kWhich
      << "## Measured\n\n"
         "What each engine can do, how accurate it is and what it costs, in steps of 10 ms. "
         "`build/release/tests/test-engines\n\"[.table]\"` measures, and writes this page and its chart; "
         "`tests/engines` tests every \"yes\" and \"no\".\nPointMassEngine and LateEngine are examples "
         "(`tests/fixtures`).\n\nMeasured on "
      << where << ".\n\n"
      << head << "\n"
      << line << "\n"
      << abilities
      << number("energy of a pendulum after 10 s beyond that at the start, as a share of it (below 0: lost)", "{:+.3f}",
                pendulum, &engine::Capabilities::joints)
      << number(
             "gap in a hinge with 100 kg [mm]", "{:.3f}", [](EngineWorld& w) { return 1e3 * gap(w); },
             &engine::Capabilities::joints)
      << number(
             "overshoot of a motor beyond its stop [mrad]", "{:.2f}", [](EngineWorld& w) { return 1e3 * overshoot(w); },
             &engine::Capabilities::joints)
      << number("penetration of the lowest of ten boxes into the ground [mm]", "{:.2f}",
                [](EngineWorld& w) { return 1e3 * penetration(w); })
      << costs << R"(
## Turns

The angle of a hinge, of both axes of a universal joint and of hinge2, and of the outer axes of an Euler motor is
continuous: a hinge that has turned once is at 360 degrees. Stops, controllers, springs, `getAngle`, percepts and what
is saved use the same number with every engine, and it survives when the engine is replaced or the world changes. The
plugin `physics` counts turns after each step of the engine: an angle that jumps by more than half a turn has passed
180 degrees. So a stop holds at any angle and at any speed at which one step does not pass the stop whole; with half a
turn a step or more the count is wrong. A pose that is set changes an angle by at most half a turn.

With `exactReplay` the perceptors of joints of the installed base (HingePerceptor, UniversalJointPerceptor,
Hinge2Perceptor, AngularMotorPerceptor) print the angle within one turn, as rcssserver3d does; all else stays continuous.

## Who collides

| two colliders | collide |
|---|---|
| of one body | no |
| of two bodies that a joint connects | no |
| of two bodies that joints connect through connectors: a body of MJCF with several joints, and its parent | no |
| of a body and the static world, also where a joint connects the body to it | yes |
| of two bodies that a chain of joints connects, with other bodies between them | yes |
| of two bodies with `World.joinedCollide` (MJCF: `filterparent="disable"`) | yes |

Spaces, collision groups and `contactTypes` are asked besides.
)";
}
