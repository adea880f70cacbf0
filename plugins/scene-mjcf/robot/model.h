#pragma once
/// \file
/// An MJCF model as plain data. SI units, radians; frames as in MuJoCo. "when absent" values are MuJoCo's.

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "api/model.h"
#include "document.h"
#include "spark/value.h"

namespace spark::mjcf {

/// Numbers of contacts that MuJoCo alone reads (MuJoCo's documentation, "Contact").
struct ContactNumbers {
  std::array<double, 3> friction{1, 0.005, 0.0001};  ///< sliding; torsional and rolling [m]
  int condim = 3, priority = 0;                      ///< dimensions; of two surfaces that of higher priority counts
  std::array<double, 2> solref{0.02, 1};             ///< time constant [s], damping ratio
  std::array<double, 5> solimp{0.9, 0.95, 0.001, 0.5, 2};  ///< impedance
  double margin = 0, gap = 0;                              ///< m
  double solmix = 1;                                       ///< weight of solref and solimp against another surface's
  double thickness = 1;                                    ///< of a height field, below its lowest point [m]
  bool ellipsoidDrag = false;                              ///< a medium drags at its ellipsoid
  std::array<double, 5> dragCoefficients{0.5, 0.25, 1.5, 1, 1};  ///< blunt, slender, angular; Kutta, Magnus
  bool operator==(const ContactNumbers&) const = default;
};

/// How firm the stops and the dry friction of a joint are, which MuJoCo alone reads (MuJoCo's documentation, "joint").
struct Firmness {
  std::array<double, 2> stopSolref{0.02, 1}, frictionSolref{0.02, 1};
  std::array<double, 5> stopSolimp{0.9, 0.95, 0.001, 0.5, 2}, frictionSolimp{0.9, 0.95, 0.001, 0.5, 2};
  double stopMargin = 0;  ///< rad or m
  bool operator==(const Firmness&) const = default;
};

/// A collision shape and a visible one.
struct Geom {
  Element from;
  std::string name;  ///< "" when absent
  engine::ShapeDescription shape;
  Pose pose;  ///< in its body
  ContactNumbers contact;
  int contactTypes = 1, contactAffinities = 1;
  bool isShape = true;            ///< false: only its mass counts
  Vec3 ellipsoid = Vec3::Zero();  ///< half axes of an ellipsoid, whose shape is a convex one [m]; 0: it is none
  int group = 0;
  std::optional<std::array<double, 4>> color{};  ///< red, green, blue, opacity, each 0 to 1; nullopt: none is given
  std::optional<engine::Mass> mass;              ///< nullopt: none, because the body has an inertial element
  bool collides() const { return contactTypes != 0 || contactAffinities != 0; }
  /// MuJoCo's own viewer shows the first three groups.
  bool visible() const { return group < 3; }
};

enum class JointKind { free, ball, slide, hinge };
/// A joint of a body with its parent. Its coordinate is 0 in the pose of the file, where MuJoCo's is `reference`.
struct Joint {
  Element from;
  std::string name;
  JointKind kind = JointKind::hinge;
  Vec3 position = Vec3::Zero(), axis = Vec3::UnitZ();
  bool limited = false;
  std::array<double, 2> range{0, 0};
  double reference = 0;  ///< MuJoCo's coordinate in the pose of the file [rad or m]
  double armature = 0, damping = 0, dryFriction = 0;
  double stiffness = 0, springPosition = 0;           ///< of a spring, and where it rests [rad or m]
  std::optional<std::array<double, 2>> springDamper;  ///< time constant [s] and damping ratio, in place of both
  double maxForce = HUGE_VAL;                         ///< limit of the sum of its actuators
  Firmness firmness;
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
  Mat3 inertiaAxes = Mat3::Identity();               ///< principal axes, where inertial or geom give them
  bool isFrameOpen = false;                          ///< its frame is where its centre of mass is
  bool hasInertial = false;                          ///< an inertial element says so
  bool isWeighed = false;                            ///< the compiler counts the masses of some of its geoms
  double gravityCompensation = 0;                    ///< part of the gravity that does not act on it
  std::vector<Joint> joints;
  std::vector<Geom> geoms;
  std::vector<Site> sites;
};

/// A force along a joint: gear clamp(g u + b), where u is the control, clamped to its range, g is
/// gain[0] + gain[1] l + gain[2] v, b is the same of bias, l = gear q and v = gear dq for the joint's coordinate q.
struct Actuator {
  Element from;
  std::string name, joint;
  double gear = 1;
  std::array<double, 3> gain{1, 0, 0}, bias{0, 0, 0};
  std::array<double, 2> controlRange{-HUGE_VAL, HUGE_VAL};
  std::array<double, 2> forceRange{-HUGE_VAL, HUGE_VAL};  ///< of the actuator's own force, before the gear
  /// What only MuJoCo's engine has of an actuator (MuJoCo's documentation, "actuator/general").
  struct Engine {
    std::string type = "joint";     ///< jointinparent, tendon, site, slidercrank or body
    std::string target, reference;  ///< tendon, body, site or crank's site; slider's site, or site of reference
    std::array<double, 6> gear{1, 0, 0, 0, 0, 0};
    double crankLength = 0;  ///< m
    std::string dynamics = "none", gainType = "fixed", biasType = "none";
    std::array<double, 10> dynamicsNumbers{1}, gain{1}, bias{};
    std::array<double, 2> activationRange{}, lengthRange{};  ///< equal: none
    /// A controller of a hinge or slider may be the same.
    bool isPlain() const {
      return (type == "joint" || type == "jointinparent") && dynamics == "none" && gainType != "muscle" &&
             biasType != "muscle";
    }
  } engine;
};

/// How a sensor, or some of its numbers, differ from the truth: in the units of its percept, applied in this order.
struct Imperfection {
  const char* field = "";                     ///< name of the list with the numbers; "": the whole percept
  std::vector<int> indices{};                 ///< which of them; empty: all
  double bias = 0, biasSigma = 0;             ///< a constant offset: mean, and standard deviation of what is drawn once
  double sigma = 0;                           ///< standard deviation of noise
  double relative = 0;                        ///< the same, as a fraction of the number
  double least = -HUGE_VAL, most = HUGE_VAL;  ///< range
  double step = 0;                            ///< resolution; 0: any number
};

struct Sensor {
  Element from;
  std::string kind, name;
  std::string object, objectType;  ///< the joint, site, body or geom that it belongs to, and what that is
  std::string reference;           ///< the object in whose frame it senses; "": the world
  // For languages other than MJCF: the class of a perceptor that is made at the site `object`, or that the contacts of
  // the body `object` feed, whatever `kind` is; and what its properties are set to.
  const char* perceptor = nullptr;
  std::vector<std::pair<const char*, Value>> settings{};
  std::vector<Imperfection> imperfections{};
  double rate = 0;  ///< percepts per second of simulated time [Hz]; 0: one in each cycle
  // Of MJCF, in MuJoCo's units.
  double noise = 0;   ///< standard deviation, if the model's flag says so
  double cutoff = 0;  ///< largest magnitude; 0: any
};

/// Bodies that are held together, or joints whose coordinates depend on each other (MuJoCo's documentation,
/// "equality").
struct Equality {
  Element from;
  std::string type, name;                                   ///< connect, weld, joint or tendon
  std::string first, second;                                ///< bodies, joints or tendons; second "": none
  Vec3 anchor = Vec3::Zero();                               ///< connect: in the first body; weld: in the second
  std::array<double, 7> relativePose{0, 1, 0, 0, 0, 0, 0};  ///< weld: of the second in the first; rotation 0: as placed
  double torqueScale = 1;
  std::array<double, 5> polynomial{0, 1, 0, 0, 0};
  std::array<double, 2> solref{0.02, 1};
  std::array<double, 5> solimp{0.9, 0.95, 0.001, 0.5, 2};
  bool active = true;
};

/// What a tendon goes along: a joint or a site, a geom around which it goes, or a pulley.
struct TendonPart {
  enum class Kind { joint, site, geom, pulley };
  Element from;
  std::string name;
  double coefficient = 1;  ///< of a joint; of a pulley its divisor
  Kind kind = Kind::joint;
  std::string side;  ///< the site on whose side of the geom it goes; "": the shorter way
};
/// A tendon (MuJoCo's documentation, "tendon").
struct Tendon {
  Element from;
  std::string name;
  bool spatial = false;  ///< its parts are sites
  std::vector<TendonPart> parts;
  double stiffness = 0, damping = 0, frictionLoss = 0;
  double springLength = -1;  ///< -1: that in the pose of the file
  bool limited = false;
  std::array<double, 2> range{0, 0};
  double margin = 0;
  std::array<double, 2> limitSolref{0.02, 1}, frictionSolref{0.02, 1};
  std::array<double, 5> limitSolimp{0.9, 0.95, 0.001, 0.5, 2}, frictionSolimp{0.9, 0.95, 0.001, 0.5, 2};
};

/// Two bodies that do not collide.
struct Exclusion {
  Element from;
  std::string body1, body2;
};

/// Two geoms that collide, whatever their types say, and their surface.
struct Pair {
  Element from;
  std::string geom1, geom2;
  std::optional<int> condim{};
  std::optional<std::array<double, 5>> friction{};
  std::optional<std::array<double, 2>> solref{};
  std::optional<std::array<double, 5>> solimp{};
  std::optional<double> margin{}, gap{};
};

/// An option that the file sets: a property of the world, or of what MuJoCo alone reads of it, and its value.
struct Option {
  Element from;
  const char* property;
  Value value;
  bool ofMujoco = false;
};

/// The flags of the element `option` that change how the model moves.
struct Flags {
  bool contact = true, limit = true, frictionLoss = true, passive = true, actuation = true, clampControl = true,
       equality = true;
  bool sensorNoise = false;  ///< sensors have the noise of their attributes
};

/// By the mesh of a convex hull: what it is the hull of. Only looked up.
using Surfaces = std::map<const engine::Mesh*, std::shared_ptr<const engine::Mesh>>;

/// A whole model. bodies[0] is the world; parents come before their children.
struct Model {
  std::string name;
  bool selfCollides = true;     ///< false: its bodies do not collide with each other
  bool meshesAreHulls = false;  ///< static meshes collide as their convex hulls, too
  Surfaces surfaces;
  std::vector<Option> options;
  std::string collision = "all";  ///< which geoms collide: "predefined" are pairs alone, "dynamic" is without pairs
  Flags flags;
  std::vector<Body> bodies;
  std::vector<Actuator> actuators;
  std::vector<Sensor> sensors;
  std::vector<Equality> equalities;
  std::vector<Tendon> tendons;
  std::vector<Exclusion> exclusions;
  std::vector<Pair> pairs;
  std::set<std::string, std::less<>> skippedTendons;    ///< names of tendons that are left out
  std::set<std::string, std::less<>> unsupportedGeoms;  ///< names of geoms that cannot collide
};

/// Vertices and triangles of a mesh file: `read` reads it. Throws Error.
using ReadMesh = std::function<engine::Mesh(const std::string& file)>;

/// The heights of a file, whose size is not set: `read` reads it. Throws Error.
using ReadHeights = std::function<engine::HeightField(const std::string& file)>;

/// Limits of a model: bodies, elements with attributes, and numbers of all meshes.
inline constexpr std::size_t kMaxBodies = 20'000, kMaxElements = 200'000, kMaxMeshNumbers = 30'000'000;

/// Reads a model. What it does not take is named in `unsupported`. Throws Error with file:line:column.
Model readModel(Document& document, const ReadMesh& readMesh, Unsupported& unsupported,
                const ReadHeights& readHeights = {});

}  // namespace spark::mjcf
