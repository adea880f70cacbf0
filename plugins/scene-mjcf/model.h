#pragma once
/// \file
/// An MJCF model as plain data. SI units, radians; frames as in MuJoCo. "when absent" values are MuJoCo's.

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "api/model.h"
#include "document.h"
#include "spark/value.h"

namespace spark::mjcf {

/// A collision shape and a visible one.
struct Geom {
  Element from;
  std::string name;  ///< "" when absent
  engine::ShapeDescription shape;
  Pose pose;                     ///< in its body
  engine::Geom::Mujoco contact;  ///< its numbers of contacts
  int contactTypes = 1, contactAffinities = 1;
  int group = 0;
  std::optional<engine::Mass> mass;  ///< nullopt: none, because the body has an inertial element
  bool collides() const { return contactTypes != 0 || contactAffinities != 0; }
  /// MuJoCo's own viewer shows the first three groups.
  bool visible() const { return group < 3; }
};

enum class JointKind { free, ball, slide, hinge };
/// A joint of a body with its parent.
struct Joint {
  Element from;
  std::string name;
  JointKind kind = JointKind::hinge;
  Vec3 position = Vec3::Zero(), axis = Vec3::UnitZ();
  bool limited = false;
  std::array<double, 2> range{0, 0};
  double armature = 0, damping = 0, dryFriction = 0;
  double stiffness = 0, springAngle = 0;  ///< of a spring to that place
  double maxForce = HUGE_VAL;             ///< limit of the sum of its actuators
  engine::MujocoAxis numbers;
};

struct Site {
  std::string name;
  Pose pose;  ///< in its body
};

struct Body {
  Element from;
  std::string name;
  int parent = -1;                                   ///< index; -1: this is the world
  Pose pose;                                         ///< in its parent
  engine::Mass mass{0, Vec3::Zero(), Mat3::Zero()};  ///< inertia about its centre of mass, body axes; mass 0: none
  bool hasInertial = false;                          ///< an inertial element says so
  std::vector<Joint> joints;
  std::vector<Geom> geoms;
  std::vector<Site> sites;
};

/// A force along a joint: gear (gain u + bias[0] + bias[1] gear q + bias[2] gear dq), u being the control.
struct Actuator {
  Element from;
  std::string name, joint;
  double gear = 1, gain = 1;
  std::array<double, 3> bias{0, 0, 0};
  std::array<double, 2> controlRange{-HUGE_VAL, HUGE_VAL};
  double forceRange = HUGE_VAL;  ///< of the actuator's own force
  double maxForce = HUGE_VAL;    ///< of the force along the joint
};

struct Sensor {
  Element from;
  std::string kind, name;
  std::string object, objectType;  ///< the joint, site or body that it belongs to, and what that is
};

/// Two bodies that do not collide.
struct Exclusion {
  Element from;
  std::string body1, body2;
};

/// Two geoms that collide, whatever their types say.
struct Pair {
  Element from;
  std::string geom1, geom2;
};

/// An option that the file sets: a property of the world and its value.
struct Option {
  Element from;
  const char* property;
  Value value;
};

/// A whole model. bodies[0] is the world; parents come before their children.
struct Model {
  std::string name;
  std::vector<Option> options;
  std::vector<Body> bodies;
  std::vector<Actuator> actuators;
  std::vector<Sensor> sensors;
  std::vector<Exclusion> exclusions;
  std::vector<Pair> pairs;
};

/// Vertices and triangles of a mesh file: `read` reads it. Throws Error.
using ReadMesh = std::function<engine::ShapeDescription(const std::string& file)>;

/// Limits of a model: bodies, elements with attributes, and numbers of all meshes.
inline constexpr std::size_t kMaxBodies = 20'000, kMaxElements = 200'000, kMaxMeshNumbers = 30'000'000;

/// Reads a model. What it does not take is named in `leftOver`. Throws Error with file:line:column.
Model readModel(Document& document, const ReadMesh& readMesh, LeftOver& leftOver);

}  // namespace spark::mjcf
