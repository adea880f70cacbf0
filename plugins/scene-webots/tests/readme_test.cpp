// The tables of README.md, against what the importer does.

#include <fstream>
#include <regex>
#include <sstream>

#include "../base_nodes.h"
#include "../known_protos.h"
#include "read_world.h"

using namespace spark;
using namespace spark::webots::test;
using namespace spark::webots;
using Catch::Contains;

namespace {

/// The first cells of the table whose head begins with `head`.
std::vector<std::string> firstCells(const std::string& head) {
  std::ifstream in(SPARK_SOURCES "/plugins/scene-webots/README.md");
  std::vector<std::string> out;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("| " + head))
      inside = true;
    else if (inside && !line.starts_with("|"))
      break;
    else if (inside && !line.starts_with("|-"))
      out.push_back(line.substr(1, line.find('|', 1) - 1));
  }
  REQUIRE(out.size() > 3);
  return out;
}

/// What is between ` and `.
std::vector<std::string> codeIn(const std::string& text) {
  std::vector<std::string> out;
  static const std::regex kCode("`([^`]*)`");
  for (std::sregex_iterator i(text.begin(), text.end(), kCode), end; i != end; ++i) out.push_back((*i)[1]);
  return out;
}

}  // namespace

TEST_CASE("The README's nodes are nodes of Webots or PROTOs that need no file") {
  int nodes = 0;
  for (const std::string& cell : firstCells("Webots | here"))
    for (const std::string& name : codeIn(cell)) {
      if (name.empty() || name[0] < 'A' || name[0] > 'Z' || name == "EXTERNPROTO") continue;
      INFO(name);
      ++nodes;
      const bool known =
          isBaseNode(name) || isGround(name) || isBackdrop(name) || name.ends_with("JointWithBacklash") ||
          knownProto(webots::Node{name, "", nullptr, 0, {{"size", 0, std::make_shared<webots::Value>()}}});
      CHECK(known);
    }
  CHECK(nodes > 20);
}

TEST_CASE("The README's fields without effect are named in the log") {
  const Read r(world(R"(WorldInfo { contactProperties [ ContactProperties { bounce 0 bounceVelocity 0 softERP 0.1
  softCFM 0 rollingFriction 0 0 0 forceDependentSlip 0 frictionRotation 0 0 } ] }
Robot { contactMaterial "rubber" linearVelocity 1 0 0 angularVelocity 0 0 1 hidden position_0_0 1
  immersionProperties [ ImmersionProperties { } ] physics Physics { mass 1 damping Damping { } }
  children [ HingeJoint { device [ RotationalMotor { acceleration 3 multiplier 2 }
    PositionSensor { noise 0.1 resolution 0.2 } PositionSensor { } ] endPoint Solid { } } ] })"));
  const std::string messages = r.messages();
  for (const std::string& cell : firstCells("named, and what holds instead"))
    for (const std::string& name : codeIn(cell.substr(0, cell.find(':')))) {
      INFO(name);
      CHECK_THAT(messages, Contains(name));
    }
  CHECK_THAT(messages, Contains("the first one is taken"));
}
