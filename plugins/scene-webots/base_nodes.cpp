#include "base_nodes.h"

#include <algorithm>
#include <array>

namespace spark::webots {

namespace {

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& types, std::string_view type) {
  return std::find(types.begin(), types.end(), type) != types.end();
}

// Webots' documentation, "Nodes and API functions".
constexpr std::array<std::string_view, 27> kSolids = {"Supervisor",    "DifferentialWheels",
                                                      "Solid",         "Robot",
                                                      "Accelerometer", "Altimeter",
                                                      "Camera",        "Charger",
                                                      "Compass",       "Connector",
                                                      "Display",       "Emitter",
                                                      "GPS",           "Gyro",
                                                      "InertialUnit",  "LED",
                                                      "Lidar",         "LightSensor",
                                                      "Pen",           "Radar",
                                                      "Speaker",       "Receiver",
                                                      "RangeFinder",   "TouchSensor",
                                                      "Track",         "VacuumCup",
                                                      "DistanceSensor"};
constexpr std::array<std::string_view, 4> kGroups = {"Group", "Pose", "Transform", "Billboard"};
constexpr std::array<std::string_view, 4> kJoints = {"HingeJoint", "Hinge2Joint", "SliderJoint", "BallJoint"};
constexpr std::array<std::string_view, 3> kScenery = {"Viewpoint", "Background", "Fog"};
constexpr std::array<std::string_view, 51> kOthers = {"WorldInfo",
                                                      "DirectionalLight",
                                                      "PointLight",
                                                      "SpotLight",
                                                      "Shape",
                                                      "CadShape",
                                                      "Appearance",
                                                      "PBRAppearance",
                                                      "Material",
                                                      "ImageTexture",
                                                      "TextureTransform",
                                                      "TextureCoordinate",
                                                      "Normal",
                                                      "Color",
                                                      "Coordinate",
                                                      "Box",
                                                      "Sphere",
                                                      "Capsule",
                                                      "Cylinder",
                                                      "Cone",
                                                      "Plane",
                                                      "Mesh",
                                                      "IndexedFaceSet",
                                                      "IndexedLineSet",
                                                      "PointSet",
                                                      "ElevationGrid",
                                                      "Physics",
                                                      "Damping",
                                                      "ContactProperties",
                                                      "ImmersionProperties",
                                                      "Fluid",
                                                      "JointParameters",
                                                      "HingeJointParameters",
                                                      "BallJointParameters",
                                                      "RotationalMotor",
                                                      "LinearMotor",
                                                      "PositionSensor",
                                                      "Brake",
                                                      "Slot",
                                                      "SolidReference",
                                                      "Propeller",
                                                      "Skin",
                                                      "Muscle",
                                                      "TrackWheel",
                                                      "Lens",
                                                      "LensFlare",
                                                      "Focus",
                                                      "Zoom",
                                                      "Recognition",
                                                      "Microphone",
                                                      "Extrusion"};

}  // namespace

bool isSolid(std::string_view type) { return contains(kSolids, type); }
bool isRobot(std::string_view type) { return type == "Robot" || type == "Supervisor" || type == "DifferentialWheels"; }
bool looksAhead(std::string_view type) {
  return type == "Camera" || type == "RangeFinder" || type == "Lidar" || type == "Radar";
}
bool standsUp(std::string_view type) {
  static constexpr std::array<std::string_view, 8> kTypes = {
      "Cylinder", "Capsule", "Cone", "Plane", "ElevationGrid", "Floor", "RectangleArena", "CircleArena"};
  return contains(kTypes, type);
}
bool isGroup(std::string_view type) { return contains(kGroups, type); }
bool isJoint(std::string_view type) { return contains(kJoints, type); }
bool isScenery(std::string_view type) { return contains(kScenery, type); }
bool isBaseNode(std::string_view type) {
  return isSolid(type) || isGroup(type) || isJoint(type) || isScenery(type) || contains(kOthers, type);
}

}  // namespace spark::webots
