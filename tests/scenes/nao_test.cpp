// Checks the five types of the Nao against tables of numbers.

#include <catch2/catch.hpp>
#include <map>
#include <sstream>

#include "api/physics.h"
#include "league.h"
#include "scene_text.h"

using namespace spark;
using namespace spark::test;

namespace {

/// A part: its body, and the joint that connects it to its parent.
struct Part {
  std::string name, body;
  double mass;
  Vec3 position;  // world
  std::string parent, perceptor, effector;
  Vec3 anchor, axis;       // world
  double min, max, speed;  // deg, deg, rad/s
};

const char* const kBodies = R"(
body        boxBody      1.2171   0      -1      1.5
neck        capsuleBody  0.05     0      -1      1.59
head        sphereBody   0.35     0      -1      1.655
rshoulder   sphereBody   0.07     0.098  -1      1.575
rupperarm   boxBody      0.15     0.108  -0.98   1.575
relbow      sphereBody   0.035    0.098  -0.91   1.584
rlowerarm   boxBody      0.2      0.098  -0.86   1.584
lshoulder   sphereBody   0.07    -0.098  -1      1.575
lupperarm   boxBody      0.15    -0.108  -0.98   1.575
lelbow      sphereBody   0.035   -0.098  -0.91   1.584
llowerarm   boxBody      0.2     -0.098  -0.86   1.584
rhip1       sphereBody   0.09     0.055  -1.01   1.385
rhip2       sphereBody   0.125    0.055  -1.01   1.385
rthigh      boxBody      0.275    0.055  -1      1.345
rshank      boxBody      0.225    0.055  -0.995  1.22
rankle      sphereBody   0.125    0.055  -1.005  1.165
rfoot       boxBody      0.2      0.055  -0.975  1.125
lhip1       sphereBody   0.09    -0.055  -1.01   1.385
lhip2       sphereBody   0.125   -0.055  -1.01   1.385
lthigh      boxBody      0.275   -0.055  -1      1.345
lshank      boxBody      0.225   -0.055  -0.995  1.22
lankle      sphereBody   0.125   -0.055  -1.005  1.165
lfoot       boxBody      0.2     -0.055  -0.975  1.125
)";

const char* const kJoints = R"(
neck       body/boxBody          hj1  he1    0      -1      1.59   0       0  1        -120  120  6.13955
head       neck/capsuleBody      hj2  he2    0      -1      1.65   1       0  0         -45   45  6.13955
rshoulder  body/boxBody          raj1 rae1   0.098  -1      1.575  1       0  0        -120  120  6.13955
rupperarm  rshoulder/sphereBody  raj2 rae2   0.098  -1      1.575  0       0  1         -95    1  6.13955
relbow     rupperarm/boxBody     raj3 rae3   0.098  -0.91   1.584  0       1  0        -120  120  6.13955
rlowerarm  relbow/sphereBody     raj4 rae4   0.098  -0.91   1.584  0       0  1          -1   90  6.13955
lshoulder  body/boxBody          laj1 lae1  -0.098  -1      1.575  1       0  0        -120  120  6.13955
lupperarm  lshoulder/sphereBody  laj2 lae2  -0.098  -1      1.575  0       0  1          -1   95  6.13955
lelbow     lupperarm/boxBody     laj3 lae3  -0.098  -0.91   1.584  0       1  0        -120  120  6.13955
llowerarm  lelbow/sphereBody     laj4 lae4  -0.098  -0.91   1.584  0       0  1         -90    1  6.13955
rhip1      body/boxBody          rlj1 rle1   0.055  -1.01   1.385  -0.7071 0  0.7071    -90    1  6.13955
rhip2      rhip1/sphereBody      rlj2 rle2   0.055  -1.01   1.385  0       1  0         -45   25  6.13955
rthigh     rhip2/sphereBody      rlj3 rle3   0.055  -1.01   1.385  1       0  0         -25  100  6.13955
rshank     rthigh/boxBody        rlj4 rle4   0.055  -1.005  1.265  1       0  0        -130    1  6.13955
rankle     rshank/boxBody        rlj5 rle5   0.055  -1.005  1.165  1       0  0         -45   75  6.1395
rfoot      rankle/sphereBody     rlj6 rle6   0.055  -1.005  1.16   0       1  0         -25   45  6.1395
lhip1      body/boxBody          llj1 lle1  -0.055  -1.01   1.385  -0.7071 0 -0.7071    -90    1  6.13955
lhip2      lhip1/sphereBody      llj2 lle2  -0.055  -1.01   1.385  0       1  0         -25   45  6.13955
lthigh     lhip2/sphereBody      llj3 lle3  -0.055  -1.01   1.385  1       0  0         -25  100  6.13955
lshank     lthigh/boxBody        llj4 lle4  -0.055  -1.005  1.265  1       0  0        -130    1  6.13955
lankle     lshank/boxBody        llj5 lle5  -0.055  -1.005  1.165  1       0  0         -45   75  6.1395
lfoot      lankle/sphereBody     llj6 lle6  -0.055  -1.005  1.16   0       1  0         -45   25  6.1395
)";

