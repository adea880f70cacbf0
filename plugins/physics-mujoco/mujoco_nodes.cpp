#include "mujoco_nodes.h"

#include <fmt/ranges.h>

#include <algorithm>

namespace spark {

void MujocoSurface::describe(Description<MujocoSurface>& d) {
  using S = MujocoSurface;
  using N = mujoco::SurfaceNumbers;
  engine::describeExtension(d, "What MuJoCo alone reads of the collider above it: its surface.");
  d.property("friction", &S::get<&N::friction>, &S::set<&N::friction>)
      .min(0)
      .doc("Factor of sliding friction; torsional and rolling friction [m].");
  d.property("condim", &S::get<&N::condim>, &S::setCondim).doc("Dimensions of a contact: 1, 3, 4 or 6.");
  d.property("priority", &S::get<&N::priority>, &S::set<&N::priority>)
      .doc("Of two surfaces that of higher priority counts; colliders without one have the lowest.");
  d.property("solref", &S::get<&N::solref>, &S::set<&N::solref>)
      .doc("Time constant [s] and damping ratio of contacts; or, negative, stiffness and damping.");
  d.property("solimp", &S::get<&N::solimp>, &S::set<&N::solimp>)
      .doc("Impedance of contacts: fractions from and to, width [m], midpoint, power.");
  d.property("margin", &S::get<&N::margin>, &S::set<&N::margin>).unit("m").doc("Distance at which contacts begin.");
  d.property("gap", &S::get<&N::gap>, &S::set<&N::gap>).unit("m").doc("Part of that distance without force.");
  d.property("solmix", &S::get<&N::solmix>, &S::set<&N::solmix>)
      .unit("1")
      .min(0)
      .doc("Weight of solref and solimp against those of the other surface.");
  d.property("ellipsoid", &S::get<&N::ellipsoid>, &S::set<&N::ellipsoid>)
      .unit("m")
      .doc("Half axes of the ellipsoid that a convex collider stands for; 0: none.");
  d.property("thickness", &S::get<&N::thickness>, &S::set<&N::thickness>)
      .unit("m")
      .range(1e-6, 1e6)
      .doc("Of a height field, below its lowest point.");
  d.property("ellipsoidDrag", &S::is<&N::ellipsoidDrag>, &S::setIs<&N::ellipsoidDrag>)
      .doc("A medium drags at the ellipsoid of the shape; otherwise at the box that has the inertia of the body.");
  d.property("dragCoefficients", &S::get<&N::dragCoefficients>, &S::set<&N::dragCoefficients>)
      .doc("Of that ellipsoid: blunt, slender and angular drag, Kutta and Magnus lift.");
}

void MujocoSurface::setCondim(std::int64_t n) {
  if (n != 1 && n != 3 && n != 4 && n != 6)
    throw Error(fmt::format("{}: expected 1, 3, 4 or 6 dimensions of a contact, found {}", path(), n));
  set<&mujoco::SurfaceNumbers::condim>(n);
}

void MujocoAxis::describe(Description<MujocoAxis>& d) {
  using A = MujocoAxis;
  using N = mujoco::AxisNumbers;
  engine::describeExtension(d, "What MuJoCo alone reads of an axis of the joint above it.");
  d.property("axis", &A::axis, &A::setAxis).range(0, 2).doc("Which axis of the joint.");
  const char *const solref = "Time constant [s] and damping ratio of {}.",
                    *const solimp = "Impedance of {}: fractions from and to, width [rad or m], midpoint, power.";
  const char *const stops = "the stops", *const friction = "dry friction and the motor";
  d.property("stopSolref", &A::get<&N::stopSolref>, &A::set<&N::stopSolref>)
      .doc(fmt::format(fmt::runtime(solref), stops));
  d.property("stopSolimp", &A::get<&N::stopSolimp>, &A::set<&N::stopSolimp>)
      .doc(fmt::format(fmt::runtime(solimp), stops));
  d.property("stopMargin", &A::get<&N::stopMargin>, &A::set<&N::stopMargin>)
      .unit("rad or m")
      .doc("Distance from a stop at which it begins to act.");
  d.property("frictionSolref", &A::get<&N::frictionSolref>, &A::set<&N::frictionSolref>)
      .doc(fmt::format(fmt::runtime(solref), friction));
  d.property("frictionSolimp", &A::get<&N::frictionSolimp>, &A::set<&N::frictionSolimp>)
      .doc(fmt::format(fmt::runtime(solimp), friction));
}

void MujocoOptions::describe(Description<MujocoOptions>& d) {
  using O = MujocoOptions;
  using N = mujoco::OptionNumbers;
  engine::describeExtension(d, "What MuJoCo alone reads of the world above it.");
  d.property("integrator", &O::name<&N::integrator, N::kIntegrators>, &O::setName<&N::integrator, N::kIntegrators>)
      .doc("Euler, implicit or RK4.");
  d.property("cone", &O::name<&N::cone, N::kCones>, &O::setName<&N::cone, N::kCones>)
      .doc("Friction cones, pyramidal or elliptic.");
  d.property("solver", &O::name<&N::solver, N::kSolvers>, &O::setName<&N::solver, N::kSolvers>)
      .doc("Newton, CG or PGS.");
  d.property("iterations", &O::get<&N::iterations>, &O::set<&N::iterations>)
      .range(1, 10000)
      .doc("Most iterations of the solver.");
  d.property("tolerance", &O::get<&N::tolerance>, &O::set<&N::tolerance>)
      .range(0, 1)
      .doc("Improvement at which the solver stops.");
  d.property("impratio", &O::get<&N::impratio>, &O::set<&N::impratio>)
      .range(1e-6, 1e6)
      .doc("Impedance of friction over that of the normal force.");
  d.property("density", &O::get<&N::density>, &O::set<&N::density>)
      .unit("kg/m^3")
      .min(0)
      .doc("Density of the medium, whose drag acts on all bodies.");
  d.property("viscosity", &O::get<&N::viscosity>, &O::set<&N::viscosity>)
      .unit("Pa s")
      .min(0)
      .doc("Viscosity of the medium.");
  d.property("noslipIterations", &O::get<&N::noslipIterations>, &O::set<&N::noslipIterations>)
      .range(0, 10000)
      .doc("Iterations of the solver that takes back slip; 0: none.");
  d.property("noslipTolerance", &O::get<&N::noslipTolerance>, &O::set<&N::noslipTolerance>)
      .range(0, 1)
      .doc("Improvement at which it stops.");
  d.property("mprIterations", &O::get<&N::mprIterations>, &O::set<&N::mprIterations>)
      .range(1, 10000)
      .doc("Most iterations of the collision of convex shapes.");
  d.property("mprTolerance", &O::get<&N::mprTolerance>, &O::set<&N::mprTolerance>)
      .range(0, 1)
      .doc("Improvement at which it stops.");
  d.property("refsafe", &O::is<&N::refsafe>, &O::setIs<&N::refsafe>)
      .doc("Time constants of constraints are at least two steps.");
  d.property("multiccd", &O::is<&N::multiccd>, &O::setIs<&N::multiccd>).doc("Convex shapes touch in several points.");
  d.property("allContacts", &O::is<&N::allContacts>, &O::setIs<&N::allContacts>)
      .doc("Contacts beyond contactsPerPair are solved, too, as in MuJoCo alone; they are not reported.");
  d.property("explicitLaws", &O::is<&N::explicitLaws>, &O::setIs<&N::explicitLaws>)
      .doc("Controllers and springs are explicit, as in MuJoCo alone, while a step of those is stable.");
  d.property("overrides", &O::is<&N::overrides>, &O::setIs<&N::overrides>)
      .doc("All contacts have the three numbers below in place of their own.");
  d.property("overrideMargin", &O::get<&N::overrideMargin>, &O::set<&N::overrideMargin>)
      .unit("m")
      .doc("Distance at which contacts begin.");
  d.property("overrideSolref", &O::get<&N::overrideSolref>, &O::set<&N::overrideSolref>)
      .doc("Time constant [s] and damping ratio of contacts.");
  d.property("overrideSolimp", &O::get<&N::overrideSolimp>, &O::set<&N::overrideSolimp>).doc("Impedance of contacts.");
  d.property("wind", &O::get<&N::wind>, &O::set<&N::wind>).unit("m/s").doc("Velocity of the medium, world frame.");
}

template <auto Member, auto& Names>
void MujocoOptions::setName(const std::string& name) {
  const auto found = std::find(Names.begin(), Names.end(), name);
  if (found == Names.end())
    throw Error(fmt::format("{}: expected {}, found '{}'", path(), fmt::join(Names, " or "), name));
  set<Member>(found - Names.begin());
}

}  // namespace spark
