#include "sensor_builder.h"

#include <fmt/format.h>

#include <algorithm>

namespace spark::mjcf {

void SensorBuilder::build() {
  for (const Sensor& s : c_.model.sensors)
    if (s.kind == "jointpos" || s.kind == "jointvel")
      onJoint(s);
    else if (s.kind == "gyro")
      onBody(s, "GyroRatePerceptor");
    else if (s.kind == "accelerometer")
      onBody(s, "Accelerometer");
    else if (s.kind == "framepos")
      onFrame(s, "PositionPerceptor");
    else if (s.kind == "framequat")
      onFrame(s, "OrientationPerceptor");
    else
      c_.leftOver.element(s.from);
}

/// One perceptor senses angle and rate.
void SensorBuilder::onJoint(const Sensor& s) {
  const auto joint = c_.joints.find(s.object);
  if (joint == c_.joints.end()) throw s.from.error(fmt::format("there is no joint '{}'", s.object));
  Node& parent = *joint->second.made->leaf().asNode();
  const bool known = std::any_of(parent.children().begin(), parent.children().end(),
                                 [](const auto& c) { return c->classObject()->name() == "JointPerceptor"; });
  if (!known && c_.has("JointPerceptor")) parent.create("JointPerceptor", s.name);
}

/// The perceptor senses in the frame of the body, not of the site.
void SensorBuilder::onBody(const Sensor& s, const char* className) {
  if (!c_.has(className)) return;
  Node& site = frame(s);
  if (!toPose(static_cast<Transform*>(site.requireAs(Transform::kInterface))->local()).rotation.isIdentity(1e-6))
    c_.leftOver.add(s.from, fmt::format("the rotation of the site of a <{}> is left out", s.kind));
  site.parent()->create(className, s.name);
}

void SensorBuilder::onFrame(const Sensor& s, const char* className) {
  if (!c_.has(className)) return;
  if (s.objectType == "body")
    c_.leftOver.add(s.from, fmt::format("the inertial frame of a body is left out; <{}> has the link's", s.kind));
  frame(s).create(className, s.name);
}

/// The transform of the site or the link that a sensor names.
Node& SensorBuilder::frame(const Sensor& s) {
  if (const auto site = c_.sites.find(s.object); site != c_.sites.end()) return *site->second;
  const PlacedBody& b = c_.bodies.find(s.object, s.from);
  if (b.carrier == 0) throw s.from.error(fmt::format("the body '{}' does not move", s.object));
  Node& made = c_.transform(c_.nodeOf(b), c_.names.name(s.object + "-link", ""), c_.inNode(b, Pose{}));
  c_.sites.emplace(s.object, &made);
  return made;
}

}  // namespace spark::mjcf