std::vector<Part> type0() {
  std::vector<Part> parts;
  std::istringstream bodies(kBodies), joints(kJoints);
  for (Part p; bodies >> p.name >> p.body >> p.mass >> p.position;) parts.push_back(p);
  REQUIRE(parts.size() == 23);
  std::size_t i = 1;
  for (std::string name; joints >> name; ++i) {
    Part& p = parts.at(i);
    REQUIRE(p.name == name);
    joints >> p.parent >> p.perceptor >> p.effector >> p.anchor >> p.axis >> p.min >> p.max >> p.speed;
  }
  REQUIRE(i == 23);
  return parts;
}

Part& part(std::vector<Part>& parts, const std::string& name) {
  for (Part& p : parts)
    if (p.name == name) return p;
  throw std::out_of_range(name);
}

/// Longer limbs: moves elbows forwards, knees and feet down.
void stretch(std::vector<Part>& parts, double elbowY, double hipX, double thighZ, double ankleZ, double footZ) {
  for (const char* side : {"r", "l"}) {
    const std::string s = side;
    const double x = s == "r" ? hipX : -hipX;
    part(parts, s + "elbow").position.y() = part(parts, s + "elbow").anchor.y() =
        part(parts, s + "lowerarm").anchor.y() = elbowY;
    part(parts, s + "lowerarm").position.y() = elbowY + 0.05;
    for (const char* name : {"hip1", "hip2", "thigh", "shank", "ankle", "foot"})
      part(parts, s + name).position.x() = part(parts, s + name).anchor.x() = x;
    part(parts, s + "thigh").position.z() = thighZ;
    part(parts, s + "shank").position.z() = thighZ - 0.125;
    part(parts, s + "shank").anchor.z() = thighZ - 0.08;
    part(parts, s + "ankle").position.z() = part(parts, s + "ankle").anchor.z() = ankleZ;
    part(parts, s + "foot").position.z() = footZ;
    part(parts, s + "foot").anchor.z() = footZ + 0.035;
  }
}

/// Divides each foot into a foot and a toe.
void addToes(std::vector<Part>& parts) {
  std::vector<Part> out;
  for (Part& p : parts) {
    const bool foot = p.name.ends_with("foot");
    if (foot) p.mass = 0.177801, p.position.y() = -0.992759, p.anchor.y() = -1.022759;
    out.push_back(p);
    if (!foot) continue;
    const std::string s = p.name.substr(0, 1);
    const double x = p.position.x();
    out.push_back({s + "toe",
                   "boxBody",
                   0.0221986,
                   {x, -0.912759, 1.12},
                   s + "foot/boxBody",
                   s + "lj7",
                   s + "le7",
                   {x, -0.9305179, 1.115},
                   {1, 0, 0},
                   -1,
                   70,
                   6.13955});
  }
  parts = out;
}

std::vector<Part> partsOf(int type) {
  std::vector<Part> parts = type0();
  if (type == 1) stretch(parts, -0.87336, 0.055, 1.32668, 1.12836, 1.08836);
  if (type == 2)
    for (Part& p : parts) {
      if (p.name.ends_with("ankle")) p.speed = 8.80667;
      if (p.name.ends_with("foot")) p.speed = 3.47234;
    }
  if (type == 3) stretch(parts, -0.854263, 0.0729541, 1.31713, 1.10926, 1.06926);
  if (type == 4) addToes(parts);
  return parts;
}

