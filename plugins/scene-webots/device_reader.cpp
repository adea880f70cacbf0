#include "device_reader.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace spark::webots {

namespace {

constexpr double kDegrees = 180 / M_PI;
constexpr int kMostPixels = 4096, kMostRays = 4096;
constexpr double kUnlimited = 1000;  // m: of cameras without a limit

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
    // Those of a solid, which its reader reads.
    f_.ignore({"translation", "rotation", "scale", "children", "model", "description", "contactMaterial",
               "immersionProperties", "boundingObject", "physics", "locked", "radarCrossSection", "recognitionColors",
               "translationStep", "rotationStep", "linearVelocity", "angularVelocity"});
  }
  void read();

 private:
  bool readKnown();
  mjcf::Sensor& atSite(const char* kind);
  mjcf::Sensor& ahead(const char* className, std::vector<std::pair<const char*, spark::Value>> settings);
  void inertial(const char* kind, const char* field, double unit);
  void compass();
  void distance();
  void lidar();
  void camera(bool depth);
  void touch();
  mjcf::Imperfection table(const char* field, double unit);
  void axes();
  double resolution(double unit);
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
  if (!readKnown())
    return r_.ignore(node_,
                     fmt::format("the device {} is not supported: only its body and its shapes are read", node_.type));
  f_.finish();
}

bool DeviceReader::readKnown() {
  const std::string& type = node_.type;
  if (type == "Gyro")
    inertial("gyro", "rt", kDegrees);
  else if (type == "Accelerometer")
    inertial("accelerometer", "a", 1);
  else if (type == "GPS")
    atSite("framepos").imperfections = {{.field = "p", .sigma = f_.number("accuracy", 0, 0), .step = resolution(1)}};
  else if (type == "InertialUnit")
    axes(), atSite("framequat").imperfections = {{.field = "q", .sigma = f_.number("noise", 0, 0)}};
  else if (type == "Compass")
    axes(), atSite("framequat");
  else if (type == "DistanceSensor")
    distance();
  else if (type == "Lidar")
    lidar();
  else if (type == "Camera" || type == "RangeFinder")
    camera(type == "RangeFinder");
  else if (type == "TouchSensor")
    touch();
  else
    return false;
  return true;
}

std::string DeviceReader::site(const Pose& pose) {
  mjcf::Body& body = model_.bodies[frame_.body];
  std::string out = fmt::format("{}-site", body.name);
  body.sites.push_back({out, pose});
  return out;
}

mjcf::Sensor& DeviceReader::atSite(const char* kind) {
  return model_.sensors.emplace_back(mjcf::Sensor{node_.element(), kind, name_, site({}), "site", ""});
}

/// A device looks along its x axis, a perceptor along the y axis.
mjcf::Sensor& DeviceReader::ahead(const char* className, std::vector<std::pair<const char*, spark::Value>> settings) {
  const Mat3 turned = Eigen::AngleAxisd(-M_PI / 2, Vec3::UnitZ()).toRotationMatrix();
  return model_.sensors.emplace_back(mjcf::Sensor{node_.element(), "", name_, site({Vec3::Zero(), turned}), "site", "",
                                                  className, std::move(settings)});
}

/// Components that a device does not measure are measured here, too.
void DeviceReader::axes() {
  for (const char* const axis : {"xAxis", "yAxis", "zAxis"})
    if (!f_.flag(axis, true))
      r_.ignore(node_, fmt::format("a {} has all three axes: {} FALSE is not supported", node_.type, axis));
}

/// The field `resolution`, in the unit of the percept; 0: none.
double DeviceReader::resolution(double unit) { return std::max(0.0, f_.number("resolution", -1)) * unit; }

