#pragma once
/// \file
/// Nodes that hold what MuJoCo alone reads of a collider, of an axis of a joint, and of the world.

#include <array>

#include "api/extension.h"
#include "api/math.h"

namespace spark {

namespace mujoco {

/// The surface of a collider (MuJoCo's documentation, "Contact").
struct SurfaceNumbers {
  static constexpr std::string_view kKind = "MujocoSurface";
  static constexpr std::int64_t kNoSurface = -1'000'000;
  std::array<double, 3> friction{1, 0.005, 0.0001};  ///< sliding; torsional and rolling [m]
  std::int64_t condim = 3;                           ///< dimensions of a contact: 1, 3, 4 or 6
  std::int64_t priority = kNoSurface;     ///< of two surfaces that of higher priority counts; a MujocoSurface has 0
  std::array<double, 2> solref{0.02, 1};  ///< time constant [s], damping ratio
  std::array<double, 5> solimp{0.9, 0.95, 0.001, 0.5, 2};  ///< impedance: from, to, width [m], midpoint, power
  double margin = 0, gap = 0;  ///< distance at which contacts begin, and that part of it without force [m]
  double solmix = 1;           ///< weight of solref and solimp against those of another surface
  std::array<double, 3> ellipsoid{0, 0, 0};  ///< half axes, where a convex shape is an ellipsoid [m]; 0: it is none
  double thickness = 1;                      ///< of a height field, below its lowest point [m]
  std::int64_t ellipsoidDrag = 0;            ///< a medium drags at its ellipsoid, with these coefficients
  std::array<double, 5> dragCoefficients{0.5, 0.25, 1.5, 1, 1};  ///< blunt, slender, angular; Kutta, Magnus
};

/// An axis of a joint (MuJoCo's documentation, "joint"): time constant [s] and damping ratio, and impedance, of the
/// stops and of dry friction. A motor is dry friction about a moving reference, and stiff.
struct AxisNumbers {
  static constexpr std::string_view kKind = "MujocoAxis";
  std::array<double, 2> stopSolref{0.01, 1}, frictionSolref{0.01, 1};
  std::array<double, 5> stopSolimp{0.95, 0.99, 0.001, 0.5, 2}, frictionSolimp{0.9999, 0.9999, 0.001, 0.5, 2};
  double stopMargin = 0;  ///< distance from a stop at which it begins to act [rad or m]
};

/// The world (MuJoCo's documentation, "option").
struct OptionNumbers {
  static constexpr std::string_view kKind = "MujocoOptions";
  static constexpr std::array kIntegrators{"Euler", "implicit", "RK4"};
  static constexpr std::array kCones{"pyramidal", "elliptic"};
  static constexpr std::array kSolvers{"Newton", "PGS", "CG"};
  std::int64_t integrator = 0, cone = 0, solver = 0;  ///< indices of these names
  std::int64_t iterations = 100;                      ///< most of the solver
  double tolerance = 1e-8;                            ///< at which the solver stops
  double impratio = 1;                                ///< impedance of friction over that of the normal force
  double density = 0;                                 ///< of the medium [kg/m^3]
  double viscosity = 0;                               ///< of the medium [Pa s]
  std::array<double, 3> wind{0, 0, 0};                ///< velocity of the medium [m/s]
  std::int64_t noslipIterations = 0;                  ///< of the solver that takes back slip
  double noslipTolerance = 1e-6;                      ///< at which it stops
  std::int64_t mprIterations = 50;                    ///< most of the collision of convex shapes
  double mprTolerance = 1e-6;                         ///< at which it stops
  std::int64_t refsafe = 1;                           ///< time constants are at least two steps
  std::int64_t multiccd = 0;                          ///< convex shapes touch in several points
  std::int64_t explicitLaws = 0;                      ///< see mujoco_laws.cpp
  std::int64_t allContacts = 0;                       ///< those beyond the most of a pair are solved, too
  std::int64_t overrides = 0;                         ///< all contacts have these numbers:
  double overrideMargin = 0;                          ///< m
  std::array<double, 2> overrideSolref{0.02, 1};
  std::array<double, 5> overrideSolimp{0.9, 0.95, 0.001, 0.5, 2};
};

}  // namespace mujoco

/// What MuJoCo alone reads of the collider above it.
class MujocoSurface : public engine::Extension<mujoco::SurfaceNumbers> {
  SPARK_CLASS(MujocoSurface, Leaf)
 public:
  MujocoSurface() { set<&mujoco::SurfaceNumbers::priority>(0); }
  static void describe(Description<MujocoSurface>& d);

 private:
  void setCondim(std::int64_t n);
  template <auto Member>
  bool is() const {
    return numbers().*Member != 0;
  }
  template <auto Member>
  void setIs(bool on) {
    set<Member>(on);
  }
};

/// What MuJoCo alone reads of an axis of the joint above it.
class MujocoAxis : public engine::Extension<mujoco::AxisNumbers> {
  SPARK_CLASS(MujocoAxis, Leaf)
 public:
  static void describe(Description<MujocoAxis>& d);

 private:
  int number() const override { return axis_; }
  int axis() const { return axis_; }
  void setAxis(int axis) {
    withdraw();
    axis_ = axis;
    pass();
  }
  int axis_ = 0;
};

/// What MuJoCo alone reads of the world above it.
class MujocoOptions : public engine::Extension<mujoco::OptionNumbers> {
  SPARK_CLASS(MujocoOptions, Leaf)
 public:
  static void describe(Description<MujocoOptions>& d);

 private:
  template <auto Member, auto& Names>
  std::string name() const {
    return Names[static_cast<std::size_t>(numbers().*Member)];
  }
  template <auto Member, auto& Names>
  void setName(const std::string& name);
  template <auto Member>
  bool is() const {
    return numbers().*Member != 0;
  }
  template <auto Member>
  void setIs(bool on) {
    set<Member>(on);
  }
};

}  // namespace spark
