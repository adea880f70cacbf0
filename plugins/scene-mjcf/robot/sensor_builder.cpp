#include "sensor_builder.h"

#include <fmt/format.h>

#include <algorithm>

#include "spark/access.h"

namespace spark::mjcf {

void SensorBuilder::build() {
  for (const Sensor& s : c_.model.sensors) {
    if (!s.reference.empty())
      refuse(s, "relative to another frame (reftype) is not supported");
    else if (s.kind == "jointpos" || s.kind == "jointvel")
      continue;
    else if (s.perceptor)
      s.objectType == "body" ? onColliders(s) : onFrame(s, s.perceptor);
    else if (s.kind == "gyro")
      onBody(s, "GyroRatePerceptor");
    else if (s.kind == "accelerometer")
      onBody(s, "Accelerometer");
    else if (s.kind == "framepos")
      onFrame(s, "PositionPerceptor");
    else if (s.kind == "framequat")
      onFrame(s, "OrientationPerceptor");
    else
      refuse(s, "is not supported");
  }
  // A perceptor of a joint senses position and rate: that of the position has both.
  for (const char* const kind : {"jointpos", "jointvel"})
    for (const Sensor& s : c_.model.sensors)
      if (s.kind == kind) onJoint(s);
}

void SensorBuilder::refuse(const Sensor& s, const std::string& why) {
  c_.unsupported.add(s.from, fmt::format("the sensor {} {}", s.from.named(), why));
}

void SensorBuilder::onJoint(const Sensor& s) {
  const auto joint = c_.joints.find(s.object);
  if (joint == c_.joints.end() && !c_.freeJoints.contains(s.object))
    throw s.from.error(fmt::format("there is no joint '{}'", s.object));
  if (joint == c_.joints.end() || joint->second.joint->kind == JointKind::ball)
    return refuse(s, "of a joint without a single coordinate is not supported");
  Node& parent = *joint->second.made->leaf().asNode();
  const bool known = std::any_of(parent.children().begin(), parent.children().end(),
                                 [](const auto& c) { return c->classObject()->name() == "JointPerceptor"; });
  if (known && s.kind == "jointvel") return;
  makePerceptor(s, parent, "JointPerceptor");
}

/// The perceptor senses in the frame of the body, not of the site.
void SensorBuilder::onBody(const Sensor& s, const char* className) {
  const auto site = c_.sites.find(s.object);
  if (site == c_.sites.end()) throw s.from.error(fmt::format("there is no site '{}'", s.object));
  Node& parent = *site->second->parent();
  if (&parent == &c_.top) return refuse(s, "of what does not move is not supported");
  const Pose pose = toPose(static_cast<Transform*>(site->second->requireAs(Transform::kInterface))->local());
  if (c_.has(className) && !pose.rotation.isIdentity(1e-6)) refuse(s, "ignores the rotation of its site");
  makePerceptor(s, parent, className);
}

void SensorBuilder::onFrame(const Sensor& s, const char* className) {
  if (s.objectType == "site") {
    const auto site = c_.sites.find(s.object);
    if (site == c_.sites.end()) throw s.from.error(fmt::format("there is no site '{}'", s.object));
    return makePerceptor(s, *site->second, className);
  }
  if (s.objectType == "geom") {
    const auto place = geomPlace(s.object);
    if (!place) return refuse(s, fmt::format("of the geom '{}', which has no place here, is not supported", s.object));
    return makePerceptor(s, transformOf(s, *place, "geom"), className);
  }
  if (s.objectType == "camera") return refuse(s, "of a camera is not supported");
  const bool inertial = s.objectType == "body";
  Place place = bodyPlace(s);
  if (inertial && s.kind == "framequat" && c_.has(className))
    refuse(s, "has the rotation of the body's link: that of its inertial frame is not supported");
  else if (inertial)
    place.pose.position = place.body->body->mass.center;
  makePerceptor(s, transformOf(s, place, place.pose.position.isZero(0) ? "link" : "center"), className);
}

/// Handlers feed the first such perceptor below their transform, which has all colliders of what moves as one body.
void SensorBuilder::onColliders(const Sensor& s) {
  PlacedBody& body = c_.bodies.find(s.object, s.from);
  if (body.colliders.empty()) return refuse(s, "has no shape that collides, which is not supported");
  Node& parent = c_.nodeOf(body);
  if (&parent == &c_.top) return refuse(s, "of what does not move is not supported");
  const bool known = std::any_of(parent.children().begin(), parent.children().end(),
                                 [&](const auto& c) { return c->classObject()->name() == s.perceptor; });
  if (known) return refuse(s, "beside another one of the same body is not supported");
  if (!c_.has(s.perceptor)) return;
  makePerceptor(s, parent, s.perceptor);
  for (Node* const collider : body.colliders) collider->create("PerceptorHandler", "bumper");
}

SensorBuilder::Place SensorBuilder::bodyPlace(const Sensor& s) { return {&c_.bodies.find(s.object, s.from), {}}; }

/// nullopt for a geom that was not read, such as a mesh that is only seen.
std::optional<SensorBuilder::Place> SensorBuilder::geomPlace(const std::string& name) {
  for (PlacedBody& b : c_.bodies)
    for (const Geom& g : b.body->geoms)
      if (g.name == name && !name.empty()) return Place{&b, g.pose};
  return std::nullopt;
}

Node& SensorBuilder::transformOf(const Sensor& s, const Place& place, const char* what) {
  Node*& made = frames_[fmt::format("{} {}", what, s.object)];
  if (made) return *made;
  Node& parent = c_.nodeOf(*place.body);
  const std::string name = c_.names.in(parent, fmt::format("{}-{}", s.object, what), "");
  made = &c_.transform(parent, name, c_.inNode(*place.body, place.pose));
  return *made;
}

void SensorBuilder::makePerceptor(const Sensor& s, Node& parent, const char* className) {
  if (!c_.has(className)) return;
  const std::string& name = s.name.empty() ? s.object : s.name;
  Leaf& perceptor = parent.create(className, c_.names.unprefixed(parent, name, "sensor"));
  const std::string message = c_.names.perceptor(name);
  if (message != perceptor.name()) setProperty(perceptor, "messageName", message);
  if (message != name)
    c_.unsupported.add(s.from, fmt::format("the sensor {} is called {} in messages", s.from.named(), message));
  for (const auto& [property, value] : s.settings) setProperty(perceptor, property, value);
  if (const auto joint = c_.joints.find(s.object); std::string_view(className) == "JointPerceptor")
    setProperty(perceptor, "reference", joint->second.joint->reference);
}

}  // namespace spark::mjcf
