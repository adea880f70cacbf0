#include "device_reader.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace spark::webots {

namespace {

constexpr double kDegrees = 180 / M_PI;
constexpr int kMostPixels = 4096, kMostRays = 4096;

/// "inertial unit" for InertialUnit, as in Webots.
std::string defaultName(const std::string& type) {
  const auto isCapital = [](char c) { return c >= 'A' && c <= 'Z'; };
  std::string out;
  for (std::size_t i = 0; i < type.size(); ++i) {
    if (i > 0 && isCapital(type[i]) && !isCapital(type[i - 1])) out += ' ';
    out += isCapital(type[i]) ? static_cast<char>(type[i] + 32) : type[i];
  }
  return out;
}

/// Reads one device.
class DeviceReader {
 public:
  DeviceReader(const Node& node, const Frame& frame, mjcf::Model& model, Reading& reading)
      : node_(node), f_(node, reading.unsupported), frame_(frame), model_(model), r_(reading) {
    name_ = f_.text("name");
    if (name_.empty()) name_ = defaultName(node.type);
  }
  void read();

 private:
  void atSite(const char* kind);
  void ahead(const char* className, std::vector<std::pair<const char*, spark::Value>> settings);
  void distance();
  void lidar();
  void camera(const char* picture);
  void touch();
  int whole(const char* field, int otherwise, int most);
  std::string site(const Pose& pose);

  const Node& node_;
  Fields f_;
  const Frame& frame_;
  mjcf::Model& model_;
  Reading& r_;
  std::string name_;
};

void DeviceReader::read() {
  const std::string& type = node_.type;
  if (type == "Gyro") return atSite("gyro");
  if (type == "Accelerometer") return atSite("accelerometer");
  if (type == "GPS") return atSite("framepos");
  if (type == "InertialUnit" || type == "Compass") return atSite("framequat");
  if (type == "DistanceSensor") return distance();
  if (type == "Lidar") return lidar();
  if (type == "Camera") return camera("colour");
  if (type == "RangeFinder") return camera("depth");
  if (type == "TouchSensor") return touch();
  r_.ignore(node_, fmt::format("the device {} is not supported: only its body and its shapes are read", type));
}

std::string DeviceReader::site(const Pose& pose) {
  mjcf::Body& body = model_.bodies[frame_.body];
  std::string out = fmt::format("{}-site", body.name);
  body.sites.push_back({out, pose});
  return out;
}

void DeviceReader::atSite(const char* kind) {
  model_.sensors.push_back({node_.element(), kind, name_, site({}), "site", ""});
}

/// A device looks along its x axis, a perceptor along the y axis.
void DeviceReader::ahead(const char* className, std::vector<std::pair<const char*, spark::Value>> settings) {
  const Mat3 turned = Eigen::AngleAxisd(-M_PI / 2, Vec3::UnitZ()).toRotationMatrix();
  model_.sensors.push_back(
      {node_.element(), "", name_, site({Vec3::Zero(), turned}), "site", "", className, std::move(settings)});
}

void DeviceReader::distance() {
  // Rows of a distance, a response and a noise.
  static const std::vector<double> kDefault{0, 0, 0, 0.1, 1000, 0};
  const std::vector<double>* const given = f_.numbers("lookupTable");
  const std::vector<double>& table = given ? *given : kDefault;
  if (table.size() % 3 != 0 || table.size() < 3)
    throw f_.error("lookupTable",
                   fmt::format("expected rows of 3 numbers for 'lookupTable', found {} numbers", table.size()));
  const double least = table.front(), most = table[table.size() - 3];
  if (!(least >= 0) || !(most > least))
    throw f_.error("lookupTable", "expected distances of 0 or more that increase in 'lookupTable'");
  if (f_.number("numberOfRays", 1) > 1) r_.ignore(node_, "a DistanceSensor has one ray");
  ahead("DistancePerceptor", {{"minRange", least}, {"maxRange", most}});
}

int DeviceReader::whole(const char* field, int otherwise, int most) {
  const double v = f_.number(field, otherwise);
  if (v != std::floor(v) || v < 1 || v > most)
    throw f_.error(field, fmt::format("expected a whole number from 1 to {} for '{}', found {}", most, field, v));
  return static_cast<int>(v);
}

void DeviceReader::lidar() {
  const double least = f_.number("minRange", 0.01, 0), most = f_.number("maxRange", 1, 0);
  const double view = std::clamp(f_.number("fieldOfView", M_PI / 2) * kDegrees, 0.0, 360.0);
  if (f_.number("numberOfLayers", 4) > 1) r_.ignore(node_, "a Lidar has one layer");
  ahead("LidarPerceptor", {{"rays", whole("horizontalResolution", 512, kMostRays)},
                           {"fov", view},
                           {"minRange", least},
                           {"maxRange", most}});
}

void DeviceReader::camera(const char* picture) {
  const int width = whole("width", 64, kMostPixels), height = whole("height", 64, kMostPixels);
  const double view = f_.number("fieldOfView", M_PI / 4);
  if (!(view > 0) || !(view < M_PI) || f_.flag("spherical", false)) {
    r_.ignore(node_, fmt::format("a spherical {} is not supported", node_.type));
    return;
  }
  // In Webots the angle is the horizontal one; pixels are squares.
  const double vertical = 2 * std::atan(std::tan(view / 2) * height / width) * kDegrees;
  ahead("ImagePerceptor", {{"width", width}, {"height", height}, {"fov", vertical}, {"picture", picture}});
}

void DeviceReader::touch() {
  const std::string type = f_.text("type", "bumper");
  if (type != "bumper") return r_.ignore(node_, fmt::format("a TouchSensor of type '{}' is not supported", type));
  model_.sensors.push_back(
      {node_.element(), "", name_, model_.bodies[frame_.body].name, "body", "", "TouchPerceptor", {}});
}

}  // namespace

void readDevice(const Node& node, const Frame& frame, mjcf::Model& model, Reading& reading) {
  DeviceReader(node, frame, model, reading).read();
}

void ignoreDeviceFields(const Node& node, Fields& f) {
  if (node.type != "Solid" && node.type != "Robot")
    for (const Field& field : node.fields) f.ignore({field.name.c_str()});
}

}  // namespace spark::webots
