#include "joint_reader.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "base_nodes.h"
#include "device_reader.h"

namespace spark::webots {

using mjcf::JointKind;

namespace {
constexpr std::array<double, 2> kAll{-HUGE_VAL, HUGE_VAL};

/// 0 for both means: no limit.
std::array<double, 2> rangeOf(Fields& f, const char* least, const char* most) {
  const std::array<double, 2> range{f.number(least, 0), f.number(most, 0)};
  if (range[0] > range[1]) {
    f.wrong(least, fmt::format("expected '{}' not above '{}', found {} and {}; they are ignored", least, most, range[0],
                               range[1]));
    return kAll;
  }
  return range[0] == 0 && range[1] == 0 ? kAll : range;
}

std::string orElse(std::string_view name, const char* otherwise) {
  return std::string(name.empty() ? otherwise : name);
}

}  // namespace

const Node* JointReader::endPoint(const Node& joint) {
  const Node* at = &joint;
  for (int depth = 0; depth < kMaxDepth; ++depth) {
    Fields f(*at, r_.unsupported);
    const Node* const next = f.child("endPoint");
    if (!next) {
      r_.ignore(joint, fmt::format("a {} without an endPoint is ignored", joint.type));
      return nullptr;
    }
    if (isSolid(next->type) || !isBaseNode(next->type)) return next;
    if (next->type == "SolidReference") {
      r_.ignore(*next, "a joint with a SolidReference, which closes a loop, is not supported: the loop is open");
      return nullptr;
    }
    if (next->type != "Slot") {
      r_.missing(*next);
      return nullptr;
    }
    at = next;
  }
  throw LimitError(fmt::format("{}: expected nodes Slot nested at most {} deep", joint.element().where(), kMaxDepth));
}

std::vector<mjcf::Joint> JointReader::read(const Node& node, const Frame& around, const Pose& solid,
                                           const std::string& solidName) {
  std::vector<Axis> axes;
  Vec3 anchor = Vec3::Zero();
  if (node.type == "BallJoint") {
    for (const char* const field : {"device", "device2", "device3"})
      if (Fields(node, r_.unsupported).has(field))
        r_.ignore(node, "motors and sensors of a BallJoint are not supported");
    axes.push_back({parameters(node, "jointParameters", JointKind::ball, Vec3::UnitZ(), anchor), {}});
  } else if (node.type == "SliderJoint") {
    axes.push_back(
        {parameters(node, "jointParameters", JointKind::slide, Vec3::UnitZ(), anchor), devices(node, "device")});
  } else {
    axes.push_back(
        {parameters(node, "jointParameters", JointKind::hinge, Vec3::UnitX(), anchor), devices(node, "device")});
    if (node.type == "Hinge2Joint") {
      Vec3 ignored;
      axes.push_back(
          {parameters(node, "jointParameters2", JointKind::hinge, Vec3::UnitZ(), ignored), devices(node, "device2")});
      // The first axis turns the second one; the file has both where the positions are 0, and the solid where they are.
      const mjcf::Joint& first = axes[0].joint;
      axes[1].joint.axis = Eigen::AngleAxisd(first.reference, first.axis) * axes[1].joint.axis;
    }
  }
  std::vector<mjcf::Joint> out;
  const Pose scaled = around.scaled(solid);
  const Mat3 toChild = scaled.rotation.transpose();
  // In a mirror an axis has another direction, and turns the other way.
  const Vec3 mirror = around.scale.cwiseSign();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    mjcf::Joint& j = axes[i].joint;
    j.axis = toChild * mirror.cwiseProduct(j.axis) * (j.kind == JointKind::hinge ? mirror.prod() : 1);
    j.position = toChild * (around.scale.cwiseProduct(anchor) - scaled.position);
    nameAndDrive(j, axes[i].devices, i == 0 ? solidName + "_joint" : fmt::format("{}_joint{}", solidName, i + 1));
    out.push_back(std::move(j));
  }
  return out;
}