/// Rows of a value, a response and a noise, a fraction of the response. The percept is the value, so responses other
/// than values are ignored. Beyond the table the last response counts, as in Webots.
mjcf::Imperfection DeviceReader::table(const char* field, double unit) {
  mjcf::Imperfection out{.field = field};
  const std::vector<double>* const rows = f_.numbers("lookupTable");
  if (!rows || rows->empty()) return out;
  if (rows->size() % 3 != 0)
    throw f_.error("lookupTable",
                   fmt::format("expected rows of 3 numbers for 'lookupTable', found {} numbers", rows->size()));
  bool same = true, even = true;
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (std::size_t i = 0; i < rows->size(); i += 3) {
    const double value = (*rows)[i], response = (*rows)[i + 1], noise = (*rows)[i + 2];
    least = std::min(least, value), most = std::max(most, value);
    same = same && std::abs(value - response) <= 1e-9 * std::abs(value);
    even = even && noise == (*rows)[2];
    out.relative = std::max(out.relative, noise);
  }
  if (!same)
    r_.ignore(node_, fmt::format("the responses of the lookupTable of a {} are ignored: it senses in SI units or "
                                 "degrees",
                                 node_.type));
  if (!even)
    r_.ignore(node_, fmt::format("the largest noise of the lookupTable of a {} counts everywhere", node_.type));
  if (rows->size() > 3) out.least = unit * least, out.most = unit * most;
  return out;
}

void DeviceReader::inertial(const char* kind, const char* field, double unit) {
  axes();
  mjcf::Imperfection x = table(field, unit);
  x.step = resolution(unit);
  atSite(kind).imperfections = {std::move(x)};
}

void DeviceReader::distance() {
  // Rows of a distance, a response and a noise, a fraction of the response.
  static const std::vector<double> kDefault{0, 0, 0, 0.1, 1000, 0};
  const std::vector<double>* const given = f_.numbers("lookupTable");
  const std::vector<double>& rows = given ? *given : kDefault;
  if (rows.size() % 3 != 0 || rows.size() < 3)
    throw f_.error("lookupTable",
                   fmt::format("expected rows of 3 numbers for 'lookupTable', found {} numbers", rows.size()));
  const double least = rows.front(), most = rows[rows.size() - 3];
  if (!(least >= 0) || !(most > least))
    throw f_.error("lookupTable", "expected distances of 0 or more that increase in 'lookupTable'");
  // A noise of the response is one of the distance, by the slope between two rows.
  mjcf::Imperfection x{.step = 0};
  bool same = true, proportional = true;
  for (std::size_t i = 0; i < rows.size(); i += 3) same = same && std::abs(rows[i] - rows[i + 1]) <= 1e-9;
  for (std::size_t i = 0; i + 3 < rows.size(); i += 3) {
    const double slope = (rows[i + 4] - rows[i + 1]) / (rows[i + 3] - rows[i]);
    for (const std::size_t k : {i, i + 3}) {
      const double noise = rows[k + 2];
      if (!(noise > 0) || slope == 0) continue;
      proportional =
          proportional && noise == rows[2] && std::abs(rows[k + 1] - slope * rows[k]) < 1e-9 * std::abs(slope);
      x.sigma = std::max(x.sigma, noise * std::abs(rows[k + 1] / slope));
    }
  }
  if (proportional) x.sigma = 0, x.relative = rows[2];
  if (!same) r_.ignore(node_, "the responses of the lookupTable of a DistanceSensor are ignored: it senses metres");
  if (x.sigma > 0) r_.ignore(node_, "the largest noise of the lookupTable of a DistanceSensor counts everywhere");
  if (same) x.step = resolution(1);
  const bool sonar = f_.text("type", "generic") == "sonar";
  const double rays = f_.number("numberOfRays", 1);
  if (rays > 1 && sonar) {
    ahead("SonarPerceptor", {{"byRays", true},
                             {"maxEchoes", 1},
                             {"senseCone", std::clamp(f_.number("aperture", M_PI / 2) * kDegrees, 0.0, 360.0)},
                             {"minRange", least},
                             {"maxRange", most}})
        .imperfections = {x};
    return;
  }
  if (rays > 1) r_.ignore(node_, "a DistanceSensor has one ray");
  if (rays <= 1) f_.ignore({"aperture", "gaussianWidth"});  // of several rays
  ahead("DistancePerceptor", {{"minRange", least}, {"maxRange", most}}).imperfections = {x};
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
  if (f_.number("numberOfLayers", 4) > 1)
    r_.ignore(node_, "a Lidar has one layer");
  else
    f_.ignore({"verticalFieldOfView"});
  if (f_.text("type", "fixed") != "fixed")
    r_.ignore(node_, "a Lidar that rotates senses its whole field of view at once, in each cycle");
  else
    f_.ignore({"defaultFrequency", "minFrequency", "maxFrequency"});
  if (f_.number("near", 0.01, 0) > least) r_.ignore(node_, "'near' of a Lidar is not supported: minRange counts");
  ahead(
      "LidarPerceptor",
      {{"rays", whole("horizontalResolution", 512, kMostRays)}, {"fov", view}, {"minRange", least}, {"maxRange", most}})
      .imperfections = {{.field = "d", .sigma = f_.number("noise", 0, 0) * most, .step = resolution(1)}};
}

