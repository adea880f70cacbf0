#pragma once
/// \file
/// Makes the perceptors of an MJCF model's sensors.

#include "construction.h"

namespace spark::mjcf {

/// Makes perceptors, with modifiers for their noise, ranges and resolutions, where there are such classes. Bodies,
/// joints and sites must be there.
class SensorBuilder {
 public:
  explicit SensorBuilder(Construction& construction) : c_(construction) {}
  /// A sensor of what is not there is left out, and named.
  void build();

 private:
  /// Where a sensor is: a pose in a body of the file.
  struct Place {
    PlacedBody* body;
    Pose pose;
  };
  void make(const Sensor& s);
  void onJoint(const Sensor& s);
  void onBody(const Sensor& s, const char* className);
  void onRay(const Sensor& s);
  void onFrame(const Sensor& s, const char* className);
  void onColliders(const Sensor& s);
  Place bodyPlace(const Sensor& s);
  std::optional<Place> geomPlace(const std::string& name);
  Node& transformOf(const Sensor& s, const Place& place, const char* what);
  Leaf* makePerceptor(const Sensor& s, Node& parent, const char* className);
  void addImperfections(const Sensor& s, Leaf& perceptor);
  void addMujocoNoise(const Sensor& s, const char* field, double unit, Leaf& perceptor);
  void addModifiers(const Sensor& s, const Imperfection& x, Leaf& perceptor);
  void setRate(const Sensor& s, Leaf& perceptor);
  void refuse(const Sensor& s, const std::string& why);

  Construction& c_;
  std::map<std::string, Node*, std::less<>> frames_;  ///< transforms made for sensors, by kind and name of the object
};

}  // namespace spark::mjcf
