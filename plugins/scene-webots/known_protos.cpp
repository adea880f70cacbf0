#include "known_protos.h"

#include <fmt/format.h>

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
  if (size && size->size() != 2) throw f.error("floorSize", "expected 2 numbers for 'floorSize'");
  const double x = size ? (*size)[0] : 1, y = size ? (*size)[1] : 1;
  const double height = f.number("wallHeight", 0.1, 0), thickness = f.number("wallThickness", 0.01, 0);
  if (!(x > 0) || !(y > 0)) throw f.error("floorSize", "expected lengths above 0 for 'floorSize'");
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

void readGround(const Node& node, const Frame& around, mjcf::Body& body, Reading& reading) {
  Fields f(node, reading.unsupported);
  const Frame frame = frameIn(around, f);
  engine::ShapeDescription plane;
  plane.shape = engine::Shape::plane;
  body.geoms.push_back(geomOf(node, plane, frame.pose));
  if (node.type == "RectangleArena") addWalls(f, frame, body);
  if (node.type == "CircleArena") reading.ignore(node, "a CircleArena has no wall");
}

}  // namespace spark::webots
