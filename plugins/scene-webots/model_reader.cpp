#include "model_reader.h"

#include <fmt/format.h>

#include "base_nodes.h"
#include "device_reader.h"
#include "mass_reader.h"

namespace spark::webots {

namespace {
const char* defaultName(const Node& solid) { return solid.type == "Robot" ? "robot" : "solid"; }
}  // namespace

void ModelReader::readTop(const Node& solid, const Frame& around, std::optional<bool> movesFreely) {
  const std::size_t index = addSolid(solid, around, nullptr);
  const bool free = movesFreely.value_or(Fields(solid, r_.unsupported).child("physics") != nullptr);
  if (!free) return;
  mjcf::Joint j;
  j.from = solid.element();
  j.kind = mjcf::JointKind::free;
  model_.bodies[index].joints.push_back(std::move(j));
}

void ModelReader::readChild(const Node& node, const Frame& frame) {
  r_.visit(node);
  if (isSolid(node.type)) {
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
    if (const Node* const end = Fields(node, r_.unsupported).child("endPoint")) readChild(*end, frame);
  } else if (node.type == "CadShape") {
    // Viewers do not have it.
  } else if (isBaseNode(node.type)) {
    r_.ignore(node, fmt::format("a {} here is not supported", node.type));
  } else {
    throw r_.missing(node);
  }
}

std::size_t ModelReader::addSolid(const Node& solid, const Frame& around, const Node* joint) {
  Fields f(solid, r_.unsupported);
  // What means nothing to a simulation, or is the state of one that ran.
  f.ignore({"model", "description", "locked", "radarCrossSection", "recognitionColors", "linearVelocity",
            "angularVelocity", "controller", "controllerArgs", "customData", "supervisor", "synchronization", "battery",
            "cpuConsumption", "selfCollision", "showWindow", "window", "remoteControl", "name"});
  ignoreDeviceFields(solid, f);
  f.text("name");  // as Node::name() has it
  const Frame frame = frameIn(around, f);
  if (!frame.isUniform())
    throw f.error("scale", fmt::format("expected one scale in all directions for a {}", solid.type));
  if (model_.bodies.size() > mjcf::kMaxBodies)
    throw solid.element().error(fmt::format("expected at most {} solids", mjcf::kMaxBodies));

  const std::size_t index = model_.bodies.size();
  mjcf::Body& body = model_.bodies.emplace_back();
  body.from = solid.element();
  // Solids below several others may have one name in Webots.
  body.name = names_.add(std::string(solid.name().empty() ? defaultName(solid) : solid.name()));
  body.parent = static_cast<int>(around.body);
  body.pose = frame.pose;
  body.hasInertial = true;
  const Frame inside{index, {}, frame.scale};

  const Node* const physics = f.child("physics");
  if (physics && physics->type != "Physics") throw r_.missing(*physics);
  if (const Node* const bounds = f.child("boundingObject"))
    geometry_.bounds(*bounds, inside, densityOf(physics, r_.unsupported), body);
  body.mass = massOf(physics, body, r_.unsupported);
  if (joint) {
    const Pose local{f.vector("translation", Vec3::Zero()), f.rotation("rotation")};
    body.joints = joints_.read(*joint, around, local, body.name);
  }
  if (solid.type != "Solid" && solid.type != "Robot") readDevice(solid, inside, model_, r_);
  if (f.has("contactMaterial") && f.text("contactMaterial") != "default")
    r_.ignore(solid, "a contactMaterial is not supported: friction is 1");
  if (f.has("immersionProperties")) r_.ignore(solid, "immersionProperties are not supported");
  for (const NodePtr& child : f.children("children")) readChild(*child, inside);
  f.finish();
  return index;
}

void ModelReader::addJoint(const Node& joint, const Frame& frame) {
  Fields f(joint, r_.unsupported);
  f.ignore({"endPoint", "jointParameters", "jointParameters2", "jointParameters3", "device", "device2", "device3",
            "position", "position2", "position3"});
  f.finish();
  const Node* const solid = joints_.endPoint(joint);
  if (!solid) return;
  if (!frame.isUniform())
    throw joint.element().error(fmt::format("expected one scale in all directions for a {}", joint.type));
  r_.visit(*solid);
  addSolid(*solid, frame, &joint);
}

}  // namespace spark::webots
