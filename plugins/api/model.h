#pragma once
/// \file
/// What is in a physical world, as plain arrays. The plugin `physics` owns the model, and the state (api/state.h: where
/// everything is); engines read the model and step the state. Double precision, SI units, radians, world frame unless
/// said otherwise.
///
/// The elements of an array are in order of creation, and an index is a position in it: indices change when an earlier
/// element is removed, identities (`id`) never. A solver that keeps something of its own for an element matches it by
/// identity in ISolver::compile(): see indexOf().

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "api/blocks.h"
#include "api/math.h"
#include "api/shape.h"
#include "spark/abi/api/model.h"
#include "spark/node.h"

namespace spark::engine {

/// Position in an array of the model.
using Index = std::uint32_t;
/// No element. As a body: the static world.
inline constexpr Index kNone = UINT32_MAX;

/// Parameters of a world. For erp and cfm see the ODE manual, sections "Joint error and the error reduction parameter
/// (ERP)" and "Soft constraint and constraint force mixing (CFM)".
struct WorldParameters {
  Vec3 gravity{0, 0, -9.81};           ///< m/s^2
  double erp = 0.2;                    ///< fraction of a constraint's error that one step corrects, 0..1
  double cfm = 1e-5;                   ///< constraint force mixing, 0 or more
  bool autoDisable = true;             ///< bodies at rest fall asleep
  bool joinedCollide = false;          ///< bodies that joints connect collide with each other
  double contactSurfaceLayer = 0.001;  ///< allowed penetration depth of contacts [m]
  double timestep = 0;                 ///< of the engine's steps [s]; 0: as the engine says
};

/// Mass distribution of a body.
struct Mass {
  double mass = 1;                  ///< kg
  Vec3 center = Vec3::Zero();       ///< centre of mass, body frame [m]
  Mat3 inertia = Mat3::Identity();  ///< about the body's origin, body frame [kg m^2]
};

/// One of the parts that a body consists of.
struct Part {
  double mass = 0;               ///< kg, at least 0
  Vec3 center = Vec3::Zero();    ///< of its mass, in the body's frame [m]
  Mat3 inertia = Mat3::Zero();   ///< about its own centre, axes of the body's frame [kg m^2]
  Mat3 axes = Mat3::Identity();  ///< its principal axes, if they are; of equal moments, any are
};

/// A rigid body. Its origin is its centre of mass.
struct Body {
  std::uint64_t id = 0;  ///< identity in its world, rises in order of creation, never used again
  double mass = 1;       ///< kg, above 0
  /// Inertia about the centre of mass [kg m^2] and its inverse, body frame; positive definite.
  Mat3 inertia = Mat3::Identity(), inverseInertia = Mat3::Identity();
  /// Origin of the link's frame in the body's frame [m], for engines in coordinates of joints: the point of a free body
  /// whose place and velocity are its coordinates.
  Vec3 linkOrigin = Vec3::Zero();
  bool gravity = true;  ///< the world's gravity acts on the body
  /// The body is no more than a link in a chain of joints, for a body with several joints: what it connects counts as
  /// connected by one joint. An engine with joints of several axes may leave its mass to the next body.
  bool connector = false;
  int joints = 0;  ///< number of attached joints
  /// Damping of the motion in the world, 0 or more, at the origin of the link's frame [N s/m] and about it [N m s/rad].
  double linearDamping = 0, angularDamping = 0;
  /// For engines whose drag and contacts depend on the parts of a body: all of them, the first with its joints; or
  /// none. Their masses are shares of the body's mass. Geoms name the part that they belong to.
  std::vector<Part> parts;
};

/// A collision space. Geoms of different spaces collide with each other.
struct Space {
  std::uint64_t id = 0;
  Index parent = kNone;  ///< the space around it
  bool inner = true;     ///< geoms directly in this space collide with each other
};

/// Collision geometry.
struct Geom {
  std::uint64_t id = 0;    ///< identity; a younger geom has a higher one
  Index space = kNone;     ///< the space that it is in
  Index body = kNone;      ///< the body that it moves with; kNone: static
  Pose offset;             ///< in the body's frame; the world pose of a static geom; no meaning for planes
  bool centred = false;    ///< the offset is the identity, as of most parts of a robot
  ShapeDescription shape;  ///< valid: see checkShape()
  bool collides = true;    ///< false: it has no contacts
  int part = 0;            ///< index in Body::parts; 0 where there is none
  void* owner = nullptr;   ///< passed to the pair filter and stored in contacts
};

/// Joint types of the ODE manual, section "Joint types and joint functions".
enum class JointType { ball, hinge, hinge2, slider, universal, fixed, angularMotor };
/// Number of axes with motor and stops of a joint.
constexpr int axesOf(JointType type) {
  switch (type) {
    case JointType::hinge:
    case JointType::slider:
      return 1;
    case JointType::universal:
    case JointType::hinge2:
      return 2;
    case JointType::angularMotor:
      return 3;
    default:
      return 0;
  }
}
/// One axis of a joint. Angles and velocities are those of body a relative to b. Stops with lowStop above highStop have
/// no effect, except on angular motors. Forces are in N for sliders, in Nm for rotation.
struct JointAxis {
  double lowStop = -HUGE_VAL, highStop = HUGE_VAL;  ///< rad or m; equal stops lock the axis; infinite: no stop
  double armature = 0;                              ///< inertia of the motor's rotor about the axis [kg m^2 or kg]
  /// Force per velocity, against it [N m s or N s/m]. Of a ball joint, which has no axes, that of the first entry acts
  /// about all directions.
  double damping = 0;
  double dryFriction = 0;  ///< largest force of dry friction [Nm or N]
  /// A passive spring: the force stiffness (springPosition - coordinate), beside motor and controller [Nm/rad or N/m].
  double stiffness = 0;
  double springPosition = 0;  ///< rad or m; counted as angles of joints are
};

/// Where a joint is in one of its bodies, or in the world where it has no body. "When set" means when the anchor, an
/// axis or the bodies were last set.
struct JointFrame {
  Vec3 anchor = Vec3::Zero();  ///< m
  /// The joint's axes, of length 1 where there is a body. One that is fixed in the other body: where it was when set.
  std::array<Vec3, 3> axis{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  std::array<double, 4> rotation{1, 0, 0, 0};  ///< of the joint when set, w x y z
};

/// What an angular motor has beside its axes.
struct AngularMotor {
  int axes = 0;                          ///< number of axes, 0..3
  bool euler = false;                    ///< axes and angles are Euler angles
  std::array<int, 3> frame{0, 0, 0};     ///< axis i is fixed in 0 the world, 1 a, 2 b
  std::array<double, 3> angle{0, 0, 0};  ///< as the caller says [rad], unless `euler`
};

/// A joint between two bodies, or between a body and the world. `a` is kNone only if it is attached to nothing.
///
/// Of most types the anchors of both frames coincide, and b has the rotation inA.rotation in a where all coordinates
/// are 0. What differs, by type:
///
///     ball           no axes
///     hinge          axis 0, fixed in both
///     slider         the same; inB.anchor alone: a's centre when set
///     universal      axis 0 is fixed in a, axis 1 in b; rotations are those of the frames (axis 0, axis 1) in a and
///                    (axis 1, axis 0) in b
///     hinge2         axis 0 is fixed in a, axis 1 in b. inA.axis is the right-handed frame (axis 0, axis 1 when set,
///                    made perpendicular, third); inB.axis[0] is axis 0 when set, made perpendicular to axis 1, and
///                    inB.axis[2] = axis 1 x inB.axis[0]
///     fixed          anchors: b's centre when set, in a, and zero; without b zero, and a's centre when set. A rotation
///                    of zeros: never set, it drifts
///     angularMotor   axis i is inB.axis[i] where it is fixed in b, else inA.axis[i]; Euler: axis 0 is fixed in the
///                    first body, axis 2 in the second, and angles count from where they were in the other one
struct alignas(64) Joint {
  JointType type = JointType::hinge;
  Index a = kNone, b = kNone;  ///< b kNone: the world
  /// Only a second body was attached, and is `a`. A slider's axis then points the other way, and an Euler motor's first
  /// and third axes change places.
  bool reversed = false;
  bool wantsFeedback = false;  ///< a step writes the joint's JointState
  /// Only as many as the type has axes are used; ball joints have damping alone. The first one is beside the type, in a
  /// cache line: a command to a motor reads both.
  std::array<JointAxis, 3> axes;
  JointFrame inA, inB;
  double cosAxes = 0, sinAxes = 0;  ///< hinge2: cosine and sine of the angle between the axes when set
  AngularMotor motor;               ///< of an angular motor
  std::uint64_t id = 0;             ///< identity in its world
  /// Rise in the world with each attachment of a joint, and with each setting of one. A joint with setAt 0 was never
  /// set.
  std::uint64_t attachedAt = 0, setAt = 0;
};

/// What is in a world.
struct Model {
  WorldParameters parameters;  ///< numbers are valid
  /// The world repeats recorded sessions of the installed base: numbers that enter it are rounded to single precision,
  /// and engines that can do so keep that base's order of contacts.
  bool exactReplay = false;
  std::vector<Body> bodies;
  std::vector<Space> spaces;
  std::vector<Geom> geoms;
  std::vector<Joint> joints;
  /// What single engines know of the elements (api/extension.h), by their indices.
  struct Extensions {
    Blocks world;
    std::vector<Blocks> geoms, joints;
    std::vector<Blocks> sceneJoints;  ///< of the scene language (api/scene_joint.h), by joint
  } extensions;
  /// Versions: `structure` changes with every element that is created, removed or attached, `collision` with spaces and
  /// geoms, `dynamics` with masses, joints and parameters.
  std::uint64_t structure = 0, collision = 0, dynamics = 0;
};

/// The index of the element with this identity; kNone: there is none any more.
template <class Element>
Index indexOf(const std::vector<Element>& elements, std::uint64_t id) {
  const auto found = std::lower_bound(elements.begin(), elements.end(), id,
                                      [](const Element& e, std::uint64_t wanted) { return e.id < wanted; });
  return found != elements.end() && found->id == id ? static_cast<Index>(found - elements.begin()) : kNone;
}

}  // namespace spark::engine
