#pragma once
/// \file
/// Reads one solid with all that hangs on it: a robot, or a thing.

#include "geometry_reader.h"
#include "joint_reader.h"

namespace spark::webots {

/// Reads the tree of one solid into a model.
class ModelReader {
 public:
  /// All must outlive the reader.
  ModelReader(Reading& reading, GeometryReader& geometry, mjcf::Model& model)
      : r_(reading), geometry_(geometry), model_(model), joints_(reading, model) {
    names_.add("world");  // what the builder calls the world
  }
  /// Adds a solid that is in no other one. `around`: a frame in the world. `movesFreely`: nullopt: if it has a Physics.
  /// Throws Error.
  void readTop(const Node& solid, const Frame& around, std::optional<bool> movesFreely);
  /// What is in a Group, a solid or the world itself. Throws Error.
  void readChild(const Node& node, const Frame& frame);

 private:
  std::size_t addSolid(const Node& solid, const Frame& around, const Node* joint);
  void addJoint(const Node& joint, const Frame& frame);
  void addDevice(const Node& device, const Frame& frame);

  Reading& r_;
  GeometryReader& geometry_;
  mjcf::Model& model_;
  JointReader joints_;
  UniqueNames names_;
};

}  // namespace spark::webots
