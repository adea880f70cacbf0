#include "known_protos.h"

#include <fmt/format.h>

#include "base_nodes.h"

namespace spark::webots {

namespace {

mjcf::Geom geomOf(const Node& node, const engine::ShapeDescription& shape, const Pose& pose) {
  mjcf::Geom g;
  g.from = node.element();
  g.shape = shape;
  g.pose = pose;
  return g;
}

/// The walls stand around the floor.
void addWalls(Fields& f, const Frame& frame, mjcf::Body& body) {
  const std::vector<double>* const size = f.numbers("floorSize");
  const bool given = size && size->size() == 2;
  if (size && !given) f.wrong("floorSize", "expected 2 numbers for 'floorSize'; 1 1 is taken");
  const double x = given ? (*size)[0] : 1, y = given ? (*size)[1] : 1;
  const double height = f.number("wallHeight", 0.1, 0), thickness = f.number("wallThickness", 0.01, 0);
  if (!(x > 0) || !(y > 0)) return f.wrong("floorSize", "expected lengths above 0 for 'floorSize'; there are no walls");
  if (height == 0 || thickness == 0) return;
  for (const double side : {-1.0, 1.0}) {
    engine::ShapeDescription wall;
    wall.lengths = {x + 2 * thickness, thickness, height};
    body.geoms.push_back(
        geomOf(f.node(), wall, frame.at({{0, side * (y + thickness) / 2, height / 2}, Mat3::Identity()})));
    wall.lengths = {thickness, y, height};
    body.geoms.push_back(
        geomOf(f.node(), wall, frame.at({{side * (x + thickness) / 2, 0, height / 2}, Mat3::Identity()})));
  }
}

}  // namespace

bool isBackdrop(std::string_view type) { return type == "TexturedBackground" || type == "TexturedBackgroundLight"; }
bool isGround(std::string_view type) { return type == "Floor" || type == "RectangleArena" || type == "CircleArena"; }

// What collides, and the fields with their defaults, which are those of Webots (its user guide, "Objects").
const char* knownProto(const Node& node) {
  if (node.yUp) return nullptr;  // their sides had another order
  if (node.type == "SolidBox")
    return R"(#VRML_SIM R2023b utf8
PROTO SolidBox [ field SFVec3f translation 0 0 0 field SFRotation rotation 0 0 1 0 field SFString name "box"
  field SFVec3f size 2 2 2 field SFString contactMaterial "default" field SFNode appearance NULL
  field SFNode physics NULL field SFBool castShadows TRUE ] {
  Solid { translation IS translation rotation IS rotation name IS name contactMaterial IS contactMaterial
    children Shape { appearance IS appearance geometry DEF BOX Box { size IS size } castShadows IS castShadows }
    boundingObject USE BOX physics IS physics } })";
  if (node.type == "WoodenBox" || node.type == "CardboardBox")
    return R"(#VRML_SIM R2023b utf8
# template language: javascript
PROTO WoodenBox [ field SFVec3f translation 0 0 0.3 field SFRotation rotation 0 0 1 0
  field SFString name "wooden box" field SFVec3f size 0.6 0.6 0.6 field SFFloat mass 0
  field MFNode immersionProperties [ ] field SFBool locked FALSE ] {
  Solid { translation IS translation rotation IS rotation name IS name immersionProperties IS immersionProperties
    children Shape { geometry DEF BOX Box { size IS size } } boundingObject USE BOX
    %< if (fields.mass.value > 0) { >% physics Physics { density -1 mass IS mass } %< } >% } })";
  if (node.type == "Wall" && node.field("size"))
    return R"(#VRML_SIM R2023b utf8
# template language: javascript
PROTO Wall [ field SFVec3f translation 0 0 0 field SFRotation rotation 0 0 1 0 field SFString name "wall"
  field SFVec3f size 1 1 1 field SFNode appearance NULL ] {
  Solid { translation IS translation rotation IS rotation name IS name
    boundingObject Pose { translation 0 0 %<= fields.size.value.z / 2 >% children Box { size IS size } } } })";
  return nullptr;
}

