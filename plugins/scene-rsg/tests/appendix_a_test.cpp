// The contents of the installed base's scenes: scene-language Appendix A, and the robots' bodies and joints.

#include <catch2/catch.hpp>
#include <fstream>
#include <iostream>
#include <regex>
#include <set>

#include "reference_house.h"

using namespace spark;
using namespace spark::test;

namespace {

std::filesystem::path reference() {
  const auto folder = referenceFolder();
  if (std::filesystem::is_directory(folder / "scenes-reference")) return folder;
  std::cout << "skipped: SPARK_REFERENCE_DIR has no scenes-reference\n";
  std::exit(77);
}

/// A row of Appendix A. `joints` does not include angular motors.
struct Row {
  std::string file;
  List arguments;
  bool robot;
  int nodes, transforms, bodies;
  double mass;
  int colliders, joints, motors, perceptors, effectors, imports, evals, calls;
};

const Row kRows[] = {
    {"rsg/agent/nao/nao_hetero.rsg", {0}, true, 219, 26, 23, 4.6071, 13, 22, 0, 30, 27, 94, 212, 819},
    {"rsg/agent/nao/nao_hetero.rsg", {4}, true, 239, 28, 25, 4.6071, 15, 24, 0, 34, 29, 102, 252, 917},
    {"rsg/agent/nao/nao.rsg", {}, true, 219, 26, 23, 4.6071, 13, 22, 0, 30, 27, 95, 212, 820},
    {"rsg/agent/naov4/nao.rsg", {}, true, 309, 51, 23, 5.04013, 28, 22, 22, 36, 48, 121, 372, 1225},
    {"rsg/agent/hoap2.rsg", {}, true, 184, 30, 18, 6.50543, 18, 17, 0, 18, 16, 19, 168, 465},
    {"rsg/agent/soccerbot055.rsg", {}, true, 179, 28, 16, 4.09357, 18, 15, 0, 20, 16, 17, 156, 438},
    {"rsg/agent/soccerbot056.rsg", {}, true, 207, 31, 21, 2.4988, 21, 20, 0, 21, 17, 22, 153, 516},
    {"rsg/agent/soccerbotcomp.rsg", {}, true, 200, 34, 15, 2.4988, 30, 14, 0, 21, 17, 16, 147, 490},
    {"rsg/agent/soccerplayer.rsg", {}, true, 48, 8, 4, 6.58388, 4, 3, 0, 4, 4, 5, 0, 111},
    {"rsg/agent/buggy.rsg", {}, true, 44, 8, 5, 26.1447, 5, 4, 0, 2, 1, 6, 0, 106},
    {"rsg/agent/leggedsphere.rsg", {}, true, 60, 7, 7, 7.76092, 7, 6, 0, 6, 6, 8, 0, 163},
    {"rsg/agent/nao/soccer.rsg", {}, false, 116, 50, 1, 0.026, 16, 0, 0, 0, 0, 34, 136, 200},
    {"rsg/agent/naov4/soccer.rsg", {}, false, 120, 54, 1, 0.026, 16, 0, 0, 0, 0, 38, 149, 212},
    {"rsg/agent/soccer.rsg", {}, false, 102, 40, 1, 0.026, 14, 0, 0, 0, 0, 10, 70, 181},
    {"rsg/boxspheres/simspark.rsg", {}, false, 341, 60, 54, 443.876, 59, 0, 0, 0, 0, 68, 0, 914},
    {"rsg/jointtest/simspark.rsg", {}, false, 595, 105, 85, 736.67, 91, 50, 0, 0, 0, 114, 0, 1618},
};

void check(const Row& row, const Inventory& found, const ReferenceHost& h) {
  INFO(row.file);
  CHECK(found.nodes == row.nodes);
  CHECK(found.transforms == row.transforms);
  CHECK(found.bodies == row.bodies);
  CHECK(found.mass == Approx(row.mass).epsilon(1e-5));
  CHECK(found.colliders == row.colliders);
  CHECK(found.joints == row.joints);
  CHECK(found.angularMotors == row.motors);
  CHECK(found.perceptors == row.perceptors);
  CHECK(found.effectors == row.effectors);
  CHECK(h.count("imports") == row.imports);
  CHECK(h.count("evals") == row.evals);
  CHECK(h.count("calls") == row.calls);
  if (h.host.text.find("failed") != std::string::npos || h.host.text.find("no method") != std::string::npos)
    FAIL(h.host.text);
}

using Match = std::smatch;
double number(const std::string& text) { return std::stod(text); }
Vec3 vector(const Match& m, std::size_t first) {
  return {number(m[first]), number(m[first + 1]), number(m[first + 2])};
}
/// True if the value agrees with the reference, which has five significant digits.
bool fits(const Vec3& found, const Vec3& fact) {
  for (int i = 0; i < 3; ++i) {
    const double unit = fact[i] == 0 ? 1e-5 : std::pow(10.0, std::floor(std::log10(std::abs(fact[i]))) - 4);
    if (std::abs(found[i] - fact[i]) > 0.5 * unit + 1e-6) return false;
  }
  return true;
}
std::string triple() { return R"(\['([^']*)', '([^']*)', '([^']*)'\])"; }

/// The reference description of a robot, line by line.
struct Facts {
  std::vector<std::string> lines;
  explicit Facts(const std::filesystem::path& file) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line) && lines.size() < 60;) lines.push_back(line);
    REQUIRE(lines.size() == 60);
  }
  template <class F>
  int each(const std::string& pattern, F visit) const {
    const std::regex expression(pattern);
    int n = 0;
    for (const std::string& line : lines)
      if (Match m; std::regex_search(line, m, expression)) visit(m, line), ++n;
    return n;
  }
};