void checkJoint(const Part& p, IJoint& joint, Node& robot) {
  INFO(p.perceptor);
  using P = engine::JointParameter;
  CHECK(&joint.body(0)->leaf() == robot.find("spacenao/" + p.name + "/" + p.body));
  CHECK(&joint.body(1)->leaf() == robot.find("spacenao/" + p.parent));
  CHECK((vectorOf(joint.leaf(), "getAnchor") - p.anchor).norm() < 2e-6);
  CHECK((vectorOf(joint.leaf(), "getAxis") - p.axis.normalized()).norm() < 1e-6);
  CHECK(joint.parameter(P::lowStop, 0) == Approx(degToRad(p.min)));
  CHECK(joint.parameter(P::highStop, 0) == Approx(degToRad(p.max)));
  CHECK(joint.maxSpeed(0) == Approx(p.speed));
  const std::pair<P, double> kCommon[] = {{P::maxForce, 10},      {P::cfm, 1e-8}, {P::stopCfm, 1e-8}, {P::stopErp, 0.8},
                                          {P::fudgeFactor, 1e-5}, {P::bounce, 1}, {P::velocity, 0}};
  for (const auto& [parameter, value] : kCommon) CHECK(joint.parameter(parameter, 0) == Approx(value));
  CHECK(joint.leaf().find(p.perceptor)->classObject()->name() == "HingePerceptor");
  CHECK(joint.leaf().find(p.effector)->classObject()->name() == "HingeEffector");
}

template <class T>
std::string namesOf(const Node& root) {
  std::vector<T*> all;
  root.collect(all);
  std::string out;
  for (T* t : all)
    out += (out.empty() ? "" : " ") +
           (t->name() == t->classObject()->name() ? t->name() : t->classObject()->name() + ":" + t->name());
  return out;
}

std::string meshesOf(const Node& root) {
  std::vector<IVisual*> all;
  root.collect(all);
  std::string out;
  for (IVisual* v : all)
    if (v->kind() == IVisual::Kind::mesh)
      out += fmt::format("{} {:g} {}\n", v->load(), v->scale().x(), fmt::join(v->materials(), ","));
  return out;
}

}  // namespace

TEST_CASE("The Nao's bodies and joints are those of its type in their order") {
  for (int type = 0; type < 5; ++type) {
    INFO("type " << type);
    League league;
    Node& robot = league.agent();
    league.import("rsg/agent/nao/nao_hetero.rsg", robot, {type});
    std::vector<IRigidBody*> bodies;
    std::vector<IJoint*> joints;
    robot.collect(bodies);
    robot.collect(joints);
    const std::vector<Part> parts = partsOf(type);
    REQUIRE(bodies.size() == parts.size());
    REQUIRE(joints.size() == parts.size() - 1);
    double mass = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Part& p = parts[i];
      INFO(p.name);
      CHECK(&bodies[i]->leaf() == robot.find("spacenao/" + p.name + "/" + p.body));
      CHECK(bodies[i]->mass() == Approx(p.mass));
      CHECK((bodies[i]->state().position - p.position).norm() < 2e-7);
      CHECK(bodies[i]->state().rotation == Mat3::Identity());
      mass += bodies[i]->mass();
      if (i > 0) checkJoint(p, *joints[i - 1], robot);
    }
    CHECK(mass == Approx(4.6071).epsilon(1e-6));
  }
}

TEST_CASE("The Nao has its perceptors and effectors in the order that agents expect") {
  for (int type : {0, 4}) {
    INFO("type " << type);
    League league;
    Node& robot = league.agent();
    league.import("rsg/agent/nao/nao_hetero.rsg", robot, {type});
    const bool toes = type == 4;
    std::string senses =
                    "TimePerceptor GameStatePerceptor HearPerceptor GyroRatePerceptor:torso Accelerometer:torso "
                    "HingePerceptor:hj1 "
                    "HingePerceptor:hj2 "
                    "RestrictedVisionPerceptor",
                acts =
                    "StaticMeshInitEffector BeamEffector SayEffector AgentSyncEffector PassEffector HingeEffector:he1 "
                    "HingeEffector:he2";
    for (const std::string side : {"r", "l"})
      for (int i = 1; i <= 4; ++i) {
        senses += fmt::format(" HingePerceptor:{}aj{}", side, i);
        acts += fmt::format(" HingeEffector:{}ae{}", side, i);
      }
    for (const std::string side : {"r", "l"}) {
      for (int i = 1; i <= (toes ? 7 : 6); ++i) {
        if (i == 6) senses += " ForceResistancePerceptor:" + side + "f";
        if (i == 7) senses += " ForceResistancePerceptor:" + side + "f1";
        senses += fmt::format(" HingePerceptor:{}lj{}", side, i);
        acts += fmt::format(" HingeEffector:{}le{}", side, i);
      }
    }
    CHECK(namesOf<Perceptor>(robot) == senses);
    CHECK(namesOf<Effector>(robot) == acts);
  }
}

