#include "mujoco_actuators.h"

#include <fmt/ranges.h>

#include <algorithm>

namespace spark {

using mujoco::ActuatorNumbers;
using mujoco::FreedomNumbers;
using mujoco::PairNumbers;

// ---- actuators ----

void MujocoActuator::describe(Description<MujocoActuator>& d) {
  using A = MujocoActuator;
  using N = ActuatorNumbers;
  engine::describeExtension(d,
                            "An actuator of MuJoCo that no controller of a joint can be: on a tendon, at a point, with "
                            "dynamics, or a muscle.");
  d.implements<IActuator>();
  d.property("type", &A::name<&N::type, N::kTypes>, &A::setName<&N::type, N::kTypes>)
      .doc("What it drives: joint, jointinparent, slidercrank, tendon, site or body (adhesion).");
  d.property("target", &A::target, &A::setTarget)
      .doc("Path of the joint or the MujocoTendon; of the body, also of a site or a crank; \"\": the world.");
  d.property("reference", &A::reference, &A::setReference)
      .doc("Path of the body with the slider, or with the frame of reference of a site; \"\": the world.");
  d.property("hasReference", &A::hasReference, &A::setHasReference).doc("The reference counts.");
  d.property("part", &A::get<&N::part>, &A::set<&N::part>)
      .min(0)
      .doc("Of a body: which part it holds, in the order of RigidBody.addPart.");
  const char* const frame = ", in the frame of its link or of the world";
  d.property("point", &A::get<&N::point>, &A::set<&N::point>)
      .unit("m")
      .doc(fmt::format("The site, or the crank's joint{}.", frame));
  d.property("rotation", &A::get<&N::rotation>, &A::set<&N::rotation>)
      .doc(fmt::format("Rotation of the site, w x y z{}.", frame));
  d.property("point2", &A::get<&N::point2>, &A::set<&N::point2>)
      .unit("m")
      .doc(fmt::format("The slider, or the site of reference{}.", frame));
  d.property("rotation2", &A::get<&N::rotation2>, &A::set<&N::rotation2>)
      .doc(fmt::format("Its rotation, w x y z{}.", frame));
  d.property("gear", &A::get<&N::gear>, &A::set<&N::gear>).doc("Force and torque for an actuator force of 1.");
  d.property("crankLength", &A::get<&N::crankLength>, &A::set<&N::crankLength>)
      .unit("m")
      .min(0)
      .doc("Length of the rod between crank and slider.");
  d.property("dynamics", &A::name<&N::dynamics, N::kDynamics>, &A::setName<&N::dynamics, N::kDynamics>)
      .doc("How its activation follows the control: none, integrator, filter or muscle.");
  d.property("gain", &A::name<&N::gain, N::kGains>, &A::setName<&N::gain, N::kGains>).doc("fixed, affine or muscle.");
  d.property("bias", &A::name<&N::bias, N::kBiases>, &A::setName<&N::bias, N::kBiases>).doc("none, affine or muscle.");
  d.property("dynamicsNumbers", &A::get<&N::dynamicsNumbers>, &A::set<&N::dynamicsNumbers>)
      .doc("MuJoCo's dynprm, such as time constants [s].");
  d.property("gainNumbers", &A::get<&N::gainNumbers>, &A::set<&N::gainNumbers>).doc("MuJoCo's gainprm.");
  d.property("biasNumbers", &A::get<&N::biasNumbers>, &A::set<&N::biasNumbers>).doc("MuJoCo's biasprm.");
  d.property("controlRange", &A::get<&N::controlRange>, &A::set<&N::controlRange>)
      .doc("Range of the control; of this and the others two equal numbers mean none.");
  d.property("forceRange", &A::get<&N::forceRange>, &A::set<&N::forceRange>).unit("N or Nm").doc("Of the force.");
  d.property("activationRange", &A::get<&N::activationRange>, &A::set<&N::activationRange>).doc("Of the activation.");
  d.property("lengthRange", &A::get<&N::lengthRange>, &A::set<&N::lengthRange>)
      .doc("Lengths of a muscle; none: MuJoCo finds them.");
  d.property("control", &A::control, &A::setControl).unit("1").state().doc("The control.");
}

template <auto Member, auto& Names>
void MujocoActuator::setName(const std::string& name) {
  const auto found = std::find(Names.begin(), Names.end(), name);
  if (found == Names.end())
    throw Error(fmt::format("{}: expected {}, found '{}'", path(), fmt::join(Names, " or "), name));
  set<Member>(found - Names.begin());
  resolve();
}

void MujocoActuator::setControl(double u) {
  control_ = u;
  if (world_) world_->setInput(engine::Block::kindOf<ActuatorNumbers>(number()), u);
}

void MujocoActuator::resolve() {
  if (!parent()) return;
  const std::string_view type = ActuatorNumbers::kTypes[static_cast<std::size_t>(numbers().type)];
  std::uint64_t target = 0;
  bool free = false;
  if (type == "tendon") {
    const Leaf* const tendon = find(target_);
    if (tendon && tendon->classObject()->name() == "MujocoTendon")
      target = static_cast<std::uint64_t>(mujoco::constraintNumber(*tendon)) + 1;
  } else {
    const bool joint = type == "joint" || type == "jointinparent";
    target = mujoco::identityAt(*this, target_, joint);
    if (joint && target == 0) target = mujoco::identityAt(*this, target_, false), free = target != 0;
  }
  const bool world = target_.empty() && (type == "site" || type == "slidercrank" || type == "body");
  const std::uint64_t reference = reference_.empty() ? 0 : mujoco::identityAt(*this, reference_, false);
  set<&ActuatorNumbers::target>(target);
  set<&ActuatorNumbers::ofFreeBody>(free);
  set<&ActuatorNumbers::reference>(reference);
  set<&ActuatorNumbers::lacks>((target == 0 && !world ? 1 : 0) + (reference == 0 && !reference_.empty() ? 2 : 0));
}

void MujocoActuator::onLink() {
  resolve();
  world_ = engine::extendedWorldAround(*this);
  MujocoConstraint::onLink();
  setControl(control_);
}

void MujocoActuator::onUnlink() {
  world_ = nullptr;
  MujocoConstraint::onUnlink();
}

// ---- pairs ----

void MujocoPair::describe(Description<MujocoPair>& d) {
  using P = MujocoPair;
  using N = PairNumbers;
  engine::describeExtension(d, "A pair of colliders that touch in MuJoCo with a surface of its own.");
  d.property("first", &P::first, &P::setFirst).doc("Path of the first collider.");
  d.property("second", &P::second, &P::setSecond).doc("Path of the second collider.");
  d.property("condim", &P::get<&N::condim>, &P::set<&N::condim>).doc("Dimensions of a contact: 1, 3, 4 or 6.");
  d.property("friction", &P::get<&N::friction>, &P::set<&N::friction>)
      .doc("Factors of sliding friction along two directions; torsional and twice rolling friction [m].");
  d.property("solref", &P::get<&N::solref>, &P::set<&N::solref>).doc("Time constant [s] and damping ratio.");
  d.property("solimp", &P::get<&N::solimp>, &P::set<&N::solimp>)
      .doc("Impedance: fractions from and to, width [m], midpoint, power.");
  d.property("margin", &P::get<&N::margin>, &P::set<&N::margin>).unit("m").doc("Distance at which contacts begin.");
  d.property("gap", &P::get<&N::gap>, &P::set<&N::gap>).unit("m").doc("Part of that distance without force.");
}

void MujocoPair::resolve() {
  if (!parent()) return;
  const auto id = [this](const std::string& path) {
    const Leaf* const found = path.empty() ? nullptr : find(path);
    const auto collider = found ? found->as<ICollider>() : Found<ICollider>();
    return collider ? collider->identity() : 0;
  };
  set<&PairNumbers::first>(id(paths_[0]));
  set<&PairNumbers::second>(id(paths_[1]));
}

void MujocoPair::onLink() {
  resolve();
  MujocoConstraint::onLink();
}

// ---- balls and free bodies ----

void MujocoFreedom::describe(Description<MujocoFreedom>& d) {
  using F = MujocoFreedom;
  using N = FreedomNumbers;
  engine::describeExtension(d, "What a ball, or a free body, has in MuJoCo beside its coordinates.");
  d.property("of", &F::of, &F::setOf).doc("Path of the ball, or of the free body.");
  d.property("armature", &F::get<&N::armature>, &F::set<&N::armature>)
      .unit("kg or kg m^2")
      .min(0)
      .doc("Inertia that each of its coordinates has besides.");
  d.property("frictionLoss", &F::get<&N::frictionLoss>, &F::set<&N::frictionLoss>)
      .unit("N or Nm")
      .min(0)
      .doc("Largest force of dry friction along each of its coordinates.");
  d.property("stiffness", &F::get<&N::stiffness>, &F::set<&N::stiffness>)
      .unit("N/m or Nm/rad")
      .min(0)
      .doc("Of the spring that brings it to its place at rest.");
  d.property("restRotation", &F::get<&N::restRotation>, &F::set<&N::restRotation>)
      .doc("Rotation at rest, w x y z: of a ball's body in the one above, of a free body in the world.");
  d.property("restPosition", &F::get<&N::restPosition>, &F::set<&N::restPosition>)
      .unit("m")
      .doc("Position of a free body's link at rest, world frame.");
  d.property("mostAngle", &F::get<&N::mostAngle>, &F::set<&N::mostAngle>)
      .unit("rad")
      .min(0)
      .doc("Largest rotation of a ball from there; 0: any.");
  d.property("stopSolref", &F::get<&N::stopSolref>, &F::set<&N::stopSolref>).doc("As in a MujocoAxis.");
  d.property("stopSolimp", &F::get<&N::stopSolimp>, &F::set<&N::stopSolimp>).doc("As in a MujocoAxis.");
  d.property("stopMargin", &F::get<&N::stopMargin>, &F::set<&N::stopMargin>)
      .unit("rad")
      .doc("Angle before the limit at which it begins to act.");
  d.property("frictionSolref", &F::get<&N::frictionSolref>, &F::set<&N::frictionSolref>).doc("As in a MujocoAxis.");
  d.property("frictionSolimp", &F::get<&N::frictionSolimp>, &F::set<&N::frictionSolimp>).doc("As in a MujocoAxis.");
}

void MujocoFreedom::resolve() {
  if (!parent()) return;
  const std::uint64_t joint = mujoco::identityAt(*this, path_, true);
  set<&FreedomNumbers::of>(joint != 0 ? joint : mujoco::identityAt(*this, path_, false));
  set<&FreedomNumbers::ofBody>(joint == 0);
}

void MujocoFreedom::onLink() {
  resolve();
  MujocoConstraint::onLink();
}

}  // namespace spark