void checkBodies(const Facts& facts, const Node& robot) {
  const int n = facts.each(R"(^    body (\S+)/ mass (\S+) pos )" + triple(), [&](const Match& m, const std::string&) {
    INFO(m[1].str());
    const auto& body = robot.require<IRigidBody>(m[1].str());
    CHECK(body.mass() == Approx(number(m[2])).epsilon(1e-5));
    CHECK(fits(body.state().position, vector(m, 3)));
  });
  CHECK(n >= 23);
}

void checkParameters(const IJoint& joint, const std::string& line) {
  using P = engine::JointParameter;
  const std::pair<const char*, P> kNames[] = {{"setMaxMotorForce", P::maxForce},  {"setCFM", P::cfm},
                                              {"setStopCFM", P::stopCfm},         {"setStopERP", P::stopErp},
                                              {"setFudgeFactor", P::fudgeFactor}, {"setBounce", P::bounce},
                                              {"setLowStopDeg", P::lowStop},      {"setHighStopDeg", P::highStop}};
  for (const auto& [name, parameter] : kNames) {
    INFO(name);
    Match m;
    REQUIRE(std::regex_search(line, m, std::regex("'" + std::string(name) + R"(': \['0 ([^']*)'\])")));
    const double wanted = number(m[1]) * (std::string_view(name).ends_with("Deg") ? kPi / 180 : 1);
    CHECK(joint.parameter(parameter, 0) == Approx(wanted).margin(1e-12));
  }
  Match m;
  REQUIRE(std::regex_search(line, m, std::regex(R"('setJointMaxSpeed1': \['([^']*)'\])")));
  CHECK(joint.maxSpeed(0) == Approx(number(m[1])));
}

void checkJoints(const Facts& facts, const Node& robot) {
  std::vector<IJoint*> joints;
  robot.collect(joints);
  std::size_t next = 0;
  const int n = facts.each(R"(^    HingeJoint \['(\S+)/', '(\S+)/'\] anchor )" + triple() + R"( axis \[)" + triple() +
                               R"(\].*'HingePerceptor', '([^']+)'.*'HingeEffector', '([^']+)')",
                           [&](const Match& m, const std::string& line) {
                             REQUIRE(next < joints.size());
                             IJoint& joint = *joints[next++];
                             INFO(m[9].str());
                             CHECK(&joint.body(0)->leaf() == robot.find(m[1].str()));
                             CHECK(&joint.body(1)->leaf() == robot.find(m[2].str()));
                             CHECK(joint.leaf().find(m[9].str())->as<Perceptor>());
                             CHECK(joint.leaf().find(m[10].str())->as<Effector>());
                             checkParameters(joint, line);
                             Args anchor{}, axis{};
                             const Value at = callMethod(joint.leaf(), "getAnchor", {}),
                                         along = callMethod(joint.leaf(), "getAxis", {});
                             anchor.values = {&at, 1};
                             axis.values = {&along, 1};
                             CHECK(fits(Convert<Vec3>::from(anchor), vector(m, 3)));
                             CHECK((Convert<Vec3>::from(axis) - vector(m, 6).normalized()).norm() < 1e-4);
                           });
  CHECK(n >= 22);
  CHECK(next == joints.size());
}

