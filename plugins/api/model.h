#pragma once
/// \file
/// A physical world as plain arrays. The plugin `physics` owns the model (what is there) and the state (where it is);
/// engines read the model and step the state. Double precision, SI units, radians, world frame unless said otherwise.
///
/// The elements of an array are in order of creation, and an index is a position in it: indices change when an earlier
/// element is removed, identities (`id`) never. A solver that keeps something of its own for an element matches it by
/// identity in ISolver::compile(): see indexOf().

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "api/blocks.h"
#include "api/math.h"
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

/// Kinds of collision shapes.
enum class Shape { box, sphere, capsule, cylinder, plane, ray, mesh };
/// A collision shape in its own frame. Capsules and cylinders lie along z.
struct ShapeDescription {
  Shape shape = Shape::box;
  Vec3 lengths{1, 1, 1};           ///< box: full edge lengths [m]
  double radius = 1;               ///< sphere, capsule, cylinder [m]
  double length = 1;               ///< capsule (without the caps), cylinder, ray [m]
  double plane[4] = {0, 0, 1, 0};  ///< a b c d of ax + by + cz = d, world frame; the normal need not have length 1
  Vec3 rayOrigin = Vec3::Zero(), rayDirection{0, 0, 1};
  std::vector<double> vertices;          ///< mesh: x y z of each vertex [m]
  std::vector<std::uint32_t> triangles;  ///< mesh: three vertex indices of each triangle
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
/// Names of the parameters of one axis of a joint: see JointAxis. The suspension parameters belong to axis 0 of hinge2.
enum class JointParameter {
  lowStop,
  highStop,
  velocity,
  maxForce,
  fudgeFactor,
  bounce,
  cfm,
  stopErp,
  stopCfm,
  suspensionErp,
  suspensionCfm,
  armature,
  damping,
  dryFriction
};

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
  /// How soft motor and stops are, as scene files of the installed base say it; names as in the section "Stop and motor
  /// parameters" of the ODE manual. Solvers that are not soft do not read them.
  struct Softness {
    double fudgeFactor = 1;  ///< 0..1: scales a motor that drives away from the stop it is at
    double bounce = 0;       ///< restitution of the stops, 0..1
    double cfm = 0;          ///< of the motor's row [velocity / force]
    double stopErp = 0;      ///< of the stops' row, 0..1
    double stopCfm = 0;      ///< of the stops' row [velocity / force]
  } soft;
};

/// Where a body was when a joint was set.
struct AssemblyPose {
  Vec3 position;
  std::array<double, 4> quaternion;
  Mat3 rotation;
};
/// One call that set a joint, with the places of its bodies at that time. An engine that takes joints in world
/// coordinates repeats the calls of a joint in their order; others read the frames in Joint.
struct Assembly {
  enum class Kind { anchor, axis, motor, angle, fixed } kind = Kind::anchor;
  int axis = 0;               ///< of `axis` and `angle`; number of axes of `motor`
  int frame = 0;              ///< axis of an angular motor: as Joint::frame; motor: 1 in Euler mode
  Vec3 world = Vec3::Zero();  ///< point [m] or direction; angle [rad] in x
  AssemblyPose a, b;          ///< of the bodies of the joint; unused for the world
};