void DeviceReader::camera(bool depth) {
  const int width = whole("width", 64, kMostPixels), height = whole("height", 64, kMostPixels);
  const double view = f_.number("fieldOfView", M_PI / 4);
  const std::string projection = f_.text("projection", "planar");
  if (!(view > 0) || !(view < M_PI) || f_.flag("spherical", false) || projection != "planar") {
    f_.ignore({"minRange", "maxRange", "near", "far", "noise", "resolution"});
    r_.ignore(node_, fmt::format("a spherical {} is not supported", node_.type));
    return;
  }
  // In Webots the angle is the horizontal one; pixels are squares.
  const double vertical = 2 * std::atan(std::tan(view / 2) * height / width) * kDegrees;
  constexpr double kMillimetres = 1000, kWhite = 255;
  const double noise = f_.number("noise", 0, 0);
  double near = f_.number("near", 0.01, 0), far = kUnlimited;
  mjcf::Imperfection x;
  if (depth) {
    // The picture's own range; what is nearer than the lens can see is nearer than that.
    near = std::max(near, f_.number("minRange", 0.01, 0)), far = f_.number("maxRange", 1, 0);
    x.sigma = noise * far * kMillimetres;
    x.step = resolution(kMillimetres);
  } else {
    if (const double given = f_.number("far", 0, 0); given > 0) far = given;  // 0: no limit
    x.sigma = noise * kWhite;
  }
  if (!(far > near))
    throw f_.error(depth ? "maxRange" : "far",
                   fmt::format("expected a farthest distance beyond the nearest one, {} m, found {} m", near, far));
  ahead("ImagePerceptor", {{"width", width},
                           {"height", height},
                           {"fov", vertical},
                           {"picture", depth ? "depth" : "colour"},
                           {"zNear", near},
                           {"zFar", far}})
      .imperfections = {x};
}

void DeviceReader::touch() {
  const std::string type = f_.text("type", "bumper");
  if (type != "bumper") {
    f_.ignore({"lookupTable", "resolution"});
    return r_.ignore(node_, fmt::format("a TouchSensor of type '{}' is not supported", type));
  }
  model_.sensors.push_back(
      {node_.element(), "", name_, model_.bodies[frame_.body].name, "body", "", "TouchPerceptor", {}});
}

}  // namespace

void readDevice(const Node& node, const Frame& frame, mjcf::Model& model, Reading& reading) {
  DeviceReader(node, frame, model, reading).read();
}

void readPositionSensor(const Node& node, bool slides, mjcf::Sensor& sensor, Reading& reading) {
  Fields f(node, reading.unsupported);
  f.ignore({"name", "model", "description"});
  const double unit = slides ? 1 : kDegrees;
  sensor.imperfections.push_back({.field = "ax",
                                  .sigma = unit * f.number("noise", 0, 0),
                                  .step = unit * std::max(0.0, f.number("resolution", -1))});
  f.finish();
}

void ignoreDeviceFields(const Node& node, Fields& f) {
  if (node.type != "Solid" && node.type != "Robot")
    for (const Field& field : node.fields) f.ignore({field.name.c_str()});
}

}  // namespace spark::webots