// Webots puts a gear between the two hinges of such a joint, of which the second one has some play. A gear of 4e-9 kg
// m^2 is nothing for a simulation with larger steps; its mass belongs to what it moves.
NodePtr jointWithoutBacklash(const Node& node, mjcf::Unsupported& unsupported) {
  const bool two = node.type == "Hinge2JointWithBacklash";
  if (!two && node.type != "HingeJointWithBacklash") return nullptr;
  auto out = std::make_shared<Node>(node);
  out->type = two ? "Hinge2Joint" : "HingeJoint";
  out->origin = std::make_shared<Node>(node);
  unsupported.add(node.element(),
                  fmt::format("a {} is a {} without play; its gears move with its endPoint", node.type, out->type));
  for (const char* const number : {"", "2"}) {
    const Field* const sensors = node.field(std::string("outputSensor") + number);
    if (!sensors || sensors->value->kind != Value::Kind::nodes) continue;
    const std::string name = std::string("device") + number;
    const Field* const devices = node.field(name);
    auto all =
        std::make_shared<Value>(devices && devices->value->kind == Value::Kind::nodes ? *devices->value : Value{});
    all->kind = Value::Kind::nodes;
    all->nodes.insert(all->nodes.end(), sensors->value->nodes.begin(), sensors->value->nodes.end());
    out->fields.push_back({name, sensors->offset, std::move(all)});
  }
  return out;
}

double gearMass(const Node& joint, mjcf::Unsupported& unsupported) {
  if (!joint.origin || !joint.origin->type.ends_with("JointWithBacklash")) return 0;
  const bool two = joint.type == "Hinge2Joint";
  Fields f(joint, unsupported);
  double out = 0;
  for (const auto& [play, mass] : {std::pair("backlash", "gearMass"), std::pair("backlash2", "gearMass2")}) {
    if (play == std::string_view("backlash2") && !two) break;
    if (f.number(play, 0.01) > 0) out += f.number(mass, two ? 0.1 : 0.01, 0);
  }
  return out;
}

void readScenery(const Node& node, Reading& reading) {
  Fields f(node, reading.unsupported);
  if (node.type == "Viewpoint")
    f.ignore({"fieldOfView", "orientation", "position", "near", "far", "exposure", "bloomThreshold", "zNear", "zFar",
              "follow", "followType", "followOrientation", "followSmoothness", "lensFlare", "description",
              "ambientOcclusionRadius"});
  if (node.type == "Background")
    f.ignore({"skyColor", "luminosity", "frontUrl", "backUrl", "leftUrl", "rightUrl", "topUrl", "bottomUrl",
              "frontIrradianceUrl", "backIrradianceUrl", "leftIrradianceUrl", "rightIrradianceUrl", "topIrradianceUrl",
              "bottomIrradianceUrl"});
  if (node.type == "Fog") f.ignore({"color", "fogType", "visibilityRange"});
  f.finish();
}

void readGround(const Node& node, const Frame& around, mjcf::Body& body, Reading& reading) {
  Fields f(node, reading.unsupported);
  // What is drawn, and how rough it is.
  f.ignore({"name", "contactMaterial", "size", "tileSize", "appearance", "floorTileSize", "floorAppearance",
            "wallTileSize", "wallAppearance", "radius", "subdivision", "scale", "ratio", "metalness", "roughness"});
  const Frame frame = standing(node, frameIn(around, f));
  engine::ShapeDescription plane;
  plane.shape = engine::Shape::plane;
  body.geoms.push_back(geomOf(node, plane, frame.pose));
  if (node.type == "RectangleArena") addWalls(f, frame, body);
  if (node.type == "CircleArena") reading.ignore(node, "a CircleArena has no wall");
  f.finish();
}

}  // namespace spark::webots