mjcf::Joint JointReader::parameters(const Node& node, const char* field, JointKind kind, const Vec3& axis,
                                    Vec3& anchor) {
  mjcf::Joint j;
  j.from = node.element();
  j.kind = kind;
  j.axis = axis;
  Fields of(node, r_.unsupported);
  const Node* const given = of.child(field);
  if (!given) return j;
  if (!given->type.ends_with("JointParameters")) {
    r_.missing(*given);
    return j;
  }
  Fields f(*given, r_.unsupported);
  j.from = given->element();
  anchor = f.vector("anchor", Vec3::Zero());
  if (kind != JointKind::ball) {
    j.axis = f.vector("axis", given->type == "HingeJointParameters" ? Vec3(Vec3::UnitX()) : axis);
    if (!(j.axis.norm() > 1e-10) || !std::isfinite(j.axis.norm())) {
      f.wrong("axis", "expected an axis that is not 0; that of the default is taken");
      j.axis = axis;
    }
    j.axis.normalize();
    j.reference = f.number("position", 0);
    const std::array<double, 2> stops = rangeOf(f, "minStop", "maxStop");
    j.limited = stops != kAll;
    // Here a joint's coordinate is 0 in the pose of the file.
    if (j.limited) j.range = {stops[0] - j.reference, stops[1] - j.reference};
    j.stiffness = f.number("springConstant", 0, 0);
    j.springPosition = -j.reference;
    j.dryFriction = f.number("staticFriction", 0, 0);
  }
  j.damping = f.number("dampingConstant", 0, 0);
  f.finish();
  return j;
}

JointReader::Devices JointReader::devices(const Node& node, const char* field) {
  Devices out;
  for (const NodePtr& device : Fields(node, r_.unsupported).children(field)) {
    r_.visit(*device);
    if (device->type == "RotationalMotor" || device->type == "LinearMotor") {
      if (out.motor)
        r_.ignore(*device, fmt::format("expected one motor in '{}', found two; the first one is taken", field));
      else
        out.motor = device.get();
    } else if (device->type == "PositionSensor") {
      if (out.sensor)
        r_.ignore(*device,
                  fmt::format("expected one PositionSensor in '{}', found two; the first one is taken", field));
      else
        out.sensor = device.get();
    } else if (isBaseNode(device->type)) {
      r_.ignore(*device, fmt::format("a {} in a joint is not supported", device->type));
    } else {
      r_.missing(*device);
    }
  }
  return out;
}

/// A joint has no name in the file: it is called like its motor, its sensor, or the solid.
void JointReader::nameAndDrive(mjcf::Joint& j, const Devices& d, const std::string& otherwise) {
  j.name =
      names_.add(d.motor ? orElse(d.motor->name(), d.motor->type == "LinearMotor" ? "linear motor" : "rotational motor")
                 : d.sensor ? orElse(d.sensor->name(), "position sensor")
                            : otherwise);
  if (d.motor) drive(j, *d.motor);
  if (!d.sensor) return;
  model_.sensors.push_back(
      {d.sensor->element(), "jointpos", orElse(d.sensor->name(), "position sensor"), j.name, "joint", ""});
  readPositionSensor(*d.sensor, j.kind == mjcf::JointKind::slide, model_.sensors.back(), r_);
}

void JointReader::drive(mjcf::Joint& j, const Node& motor) {
  Fields f(motor, r_.unsupported);
  const bool linear = motor.type == "LinearMotor";
  if (linear != (j.kind == JointKind::slide))
    return r_.ignore(motor, fmt::format("expected a {} in this joint, found a {}, which is left out",
                                        linear ? "RotationalMotor" : "LinearMotor", motor.type));
  // What Webots' own controllers of motors need.
  f.ignore({"name", "consumptionFactor", "controlPID", "sound"});
  if (f.number("acceleration", -1) != -1) r_.ignore(motor, "the acceleration of a motor is not limited");
  if (f.number("multiplier", 1) != 1) r_.ignore(motor, "the multiplier of a motor is not supported");
  const double most = f.number(linear ? "maxForce" : "maxTorque", 10, 0), rate = f.number("maxVelocity", 10, 0);
  const std::array<double, 2> soft = rangeOf(f, "minPosition", "maxPosition");
  f.finish();
  if (most > 0) j.maxForce = most;
  mjcf::Actuator x;
  x.from = motor.element();
  x.joint = j.name;
  const auto add = [&](const char* ending, std::array<double, 3> gain, std::array<double, 2> range) {
    x.name = orElse(motor.name(), j.name.c_str()) + ending;
    x.gain = gain;
    x.controlRange = range;
    model_.actuators.push_back(x);
  };
  // Targets with gains that the agent chooses: limp until then.
  const std::array<double, 2> stops{j.range[0] + j.reference, j.range[1] + j.reference};
  add("_pos", {0, 0, 0}, soft != kAll ? soft : j.limited ? stops : kAll);
  add("_vel", {0, 0, 0}, {-rate, rate});
  add("_tau", {1, 0, 0}, {-most, most});
}

}  // namespace spark::webots
