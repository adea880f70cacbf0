#include "sensor_builder.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "spark/access.h"

namespace spark::mjcf {

namespace {
constexpr double kDegrees = 180 / kPi;
constexpr double kFarthest = 1000;  // m: of a rangefinder without a cutoff
}  // namespace

void SensorBuilder::build() {
  for (const Sensor& s : c_.model.sensors) c_.unsupported.attempt(s.from, [&] { make(s); });
  // A perceptor of a joint senses position and rate: that of the position has both.
  for (const char* const kind : {"jointpos", "jointvel"})
    for (const Sensor& s : c_.model.sensors)
      if (s.kind == kind) c_.unsupported.attempt(s.from, [&] { onJoint(s); });
}

void SensorBuilder::make(const Sensor& s) {
  if (!s.reference.empty())
    refuse(s, "relative to another frame (reftype) is not supported");
  else if (s.kind == "jointpos" || s.kind == "jointvel")
    return;
  else if (s.perceptor)
    s.objectType == "body" ? onColliders(s) : onFrame(s, s.perceptor);
  else if (s.kind == "gyro")
    onBody(s, "GyroRatePerceptor");
  else if (s.kind == "accelerometer")
    onBody(s, "Accelerometer");
  else if (s.kind == "rangefinder")
    onRay(s);
  else if (s.kind == "framepos")
    onFrame(s, "PositionPerceptor");
  else if (s.kind == "framequat")
    onFrame(s, "OrientationPerceptor");
  else
    refuse(s, "is not supported");
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
  const bool rate = s.kind == "jointvel";
  const double unit = joint->second.joint->kind == JointKind::slide ? 1 : kDegrees;
  if (known && rate) {
    for (const auto& child : parent.children())
      if (child->classObject()->name() == "JointPerceptor") return addMujocoNoise(s, "vx", unit, *child);
  }
  if (Leaf* const made = makePerceptor(s, parent, "JointPerceptor")) addMujocoNoise(s, rate ? "vx" : "ax", unit, *made);
}

/// The perceptor senses at the place and in the frame of the site.
void SensorBuilder::onBody(const Sensor& s, const char* className) {
  const auto site = c_.sites.find(s.object);
  if (site == c_.sites.end()) throw s.from.error(fmt::format("there is no site '{}'", s.object));
  const bool gyro = std::string_view(className) == "GyroRatePerceptor";
  if (Leaf* const made = makePerceptor(s, *site->second, className))
    addMujocoNoise(s, gyro ? "rt" : "a", gyro ? kDegrees : 1, *made);
}

/// A ray along the z axis of the site; the perceptor looks along y.
void SensorBuilder::onRay(const Sensor& s) {
  const auto site = c_.sites.find(s.object);
  if (site == c_.sites.end()) throw s.from.error(fmt::format("there is no site '{}'", s.object));
  if (!c_.has("DistancePerceptor")) return;
  Node*& turned = frames_[fmt::format("ray {}", s.object)];
  const Pose toZ{Vec3::Zero(), Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()).toRotationMatrix()};
  if (!turned) turned = &c_.transform(*site->second, c_.names.in(*site->second, s.object + "-ray", ""), toZ);
  Leaf* const made = makePerceptor(s, *turned, "DistancePerceptor");
  if (!made) return;
  setProperty(*made, "maxRange", s.cutoff > 0 ? s.cutoff : kFarthest);
  addMujocoNoise(s, "", 1, *made);
}