/// The reference includes the scene, its world and space, the agent and its create effector.
void checkClasses(const Facts& facts, Inventory found) {
  for (const char* one : {"Scene", "World", "Space", "AgentAspect", "SceneEffector"}) ++found.classes[one];
  CHECK(facts.each("^  classes ", [&](const Match&, const std::string& line) {
    const std::regex entry("'([A-Za-z0-9]+)': ([0-9]+)");
    std::map<std::string, int> wanted;
    for (std::sregex_iterator m(line.begin(), line.end(), entry), end; m != end; ++m)
      wanted[(*m)[1]] = std::stoi((*m)[2]);
    CHECK(found.classes == wanted);
  }) == 1);
}

/// Compares class and name of perceptors or effectors in order. Names that the original generated are not compared.
template <class T>
void checkOrder(const Facts& facts, const char* title, const Node& robot, const char* skip) {
  std::vector<T*> all;
  robot.collect(all);
  CHECK(facts.each("^  " + std::string(title) + " ", [&](const Match&, const std::string& line) {
    const std::regex entry(R"(\('([A-Za-z0-9]+)', '([^']*)'\))");
    std::size_t i = 0;
    for (std::sregex_iterator m(line.begin(), line.end(), entry), end; m != end; ++m) {
      if ((*m)[1] == skip) continue;
      REQUIRE(i < all.size());
      CHECK(all[i]->classObject()->name() == (*m)[1].str());
      if ((*m)[2].str().front() != '<') CHECK(all[i]->name() == (*m)[2].str());
      ++i;
    }
    CHECK(i == all.size());
  }) == 1);
}

}  // namespace

TEST_CASE("each available scene file has the same contents as in the installed base") {
  const auto folder = reference();
  std::set<std::string> present;
  for (const Row& row : kRows) {
    if (!std::filesystem::exists(folder / "scenes-reference" / row.file)) continue;
    present.insert(row.file);
    ReferenceHost h(folder);
    Node& root = row.robot ? h.agent("AgentAspect1") : *h.scene;
    h.import(row.file, root, row.arguments);
    Inventory found;
    found.add(root);
    check(row, found, h);
  }
  CHECK(present.size() >= 4);
}

TEST_CASE("the five robots have the bodies, joints, perceptors and effectors of the installed base at the same poses") {
  const auto folder = reference();
  for (int type = 0; type < 5; ++type) {
    INFO("type " << type);
    ReferenceHost h(folder);
    Node& robot = h.agent("AgentAspect1");
    h.import("rsg/agent/nao/nao_hetero.rsg", robot, {type});
    Inventory found;
    found.add(robot);
    const Facts facts(folder / "spec" / "models" / ("nao-type" + std::to_string(type) + ".txt"));
    checkClasses(facts, found);
    checkBodies(facts, robot);
    checkJoints(facts, robot);
    checkOrder<Perceptor>(facts, "perceptors", robot, "");
    checkOrder<Effector>(facts, "effectors", robot, "SceneEffector");
  }
}

TEST_CASE("loading a second robot parses no files again") {
  ReferenceHost h(reference());
  h.import("rsg/agent/nao/nao_hetero.rsg", h.agent("AgentAspect1"), {0});
  const std::int64_t parsed = h.count("filesParsed");
  CHECK(parsed > 5);
  Node& second = h.agent("AgentAspect2");
  h.import("rsg/agent/nao/nao_hetero.rsg", second, {1});
  CHECK(h.count("filesParsed") == parsed);
  Inventory found;
  found.add(second);
  CHECK(found.nodes == 219);
}
