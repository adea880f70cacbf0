#pragma once
/// \file
/// Constraints that MuJoCo alone knows: equalities between bodies or joints, and tendons. Their nodes may stand
/// anywhere in a scene; what they hold is of its world.

#include <array>
#include <cmath>
#include <limits>

#include "api/extension.h"
#include "api/math.h"
#include "api/scene_calls.h"

namespace spark {

namespace mujoco {

/// An equality (MuJoCo's documentation, "equality"). Bodies and joints by their identities in the model; 0: the world,
/// or none. Points and rotations in the frames of links, or of the world.
struct EqualityNumbers {
  static constexpr std::string_view kKind = "MujocoEquality";
  static constexpr std::array kTypes{"connect", "weld", "joint", "tendon"};
  std::int64_t type = 0;                            ///< index of these names
  std::uint64_t first = 0, second = 0;              ///< bodies; or joints; or tendons: their numbers and 1
  std::int64_t named = 0;                           ///< bits 1 and 2: first and second are elements, not the world
  std::int64_t part1 = 0, part2 = 0;                ///< of the bodies: indices in Body::parts, 0 where there is none
  std::array<double, 3> anchor1{}, anchor2{};       ///< connect, weld: the points that coincide [m]
  std::array<double, 4> rotation{1, 0, 0, 0};       ///< weld: of the second in the first, w x y z
  double torqueScale = 1;                           ///< weld: of rotation against translation [m]
  std::array<double, 5> polynomial{0, 1, 0, 0, 0};  ///< joint: the first's coordinate as a function of the second's
  std::array<double, 2> solref{0.02, 1};
  std::array<double, 5> solimp{0.9, 0.95, 0.001, 0.5, 2};
  std::int64_t active = 1;
};

/// A tendon (MuJoCo's documentation, "tendon"): its length is a sum of coordinates of joints, or that of a path along
/// points of bodies. Lengths in m, or for sums in the joints' units.
struct TendonNumbers {
  static constexpr std::string_view kKind = "MujocoTendon";
  static constexpr std::size_t kMaxElements = 64;
  /// What a path goes along: points, and around spheres and cylinders. A pulley divides what comes behind it.
  enum Kind : std::int64_t { kPoint, kSphere, kCylinder, kPulley };
  struct Element {
    std::uint64_t id = 0;  ///< a joint; or a body, 0: the world
    std::array<double, 3>
        point{};  ///< in the link's frame, or the world's [m]; of a joint or a pulley its number in [0]
    std::int64_t kind = kPoint;
    double radius = 0;                           ///< of a sphere or cylinder [m]
    std::array<double, 4> rotation{1, 0, 0, 0};  ///< of a cylinder, w x y z
    std::int64_t hasSide = 0;                    ///< the path goes on the side of a point, or within the geometry
    std::uint64_t sideId = 0;                    ///< the body that the point is in; 0: the world
    std::array<double, 3> side{};                ///< m
  };
  std::int64_t spatial = 0;  ///< 1: `elements` are points
  std::int64_t count = 0;    ///< of elements
  std::int64_t lacks = 0;    ///< an element named a body or a joint that was not there
  std::array<Element, kMaxElements> elements{};
  double stiffness = 0, damping = 0, frictionLoss = 0;
  double springLength = 0;  ///< at which the spring rests; below 0 for a path: that where the joints' springs rest
  std::int64_t limited = 0;
  std::array<double, 2> range{};
  double margin = 0;  ///< distance from the limit at which it begins to act
  std::array<double, 2> limitSolref{0.02, 1}, frictionSolref{0.02, 1};
  std::array<double, 5> limitSolimp{0.9, 0.95, 0.001, 0.5, 2}, frictionSolimp{0.9, 0.95, 0.001, 0.5, 2};
};

/// Numbers of blocks: ids of nodes.
inline constexpr int kConstraintNumbers = std::numeric_limits<int>::max();
inline int constraintNumber(const Leaf& node) { return static_cast<int>(node.id() % kConstraintNumbers); }

inline void requireFinite(const Leaf& node, double v) {
  if (!std::isfinite(v)) throw Error(fmt::format("{}: expected finite numbers, found {}", node.path(), v));
}
template <std::size_t N>
void requireFinite(const Leaf& node, const std::array<double, N>& numbers) {
  for (const double v : numbers) requireFinite(node, v);
}
template <class Other>
void requireFinite(const Leaf&, const Other&) {}

/// The identity of the body or joint at a path, as seen from a node; 0: there is none.
std::uint64_t identityAt(const Leaf& from, const std::string& path, bool joint);

}  // namespace mujoco

/// A constraint of the world of its scene. Several nodes have blocks side by side.
template <class T>
class MujocoConstraint : public engine::Extension<T> {
 protected:
  int number() const override { return mujoco::constraintNumber(*this); }
  engine::IExtended* element() override { return engine::worldAround(*this); }
  /// As the base does. Throws Error for numbers that are not finite.
  template <auto Member>
  void set(std::decay_t<decltype(std::declval<T>().*Member)> v) {
    mujoco::requireFinite(*this, v);
    engine::Extension<T>::template set<Member>(v);
  }
};

/// Bodies that are held together, or joints whose coordinates depend on each other.
class MujocoEquality : public MujocoConstraint<mujoco::EqualityNumbers> {
  SPARK_CLASS(MujocoEquality, Leaf)
 public:
  static void describe(Description<MujocoEquality>& d);

 protected:
  void onLink() override;

 private:
  std::string type() const { return mujoco::EqualityNumbers::kTypes[static_cast<std::size_t>(numbers().type)]; }
  void setType(const std::string& name);
  const std::string& first() const { return paths_[0]; }
  const std::string& second() const { return paths_[1]; }
  void setFirst(const std::string& path) { setPath(0, path); }
  void setSecond(const std::string& path) { setPath(1, path); }
  void setPath(std::size_t which, const std::string& path);
  void resolve();
  bool active() const { return numbers().active != 0; }
  void setActive(bool on) { set<&mujoco::EqualityNumbers::active>(on); }
  std::array<std::string, 2> paths_;
};

/// A tendon along joints or along points of bodies.
class MujocoTendon : public MujocoConstraint<mujoco::TendonNumbers>, public ISceneCalls {
  SPARK_CLASS(MujocoTendon, Leaf)
 public:
  static void describe(Description<MujocoTendon>& d);
  std::vector<SceneCall> sceneCalls() const override;

 protected:
  void onLink() override;

 private:
  void addJoint(const std::string& path, double coefficient);
  void addPoint(const std::string& path, double x, double y, double z);
  void addSphere(const std::string& path, double x, double y, double z, double radius);
  void addCylinder(const std::string& path, double x, double y, double z, double radius, const List& rotation);
  void setSide(const std::string& path, double x, double y, double z);
  void addPulley(double divisor);
  void add(bool spatial, const std::string& path, const mujoco::TendonNumbers::Element& element);
  void resolve();
  bool limited() const { return numbers().limited != 0; }
  void setLimited(bool on) { set<&mujoco::TendonNumbers::limited>(on); }
  std::vector<std::string> paths_, sides_;  ///< of the elements
};

}  // namespace spark