/// A joint between two bodies, or between a body and the world.
///
/// `a` is kNone only if the joint is attached to nothing. A joint that was attached to a second body alone has that
/// body as `a`, and `reversed` is true. A vector "in a" (or b) is in the frame of that body, or in the world frame if
/// there is no body. Directions have length 1, except those in b where b is kNone. "When set" means when the anchor, an
/// axis or the bodies were last set.
struct alignas(64) Joint {
  JointType type = JointType::hinge;
  Index a = kNone, b = kNone;  ///< b kNone: the world
  /// Only a second body was attached. A slider's axis then points the other way, and an Euler motor's first and third
  /// axes change places.
  bool reversed = false;
  bool wantsFeedback = false;  ///< a step writes the joint's JointState
  /// Rotations when set, w x y z. Hinge, slider and fixed: initialRotationA is b's rotation relative to a. Universal:
  /// A is the orthonormal frame of (axis 1, axis 2) in a, B that of (axis 2, axis 1) in b. All zeros: a fixed joint
  /// that was never set, whose rotation drifts.
  std::array<double, 4> initialRotationA{1, 0, 0, 0};
  std::array<JointAxis, 3> axes;  ///< only as many as the type has axes are used; ball joints have damping alone
  /// Joint axes in a and in b. Hinge and slider: the axis is [0] of both. Universal and hinge2: axis 1 is axisA[0],
  /// axis 2 is axisB[1]. Angular motor: axis i is axisA[i] in the frame that `frame[i]` names; Euler: [0] in the first
  /// body and [2] in the second.
  std::array<Vec3, 3> axisA{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  std::array<Vec3, 3> axisB{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  /// The points [m] that coincide, in a and in b, except:
  /// fixed: b's centre when set, in a, and zero; without b zero and a's centre when set, in the world.
  /// slider: anchorB alone, a's centre when set, in b.
  Vec3 anchorA = Vec3::Zero(), anchorB = Vec3::Zero();
  std::array<double, 4> initialRotationB{1, 0, 0, 0};
  /// hinge2: the directions from which angles are counted. [0] is the other axis when set, made perpendicular to this
  /// one; [1] completes the right-handed frame (axis, [0], [1]). planeA belongs to axis 1, in a; planeB to axis 2, in
  /// b.
  std::array<Vec3, 2> planeA{Vec3::Zero(), Vec3::Zero()}, planeB{Vec3::Zero(), Vec3::Zero()};
  double cosAxes = 0, sinAxes = 0;           ///< hinge2: cosine and sine of the angle between the axes when set
  int motorAxes = 0;                         ///< angular motor: number of axes, 0..3
  bool euler = false;                        ///< angular motor: axes and angles are Euler angles
  std::array<int, 3> frame{0, 0, 0};         ///< angular motor: axis i is fixed in 0 the world, 1 a, 2 b
  std::array<double, 3> userAngle{0, 0, 0};  ///< angular motor: the caller's angles [rad], unless `euler`
  /// Euler motor: the zero directions of its angles. reference1 is b's axis when set, in a; reference2 is a's axis when
  /// set, in b.
  Vec3 reference1 = Vec3::Zero(), reference2 = Vec3::Zero();
  /// How soft the joint is, likewise.
  struct Softness {
    double erp = 0.2, cfm = 1e-5;                 ///< ball and fixed: of the anchor's rows; other rows use the world's
    double suspensionErp = 0, suspensionCfm = 0;  ///< hinge2: of the row along axis 1
  } soft;
  std::vector<Assembly> assembly;  ///< the calls that set it, the last of each kind and axis
  std::uint64_t id = 0;            ///< identity in its world
  std::uint64_t attachedAt = 0;    ///< rises with each attachment in the world
  std::uint64_t assembledAt = 0;   ///< rises with each change of `assembly` in the world
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
  } extensions;
  /// Versions: `structure` changes with every element that is created, removed or attached, `collision` with spaces and
  /// geoms, `dynamics` with masses, joints and parameters.
  std::uint64_t structure = 0, collision = 0, dynamics = 0;
};

/// Where a body is and how it moves, world frame.
struct BodyState {
  Vec3 position;         ///< of the centre of mass [m]
  Vec3 linearVelocity;   ///< m/s
  Vec3 angularVelocity;  ///< rad/s
  Mat3 rotation;
};

/// The index of the element with this identity; kNone: there is none any more.
template <class Element>
Index indexOf(const std::vector<Element>& elements, std::uint64_t id) {
  const auto found = std::lower_bound(elements.begin(), elements.end(), id,
                                      [](const Element& e, std::uint64_t wanted) { return e.id < wanted; });
  return found != elements.end() && found->id == id ? static_cast<Index>(found - elements.begin()) : kNone;
}

/// The state of a body that a step changes, world frame. What is read together lies together, in cache lines.
struct alignas(64) DynamicState {
  std::array<double, 4> quaternion{1, 0, 0, 0};  ///< w x y z, body to world, of length 1
  Vec3 position = Vec3::Zero();                  ///< of the centre of mass [m]
  bool awake = true;                             ///< false: the body sleeps
  bool moved = false;                            ///< it is in State::moved
  /// Rises whenever pose or velocity are written, by whomever: a solver that keeps them in memory of its own knows by
  /// it whether they are still the same.
  std::uint32_t version = 1;
  Mat3 rotation = Mat3::Identity();     ///< the same as `quaternion`, as a matrix
  Vec3 angularVelocity = Vec3::Zero();  ///< rad/s
  Vec3 linearVelocity = Vec3::Zero();   ///< m/s
  Vec3 force = Vec3::Zero();            ///< N, accumulated for the next step, which clears it
  Vec3 torque = Vec3::Zero();           ///< Nm, likewise
};

/// The motor of one axis of a joint: it reaches its target velocity with a force of at most maxForce, see JointAxis.
struct Motor {
  double velocity = 0;  ///< target [rad/s or m/s]
  double maxForce = 0;  ///< bound of the force, at least 0; 0: no motor
};
/// The motors of a joint, by axis.
using Motors = std::array<Motor, 3>;

/// The controller of one axis of a joint, in place of its motor: a force of
///
///     stiffness (position - angle) + damping (velocity - rate) + force,   at most maxForce,
///
/// in each of an engine's own steps. Units as in JointAxis.
struct Control {
  double stiffness = 0, damping = 0;  ///< kp [Nm/rad or N/m] and kd [N m s or N s/m], 0 or more
  double position = 0, velocity = 0;  ///< targets [rad and rad/s, or m and m/s]
  double force = 0;                   ///< feed-forward [Nm or N]; alone it is a motor that is given its torque
  double maxForce = HUGE_VAL;         ///< bound of the sum [Nm or N]
  double at(double angle, double rate) const {
    return std::clamp(stiffness * (position - angle) + damping * (velocity - rate) + force, -maxForce, maxForce);
  }
};
/// A controller and the axis that it acts on.
struct AxisControl {
  Index joint = kNone;
  int axis = 0;
  Control control;
};

/// What a step measures at a joint with `wantsFeedback`: force [N] and torque about the body's centre [Nm] on a and b;
/// zero on the world.
struct JointState {
  Vec3 forceA = Vec3::Zero(), torqueA = Vec3::Zero(), forceB = Vec3::Zero(), torqueB = Vec3::Zero();
};

/// Where the axes of a joint are, as its stops count: continuous, so a hinge that has turned once is at 2 pi, not at 0.
/// A pose has no turns. They are counted from step to step, and a step that turns an axis by pi or more is taken for
/// one the other way round.
struct JointCoordinates {
  std::array<double, 3> angle{0, 0, 0};        ///< as the poses have it, -pi..pi [rad]
  std::array<std::int32_t, 3> turns{0, 0, 0};  ///< whole turns beside it
  /// The coordinate of a rotational axis [rad].
  double at(std::size_t axis) const { return angle[axis] + 2 * kPi * turns[axis]; }
};

/// The angle that differs from `angle` by whole turns and is nearest to `near` [rad].
inline double nearestTurn(double angle, double near) {
  const double turns = std::round((near - angle) / (2 * kPi));
  return turns == 0 ? angle : angle + 2 * kPi * turns;
}

/// Where everything in a world is, with the indices of the model.
struct State {
  std::vector<DynamicState> bodies;
  std::vector<JointState> joints;
  /// By joint, when a step begins: of hinges, universal joints, hinge2 and Euler motors. The plugin `physics` writes
  /// them.
  std::vector<JointCoordinates> coordinates;
  std::size_t turned = 0;      ///< number of joints with turns other than 0
  std::vector<Motors> motors;  ///< by joint
  std::vector<AxisControl> controls;
  /// The bodies whose pose changed since the last detect(), each once, in the order in which they did.
  std::vector<Index> moved;
  /// Appends a body to `moved`, once.
  void markMoved(Index body) {
    if (std::exchange(bodies[body].moved, true)) return;
    moved.push_back(body);
  }
};

/// Contact surface of two colliders, combined (scene-language section 3.3). Bounce, soft ERP, soft CFM and slip count
/// only with their flags.
struct Surface {
  bool bounceOn = false, softErpOn = false, softCfmOn = false, slipOn = false;
  /// True: mu is a coefficient, and friction is bounded by mu times the normal force of a solution without friction
  /// (friction pyramid). False: mu is a force.
  bool pyramid = false;
  /// Bound of friction along each tangent: a force [N], or a coefficient. Infinite: what touches does not slide.
  double mu = HUGE_VAL;
  double bounce = 0;            ///< restitution, 0..1
  double bounceVelocity = 0;    ///< smallest approach speed at which the contact bounces [m/s]
  double softErp = 0;           ///< error reduction parameter of the contact
  double softCfm = 0;           ///< constraint force mixing of the contact
  double slip1 = 0, slip2 = 0;  ///< force-dependent slip along the two tangents [m/(N s)]
};

/// One contact point. IDetector::detect() creates it, collision handlers complete it, ISolver::step() solves it.
struct Contact {
  Index geomA = kNone, geomB = kNone;
  Index bodyA = kNone, bodyB = kNone;  ///< of the geoms; kNone: static
  void* ownerA = nullptr;              ///< the owner of geomA
  void* ownerB = nullptr;              ///< the owner of geomB
  Vec3 position, normal;               ///< world frame [m, unit vector]; the normal points into A
  double depth = 0;                    ///< penetration depth [m]
  bool solve = false;                  ///< the solver is to treat it as a constraint; only with a body
  bool feedback = false;               ///< step() is to write forceOnA
  Surface surface;
  Vec3 forceOnA = Vec3::Zero();  ///< force on A, world frame [N]
};

/// True when `a` is the first geom of a contact with `b`: movable geoms come before static ones, planes come last;
/// among equals the younger comes first. So a robot's foot comes before the ground and before older objects on it, and
/// handlers that use only direct contacts get them. `G` is Geom, or has its members `shape`, `body` and `id`.
template <class G>
bool comesFirst(const G& a, const G& b) {
  const auto rank = [](const G& g) { return g.shape.shape == Shape::plane ? 0 : g.body != kNone ? 2 : 1; };
  const int ra = rank(a), rb = rank(b);
  return ra != rb ? ra > rb : a.id > b.id;
}

/// The contacts of one step, grouped by geom pair, in the order of detection. Reused for all steps, to keep the
/// capacity.
using Contacts = std::vector<Contact>;

/// Returns whether two geoms may collide at all; called with their owners, for every pair with overlapping bounds.
using PairFilter = bool (*)(void* ownerA, void* ownerB);

}  // namespace spark::engine