TEST_CASE("The Nao has the meshes and materials that monitors expect") {
  League league;
  Node& robot = league.agent();
  league.import("rsg/agent/nao/nao_hetero.rsg", robot, {2});
  CHECK(meshesOf(robot) ==
        "models/naobody2.obj 0.1 matNum,matTeam,matType2,naowhite\n"
        "models/naohead.obj 0.1 matTeam,naoblack,naogrey,naowhite\n"
        "models/rupperarm2.obj 0.07 matTeam,matType2,naowhite\n"
        "models/rlowerarm.obj 0.05 matTeam,naowhite\n"
        "models/lupperarm2.obj 0.07 matTeam,matType2,naowhite\n"
        "models/llowerarm.obj 0.05 matTeam,naowhite\n"
        "models/rthigh.obj 0.07 matNum,matTeam,naowhite\n"
        "models/rshank2.obj 0.08 matTeam,matType2,naowhite\n"
        "models/rfoot.obj 0.08 matTeam,naowhite\n"
        "models/lthigh.obj 0.07 matTeam,naowhite\n"
        "models/lshank2.obj 0.08 matTeam,matType2,naowhite\n"
        "models/lfoot.obj 0.08 matTeam,naowhite\n");
}

TEST_CASE("The Nao's colliders ignore adjacent parts, and a self-collision freezes the joints of the limb") {
  League league;
  Node& robot = league.agent();
  league.import("rsg/agent/nao/nao_hetero.rsg", robot, {4});
  std::vector<ICollider*> colliders;
  robot.collect(colliders);
  std::string found;
  for (ICollider* c : colliders) {
    if (c->leaf().classObject()->name() != "BoxCollider") continue;
    found += c->leaf().parent()->name() + " " + c->leaf().name() + " " +
             getProperty(c->leaf(), "notCollideWith").text() + " " +
             getProperty(c->leaf(), "freezeJointEffectors").text() + "\n";
  }
  const std::string leg = R"({"rle1", "rle2", "rle3", "rle4", "rle5", "rle6", "rle7"})",
                    arm = R"({"rae1", "rae2", "rae3", "rae4"})";
  CHECK(found.starts_with("body TorsoCollider {} {}\nrupperarm BoxCollider {} " + arm + "\nrlowerarm BoxCollider {} " +
                          arm + "\n"));
  for (const char* line : {"rthigh rThighCollider {\"TorsoCollider\"} ", "rshank rShankCollider {\"rThighCollider\"} ",
                           "rfoot rFootCollider {\"rShankCollider\"} ", "rtoe rToeCollider {\"rFootCollider\"} "})
    CHECK_THAT(found, Catch::Contains(line + leg + "\n"));
}

TEST_CASE("An invalid type is an error and creates no nodes") {
  League league;
  for (const List& arguments : {List{5}, List{-1}, List{"1.5"}, List{"Nao"}, List{}}) {
    INFO(Value(arguments).text());
    Node& robot = league.agent("AgentAspect" + std::to_string(league.scene().children().size()));
    CHECK_THROWS_AS(league.import("rsg/agent/nao/nao_hetero.rsg", robot, arguments), Error);
    CHECK(robot.children().empty());
  }
  Node& robot = league.agent("AgentAspect9");
  league.import("rsg/agent/nao/nao_hetero.rsg", robot, List{0});
  CHECK_FALSE(robot.children().empty());
}

TEST_CASE("A robot's appearance and its counted type always agree") {
  League league;
  Node& robot = league.agent();
  league.import("rsg/agent/nao/nao_hetero.rsg", robot, {"0+3"});
  CHECK(getProperty(robot.require<Leaf>("spacenao/body/AgentState"), "robotType") == Value(3));
  CHECK(robot.require<IRigidBody>("spacenao/rhip1/sphereBody").state().position.x() == Approx(0.0729541));
  CHECK_THAT(meshesOf(robot), Catch::Contains("models/naobody3.obj"));
}
