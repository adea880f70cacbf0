#pragma once
/// \file
/// Reads Webots worlds into the models that scene-mjcf builds nodes of.

#include "document.h"
#include "geometry_reader.h"
#include "robot/model.h"

namespace spark::webots {

/// How robots stand in the world.
enum class Base {
  byFile,  ///< those with a Physics move freely
  fixed,
  free
};

/// A light at a place in the frame of the file. Colours: red, green, blue, each 0 to 1.
struct Light {
  std::string name;
  Vec3 location = Vec3::Zero();
  std::array<double, 3> diffuse{1, 1, 1}, ambient{0, 0, 0};
  double radius = 100;  ///< m
};

/// What a file has.
struct World {
  std::vector<mjcf::Model> models;  ///< one for each solid that is in no other one, and for shapes without a solid
  std::vector<Light> lights;
  std::optional<double> basicTimeStep;  ///< ms; the file says so
};

/// Reads a world, or what a PROTO file has. What it does not take is named in `unsupported`. Throws Error with
/// file:line:column. `document` must outlive the models.
World readWorld(const Document& document, Base base, const ReadMesh& readMesh, mjcf::Unsupported& unsupported);

}  // namespace spark::webots
