#pragma once
/// \file
/// Sensors in the `gazebo` elements of a robot, as SDF describes them.

#include <set>
#include <string>

#include "elements.h"
#include "robot/model.h"

namespace spark::urdf {

/// Adds the sensors of `<gazebo reference="LINK"><sensor .../></gazebo>` to a model with all its bodies. A sensor is in
/// its link's frame, at its `pose`. One that cannot be read is named and left out.
class SensorReader {
 public:
  /// All must outlive this.
  SensorReader(mjcf::Model& model, Unsupported& unsupported) : model_(model), unsupported_(unsupported) {}
  /// Reads the sensors of one element `gazebo`.
  void read(const Element& gazebo);

 private:
  class Parts;
  void sensor(const Element& e, mjcf::Body& body);
  bool readKind(const std::string& type, Parts& parts);
  void imu(Parts& parts);
  void lidar(Parts& parts);
  void camera(Parts& parts, bool depth, const char* ending);
  void contact(Parts& parts);
  void sonar(Parts& parts);
  void gps(Parts& parts);
  mjcf::Sensor& add(const char* kind, const std::string& ending, const Mat3& turned, const char* className = nullptr);
  mjcf::Sensor& ahead(const char* className, const std::string& ending = "", double yaw = 0);
  void axes(Parts& parts, const char* tag, std::vector<mjcf::Imperfection>& out, const mjcf::Imperfection& all);
  mjcf::Imperfection noise(const Element& e, double unit, const char* field);

  mjcf::Model& model_;
  Unsupported& unsupported_;
  std::set<std::string, std::less<>> sites_;  ///< names
  // Of the sensor that is being read.
  Element from_;
  std::string name_, site_;  ///< site_ "": there is none yet
  mjcf::Body* body_ = nullptr;
  Pose pose_;
  double rate_ = 0;
};

}  // namespace spark::urdf
