#pragma once
/// \file
/// Makes the perceptors of an MJCF model's sensors.

#include "construction.h"

namespace spark::mjcf {

/// Makes perceptors, where there are such classes. Bodies, joints and sites must be there.
class SensorBuilder {
 public:
  explicit SensorBuilder(Construction& construction) : c_(construction) {}
  /// Throws Error with file:line:column.
  void build();

 private:
  void onJoint(const Sensor& s);
  void onBody(const Sensor& s, const char* className);
  void onFrame(const Sensor& s, const char* className);
  Node& frame(const Sensor& s);

  Construction& c_;
};

}  // namespace spark::mjcf
