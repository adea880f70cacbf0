#include "webots_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base_nodes.h"
#include "known_protos.h"
#include "model_reader.h"
#include "robot/mended_mass.h"
#include "robot/mended_numbers.h"

namespace spark::webots {

namespace {

/// From the axes of a file to those of the world, x to the east, y to the north and z up.
Mat3 up(const std::string& coordinates) {
  Mat3 out = Mat3::Identity();
  if (coordinates == "NUE") out << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  if (coordinates == "EUN") out << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return out;
}

/// A plane has no end, and cannot move.
void dropMovingPlanes(mjcf::Model& model, mjcf::Unsupported& unsupported) {
  std::vector<bool> moves(model.bodies.size());
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    mjcf::Body& b = model.bodies[i];
    moves[i] = !b.joints.empty() || moves[static_cast<std::size_t>(b.parent)];
    if (!moves[i]) continue;
    std::erase_if(b.geoms, [&](const mjcf::Geom& g) {
      const bool plane = g.shape.shape == engine::Shape::plane;
      if (plane) unsupported.add(g.from, "a Plane that moves is not supported");
      return plane;
    });
  }
}

/// One run over a file.
class Reader {
 public:
  Reader(const Document& document, Base base, const ReadMesh& readMesh, mjcf::Unsupported& unsupported)
      : document_(document), base_(base), r_{document, unsupported}, geometry_(r_, readMesh) {}
  World read();

 private:
  void readNode(const Node& node, const Frame& frame);
  void readWorldInfo(const Node& node);
  double readGravity(Fields& f);
  void readLight(const Node& node, const Frame& frame);
  void readSolid(const Node& node, const Frame& frame);
  mjcf::Model& addModel(const Node& node, const std::string& name);
  mjcf::Model& scenery(const Node& node);