void SensorBuilder::onFrame(const Sensor& s, const char* className) {
  const auto frameSensor = [&](Node& parent) {
    if (Leaf* const made = makePerceptor(s, parent, className)) addMujocoNoise(s, "", 1, *made);
  };
  if (s.objectType == "site") {
    const auto site = c_.sites.find(s.object);
    if (site == c_.sites.end()) throw s.from.error(fmt::format("there is no site '{}'", s.object));
    return frameSensor(*site->second);
  }
  if (s.objectType == "geom") {
    const auto place = geomPlace(s.object);
    if (!place) return refuse(s, fmt::format("of the geom '{}', which has no place here, is not supported", s.object));
    return frameSensor(transformOf(s, *place, "geom"));
  }
  if (s.objectType == "camera") return refuse(s, "of a camera is not supported");
  const bool inertial = s.objectType == "body";
  Place place = bodyPlace(s);
  if (inertial && s.kind == "framequat" && c_.has(className))
    refuse(s, "has the rotation of the body's link: that of its inertial frame is not supported");
  else if (inertial)
    place.pose.position = place.body->body->mass.center;
  frameSensor(transformOf(s, place, place.pose.position.isZero(0) ? "link" : "center"));
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

Leaf* SensorBuilder::makePerceptor(const Sensor& s, Node& parent, const char* className) {
  if (!c_.has(className)) return nullptr;
  const std::string& name = s.name.empty() ? s.object : s.name;
  Leaf& perceptor = parent.create(className, c_.names.unprefixed(parent, name, "sensor"));
  const std::string message = c_.names.perceptor(name);
  if (message != perceptor.name()) setProperty(perceptor, "messageName", message);
  if (message != name)
    c_.unsupported.add(s.from, fmt::format("the sensor {} is called {} in messages", s.from.named(), message));
  try {
    for (const auto& [property, value] : s.settings) setProperty(perceptor, property, value);
    if (const auto joint = c_.joints.find(s.object); std::string_view(className) == "JointPerceptor")
      setProperty(perceptor, "reference", joint->second.joint->reference);
    addImperfections(s, perceptor);
    setRate(s, perceptor);
  } catch (const Error&) {
    parent.remove(perceptor);  // it is left out
    throw;
  }
  return &perceptor;
}

void SensorBuilder::addImperfections(const Sensor& s, Leaf& perceptor) {
  for (const Imperfection& x : s.imperfections) addModifiers(s, x, perceptor);
}

/// What the attributes `noise` and `cutoff` say; `unit`: that of the percept in MuJoCo's.
void SensorBuilder::addMujocoNoise(const Sensor& s, const char* field, double unit, Leaf& perceptor) {
  Imperfection x;
  x.field = field;
  if (s.noise > 0 && c_.model.flags.sensorNoise) x.sigma = unit * s.noise;
  if (s.noise > 0 && !c_.model.flags.sensorNoise)
    refuse(s, "has noise, which acts only with <flag sensornoise=\"enable\"/>, as in MuJoCo");
  if (s.cutoff > 0 && s.kind == "framequat")
    refuse(s, "has a cutoff, which means nothing for a rotation");
  else if (s.cutoff > 0 && s.kind != "rangefinder")
    x.least = -unit * s.cutoff, x.most = unit * s.cutoff;
  addModifiers(s, x, perceptor);
}

void SensorBuilder::addModifiers(const Sensor& s, const Imperfection& x, Leaf& perceptor) {
  const auto add = [&](const char* className, const char* name,
                       std::initializer_list<std::pair<const char*, double>> set) {
    if (std::all_of(set.begin(), set.end(), [](const auto& p) { return p.second == 0 || std::isinf(p.second); }))
      return;
    if (!provides(c_.top.kernel(), className))
      return refuse(s, fmt::format("is exact: {} is a class of the plugin modifiers, which is not there", className));
    Node& parent = *perceptor.asNode();
    Leaf& made = parent.create(className, c_.names.unprefixed(parent, name, ""));
    if (*x.field) setProperty(made, "field", x.field);
    if (!x.indices.empty()) setProperty(made, "indices", List(x.indices.begin(), x.indices.end()));
    for (const auto& [property, value] : set) setProperty(made, property, value);
  };
  add("Bias", "bias", {{"mean", x.bias}, {"sigma", x.biasSigma}});
  add("WhiteNoise", "noise", {{"sigma", x.sigma}, {"relative", x.relative}});
  add("Saturation", "range", {{"least", x.least}, {"most", x.most}});
  add("Quantization", "resolution", {{"step", x.step}});
}

/// A perceptor senses in every n-th cycle.
void SensorBuilder::setRate(const Sensor& s, Leaf& perceptor) {
  if (!(s.rate > 0)) return;
  const Leaf* const simulation = c_.top.kernel().root().find("/sys/server/simulation");
  const double cycle =
      simulation && simulation->classObject()->property("step") ? getProperty(*simulation, "step").toNumber() : 0;
  if (!(cycle > 0))
    return refuse(
        s, fmt::format("senses in each cycle, not at {:g} Hz: there is no simulation whose cycle is known", s.rate));
  const double interval = std::clamp(std::round(1 / (s.rate * cycle)), 1.0, 1e9);
  setProperty(perceptor, "interval", static_cast<std::int64_t>(interval));
  if (const double rate = 1 / (interval * cycle); std::abs(rate - s.rate) > 1e-3 * s.rate)
    refuse(s, fmt::format("senses at {:.4g} Hz, which cycles of {:g} s allow, not at {:g} Hz", rate, cycle, s.rate));
}

}  // namespace spark::mjcf
