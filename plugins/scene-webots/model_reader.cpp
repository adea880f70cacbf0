#include "model_reader.h"

#include <fmt/format.h>

#include <cmath>

#include "api/mass.h"
#include "base_nodes.h"
#include "device_reader.h"
#include "known_protos.h"
#include "mass_reader.h"

namespace spark::webots {

namespace {
std::string defaultName(const Node& solid) {
  if (!isBaseNode(solid.type)) return solid.type;  // of a PROTO that is not there
  return isRobot(solid.type) ? "robot" : "solid";
}

/// Frames of old files have x to the right, y up and z back; those of new ones x ahead, y to the left and z up.
Mat3 fromOldAxes() {
  Mat3 out;
  out << 0, -1, 0, 0, 0, 1, -1, 0, 0;
  return out;
}

/// The scale of what is in a solid: the same in all directions.
Vec3 uniformScale(const Frame& frame, Fields& f) {
  if (frame.isUniform()) return frame.scale;
  f.wrong("scale", fmt::format("expected one scale in all directions for a {}; its mean is taken", f.node().type));
  return frame.scale.cwiseSign() * std::cbrt(std::abs(frame.scale.prod()));
}
}  // namespace

void ModelReader::readTop(const Node& solid, const Frame& around, std::optional<bool> movesFreely) {
  const std::size_t index = addSolid(solid, around, nullptr);
  const bool free = movesFreely.value_or(Fields(solid, r_.unsupported).child("physics") != nullptr);
  if (!free || !isBaseNode(solid.type)) return;
  mjcf::Joint j;
  j.from = solid.element();
  j.kind = mjcf::JointKind::free;
  model_.bodies[index].joints.push_back(std::move(j));
}

void ModelReader::readChild(const Node& node, const Frame& frame) {
  r_.visit(node);
  if (isSolid(node.type) || !isBaseNode(node.type)) {
    addSolid(node, frame, nullptr);
  } else if (isGroup(node.type)) {
    Fields f(node, r_.unsupported);
    const Frame inside = frameIn(frame, f);
    for (const NodePtr& child : f.children("children")) readChild(*child, inside);
    f.finish();
  } else if (isJoint(node.type)) {
    addJoint(node, frame);
  } else if (node.type == "Shape") {
    geometry_.shape(node, frame, model_.bodies[frame.body]);
  } else if (node.type == "Slot") {
    Fields f(node, r_.unsupported);
    f.ignore({"type"});
    if (const Node* const end = f.child("endPoint")) readChild(*end, frame);
    f.finish();
  } else if (isScenery(node.type)) {
    readScenery(node, r_);
  } else {
    r_.ignore(node, fmt::format("a {} here is not supported", node.type));
  }
}

/// Also a node whose PROTO is not there: it is empty.
std::size_t ModelReader::addSolid(const Node& solid, const Frame& around, const Node* joint) {
  Fields f(solid, r_.unsupported);
  const bool missing = !isBaseNode(solid.type);
  if (missing) {
    r_.missing(solid);
    for (const Field& field : solid.fields) f.ignore({field.name.c_str()});
  }
  // What means nothing to a simulation.
  f.ignore({"model", "description", "locked", "radarCrossSection", "recognitionColors", "controller", "controllerArgs",
            "customData", "supervisor", "synchronization", "battery", "cpuConsumption", "selfCollision", "showWindow",
            "window", "remoteControl", "name", "scale"});
  ignoreDeviceFields(solid, f);
  f.text("name");  // as Node::name() has it
  const Frame frame = frameIn(around, f);
  if (model_.bodies.size() > mjcf::kMaxBodies)
    throw LimitError(fmt::format("{}: expected at most {} solids", solid.element().where(), mjcf::kMaxBodies));

  const std::size_t index = model_.bodies.size();
  mjcf::Body& body = model_.bodies.emplace_back();
  body.from = solid.element();
  // Solids below several others may have one name in Webots.
  body.name = names_.add(solid.name().empty() ? defaultName(solid) : std::string(solid.name()));
  body.parent = static_cast<int>(around.body);
  body.pose = frame.pose;
  body.hasInertial = true;
  const Frame inside{index, {}, missing ? Vec3(Vec3::Ones()) : uniformScale(frame, f)};
  if (joint) {
    const Pose local{f.vector("translation", Vec3::Zero()), f.rotation("rotation")};
    body.joints = joints_.read(*joint, around, local, body.name);
  }
  if (missing) return index;

  const Node* physics = f.child("physics");
  if (physics && physics->type != "Physics") {
    r_.missing(*physics);
    physics = nullptr;
  }
  if (const Node* const bounds = f.child("boundingObject"))
    geometry_.bounds(*bounds, inside, densityOf(physics, r_.unsupported), body);
  body.mass = massOf(physics, body, r_.unsupported);
  if (const double gear = joint ? gearMass(*joint, r_.unsupported) : 0; gear > 0)
    body.mass = physics::together(body.mass, {gear, body.joints.front().position, Mat3::Zero()});
  if (solid.type != "Solid" && !isRobot(solid.type)) addDevice(solid, inside);
  if (solid.type == "DifferentialWheels" || solid.type == "Supervisor")
    r_.ignore(solid, fmt::format("a {} is read as a Robot: its wheels have no motors", solid.type));
  const std::string material = f.text("contactMaterial", "default");
  for (mjcf::Geom& g : body.geoms) {
    g.contact.friction[0] = r_.materials.friction(material);
    g.contact.priority = r_.materials.rules(material) ? 1 : 0;
  }
  if (f.has("immersionProperties")) r_.ignore(solid, "immersionProperties are not supported");
  for (const char* const velocity : {"linearVelocity", "angularVelocity"})
    if (!f.vector(velocity, Vec3::Zero()).isZero())
      r_.ignore(solid, fmt::format("the field '{}' is not supported: solids begin at rest", velocity));
  for (const NodePtr& child : f.children("children")) readChild(*child, inside);
  f.finish();
  return index;
}

void ModelReader::addDevice(const Node& device, const Frame& frame) {
  std::vector<mjcf::Site>& sites = model_.bodies[frame.body].sites;
  const std::size_t before = sites.size();
  r_.leaveOut(device, "a device", [&] { readDevice(device, frame, model_, r_); });
  if (device.yUp && looksAhead(device.type))
    for (std::size_t i = before; i < sites.size(); ++i) sites[i].pose.rotation = fromOldAxes() * sites[i].pose.rotation;
}

void ModelReader::addJoint(const Node& joint, const Frame& frame) {
  Fields f(joint, r_.unsupported);
  f.ignore({"endPoint", "jointParameters", "jointParameters2", "jointParameters3", "device", "device2", "device3",
            "position", "position2", "position3"});
  if (joint.origin && joint.origin->type.ends_with("JointWithBacklash"))
    f.ignore({"backlash", "backlash2", "gearMass", "gearMass2", "outputSensor", "outputSensor2"});
  f.finish();
  const Node* const solid = joints_.endPoint(joint);
  if (!solid) return;
  r_.visit(*solid);
  addSolid(*solid, frame, &joint);
}

}  // namespace spark::webots