  const Document& document_;
  const Base base_;
  Reading r_;
  GeometryReader geometry_;
  World world_;
  std::optional<std::size_t> scenery_;  ///< index of the model of shapes without a solid
  std::optional<mjcf::Option> gravity_;
};

World Reader::read() {
  const Frame root{0, {Vec3::Zero(), up(document_.coordinates())}};
  // Solids need what it says of their surfaces.
  const auto isInfo = [](const NodePtr& node) { return node->type == "WorldInfo"; };
  for (const NodePtr& node : document_.nodes())
    if (isInfo(node)) readNode(*node, root);
  for (const NodePtr& node : document_.nodes())
    if (!isInfo(node)) readNode(*node, root);
  if (world_.models.empty()) return std::move(world_);
  for (mjcf::Model& model : world_.models) {
    dropMovingPlanes(model, r_.unsupported);
    mjcf::mendNumbers(model, r_.unsupported);
    mjcf::weighLightBodies(model, "a solid", mjcf::kNextToNoMass, r_.unsupported);
    model.surfaces = geometry_.surfaces();
  }
  // The last one: the world is as before when another one cannot be built.
  if (gravity_) world_.models.back().options.push_back(*gravity_);
  return std::move(world_);
}

void Reader::readNode(const Node& node, const Frame& frame) {
  r_.visit(node);
  const std::string& type = node.type;
  if (isSolid(type)) return readSolid(node, frame);
  if (type == "WorldInfo") return readWorldInfo(node);
  if (isScenery(type)) return readScenery(node, r_);
  if (type == "DirectionalLight" || type == "PointLight" || type == "SpotLight") return readLight(node, frame);
  if (isGroup(type)) {
    Fields f(node, r_.unsupported);
    const Frame inside = frameIn(frame, f);
    for (const NodePtr& child : f.children("children")) readNode(*child, inside);
    f.finish();
  } else if (type == "Shape") {
    geometry_.shape(node, frame, scenery(node).bodies.front());
  } else if (isBaseNode(type)) {
    r_.ignore(node, fmt::format("a {} in the world is not supported", type));
  } else if (!isBackdrop(type)) {
    if (!isGround(type)) return readSolid(node, frame);  // which is empty
    mjcf::Model& model = scenery(node);
    readGround(node, frame, model.bodies.front(), r_);
  }
}

void Reader::readWorldInfo(const Node& node) {
  Fields f(node, r_.unsupported);
  // Of Webots' engine, its window and its random numbers.
  f.ignore({"title", "info", "window", "CFM", "ERP", "FPS", "optimalThreadCount", "physicsDisableTime",
            "physicsDisableLinearThreshold", "physicsDisableAngularThreshold", "inkEvaporation", "gpsCoordinateSystem",
            "gpsReference", "lineScale", "dragForceScale", "dragTorqueScale", "randomSeed"});
  const std::string system = f.text("coordinateSystem", "ENU");
  if (system != "ENU" && system != "NUE" && system != "EUN")
    f.wrong("coordinateSystem", fmt::format("expected \"ENU\", \"NUE\" or \"EUN\" for 'coordinateSystem', found "
                                            "\"{}\"; \"ENU\" is taken",
                                            system));
  const double gravity = readGravity(f);
  gravity_ = mjcf::Option{node.element(), "gravity", List{0.0, 0.0, -gravity}};
  if (f.has("basicTimeStep")) world_.basicTimeStep = f.number("basicTimeStep", 32);
  for (const NodePtr& pair : f.children("contactProperties"))
    if (pair->type == "ContactProperties")
      r_.materials.read(*pair, r_.unsupported);
    else
      r_.missing(*pair);
  r_.materials.solve(r_.unsupported);
  f.finish();
}

/// A vector, or since R2020b a number.
double Reader::readGravity(Fields& f) {
  const Field* const given = f.node().field("gravity");
  if (!given || given->value->numbers.size() != 3) return f.number("gravity", 9.81, 0);
  const Vec3 gravity = f.vector("gravity", Vec3::Zero());
  const Vec3 turned = up(document_.coordinates()) * gravity;
  if (std::hypot(turned.x(), turned.y()) > 1e-9 || turned.z() > 0)
    f.wrong("gravity", "expected a gravity that points down; its length is taken");
  return gravity.norm();
}

void Reader::readLight(const Node& node, const Frame& frame) {
  Fields f(node, r_.unsupported);
  f.ignore({"attenuation", "beamWidth", "cutOffAngle", "direction", "castShadows"});
  const bool on = f.flag("on", true);
  Light light;
  light.name = node.definition;
  const double intensity = std::clamp(f.number("intensity", 1), 0.0, 1.0);
  const double ambient = std::clamp(f.number("ambientIntensity", 0), 0.0, 1.0);
  const Vec3 color = f.vector("color", Vec3::Ones());
  for (int i = 0; i < 3; ++i) {
    light.diffuse[static_cast<std::size_t>(i)] = std::clamp(color[i] * intensity, 0.0, 1.0);
    light.ambient[static_cast<std::size_t>(i)] = std::clamp(color[i] * ambient, 0.0, 1.0);
  }
  if (node.type == "DirectionalLight") return f.finish();  // the sun, which viewers have
  light.location = frame.at({f.vector("location", Vec3::Zero()), Mat3::Identity()}).position;
  light.radius = f.number("radius", 100, 0);
  f.finish();
  if (on) world_.lights.push_back(std::move(light));
}

void Reader::readSolid(const Node& node, const Frame& frame) {
  const bool robot = isRobot(node.type);
  const std::string otherwise = !isBaseNode(node.type) ? node.type : robot ? "robot" : "solid";
  mjcf::Model& model = addModel(node, node.name().empty() ? otherwise : std::string(node.name()));
  model.selfCollides = robot && Fields(node, r_.unsupported).flag("selfCollision", false);
  std::optional<bool> free;
  if (robot && base_ != Base::byFile) free = base_ == Base::free;
  ModelReader(r_, geometry_, model).readTop(node, frame, free);
}

mjcf::Model& Reader::addModel(const Node& node, const std::string& name) {
  mjcf::Model& model = world_.models.emplace_back();
  model.name = name;
  model.bodies.emplace_back().from = node.element();
  return model;
}

mjcf::Model& Reader::scenery(const Node& node) {
  if (!scenery_) {
    scenery_ = world_.models.size();
    addModel(node, "scenery");
  }
  return world_.models[*scenery_];
}

}  // namespace

World readWorld(const Document& document, Base base, const ReadMesh& readMesh, mjcf::Unsupported& unsupported) {
  return Reader(document, base, readMesh, unsupported).read();
}

}  // namespace spark::webots
