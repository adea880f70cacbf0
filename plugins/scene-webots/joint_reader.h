#pragma once
/// \file
/// Reads joints, with their motors and position sensors.

#include <map>

#include "reading.h"

namespace spark::webots {

/// Reads the joints of one model.
class JointReader {
 public:
  /// Both must outlive the reader.
  JointReader(Reading& reading, mjcf::Model& model) : r_(reading), model_(model) {}
  /// The solid that a joint holds; nullptr where it holds none, which is named. Throws Error.
  const Node* endPoint(const Node& joint);
  /// The joints of a body, of which `joint` holds the solid, and what drives and senses them. `around`: the frame of
  /// the joint; `solid`: the pose of the solid in it. Throws Error.
  std::vector<mjcf::Joint> read(const Node& joint, const Frame& around, const Pose& solid,
                                const std::string& solidName);

 private:
  /// What a device field of a joint has.
  struct Devices {
    const Node *motor = nullptr, *sensor = nullptr;
  };
  struct Axis {
    mjcf::Joint joint;
    Devices devices;
  };
  Devices devices(const Node& joint, const char* field);
  mjcf::Joint parameters(const Node& joint, const char* field, mjcf::JointKind kind, const Vec3& axis, Vec3& anchor);
  void nameAndDrive(mjcf::Joint& joint, const Devices& devices, const std::string& otherwise);
  void drive(mjcf::Joint& joint, const Node& motor);

  Reading& r_;
  mjcf::Model& model_;
  UniqueNames names_;
};

}  // namespace spark::webots
