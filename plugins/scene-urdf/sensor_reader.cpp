#include "sensor_reader.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

namespace spark::urdf {

using mjcf::Attributes;
using mjcf::Imperfection;

namespace {

constexpr double kDegrees = 180 / kPi, kMillimetres = 1000, kWhite = 255;
constexpr double kFarthest = 10'000;  // m: of ranges without an end
constexpr int kMostRays = 4096, kMostPixels = 4096;

/// The numbers in the text of an element. Throws Error unless there are `count`.
std::vector<double> numbersIn(const Element& e, std::size_t count) {
  auto found = numbersOf(contentOf(e));
  // A range may have no end.
  if (!found && count == 1 && contentOf(e).ends_with("inf"))
    found = {contentOf(e).front() == '-' ? -HUGE_VAL : HUGE_VAL};
  if (!found || found->size() != count)
    throw e.error(fmt::format("expected {} in <{}>, found '{}'",
                              count == 1 ? "a number" : fmt::format("{} numbers", count), e.tag(),
                              contentOf(e).substr(0, 80)));
  return *found;
}

Mat3 rotationOf(double roll, double pitch, double yaw) {
  return (Eigen::AngleAxisd(yaw, Vec3::UnitZ()) * Eigen::AngleAxisd(pitch, Vec3::UnitY()) *
          Eigen::AngleAxisd(roll, Vec3::UnitX()))
      .toRotationMatrix();
}

}  // namespace

/// The elements in an element. What is read is known; finish() names the others.
class SensorReader::Parts {
 public:
  Parts(const Element& e, Unsupported& unsupported) : element_(e), unsupported_(unsupported) {}
  const Element& element() const { return element_; }
  std::optional<Element> take(const char* tag) {
    known_.insert(tag);
    return childOf(element_, tag);
  }
  /// The elements in the child of that tag; those of an empty element where there is none.
  Parts in(const char* tag) {
    const auto found = take(tag);
    return {found ? *found : Element{{}, element_.file}, unsupported_};
  }
  double number(const char* tag, double otherwise) {
    const auto found = take(tag);
    return found ? numbersIn(*found, 1).front() : otherwise;
  }
  std::string text(const char* tag, const char* otherwise) {
    const auto found = take(tag);
    return std::string(found ? contentOf(*found) : otherwise);
  }
  void ignore(std::initializer_list<const char*> tags) {
    for (const char* tag : tags) known_.insert(tag);
  }
  void finish() {
    if (!element_.node) return;
    for (const Element& e : childrenOf(element_))
      if (!known_.contains(e.tag()))
        unsupported_.add(e, fmt::format("the element <{}> in <{}> is not supported", e.tag(), element_.tag()));
  }

 private:
  Element element_;
  Unsupported& unsupported_;
  std::set<std::string, std::less<>> known_;
};

void SensorReader::read(const Element& gazebo) {
  const std::string_view link = gazebo.node.attribute("reference").value();
  const auto body =
      std::find_if(model_.bodies.begin() + 1, model_.bodies.end(), [&](const mjcf::Body& b) { return b.name == link; });
  for (const Element& e : childrenOf(gazebo)) {
    if (e.tag() != "sensor") continue;
    const std::string type = e.node.attribute("type").value();
    if (body == model_.bodies.end()) {
      unsupported_.add(e, fmt::format("a sensor of type '{}' is left out: '{}' is no link", type, link));
      continue;
    }
    const std::size_t sensors = model_.sensors.size(), sites = body->sites.size();
    try {
      sensor(e, *body);
    } catch (const Error& error) {
      model_.sensors.resize(sensors), body->sites.resize(sites);
      unsupported_.add(e, fmt::format("a sensor of type '{}' is left out: {}", type, error.what()));
    }
  }
}

void SensorReader::sensor(const Element& e, mjcf::Body& body) {
  from_ = e, body_ = &body, name_ = nameOf(e), pose_ = {}, site_.clear();
  const std::string type = e.node.attribute("type").value();
  Attributes attributes(e, unsupported_);
  attributes.ignore({"name", "type"});
  attributes.finish();
  Parts parts(e, unsupported_);
  if (const auto pose = parts.take("pose")) {
    Attributes a(*pose, unsupported_);
    const double unit = a.flag("degrees", false) ? 1 / kDegrees : 1;
    a.finish();
    if (!contentOf(*pose).empty()) {
      const std::vector<double> v = numbersIn(*pose, 6);
      pose_ = {{v[0], v[1], v[2]}, rotationOf(unit * v[3], unit * v[4], unit * v[5])};
    }
  }
  rate_ = std::max(0.0, parts.number("update_rate", 0));
  parts.ignore({"always_on", "visualize", "topic", "enable_metrics"});  // how others see it
  if (!readKind(type, parts)) return unsupported_.add(e, fmt::format("a sensor of type '{}' is not supported", type));
  parts.finish();
}

bool SensorReader::readKind(const std::string& type, Parts& parts) {
  if (type == "imu")
    imu(parts);
  else if (type == "ray" || type == "gpu_ray" || type == "lidar" || type == "gpu_lidar")
    lidar(parts);
  else if (type == "camera")
    camera(parts, false, "");
  else if (type == "depth" || type == "depth_camera")
    camera(parts, true, "");
  else if (type == "rgbd" || type == "rgbd_camera")
    camera(parts, false, ""), camera(parts, true, "_depth");
  else if (type == "contact")
    contact(parts);
  else if (type == "sonar")
    sonar(parts);
  else if (type == "gps" || type == "navsat")
    gps(parts);
  else
    return false;
  return true;
}

/// In the frame of the sensor, which is turned.
mjcf::Sensor& SensorReader::add(const char* kind, const std::string& ending, const Mat3& turned,
                                const char* className) {
  // Several percepts of one sensor share its place.
  if (site_.empty()) {
    site_ = name_ + "_site";
    for (int i = 2; !sites_.insert(site_).second; ++i) site_ = fmt::format("{}_site~{}", name_, i);
    body_->sites.push_back({site_, {pose_.position, pose_.rotation * turned}});
  }
  mjcf::Sensor s{from_, kind, name_ + ending, site_, "site", "", className, {}};
  s.rate = rate_;
  return model_.sensors.emplace_back(std::move(s));
}

/// A sensor looks along its x axis, a perceptor along the y axis.
mjcf::Sensor& SensorReader::ahead(const char* className, const std::string& ending, double yaw) {
  return add("", ending, rotationOf(0, 0, yaw - kPi / 2), className);
}

/// An element `noise`, or one with the same parts; `unit`: that of the percept.
Imperfection SensorReader::noise(const Element& e, double unit, const char* field) {
  Imperfection out{.field = field};
  Parts parts(e, unsupported_);
  const std::string type = e.node.attribute("type") ? e.node.attribute("type").value() : parts.text("type", "gaussian");
  parts.ignore({"type"});
  const double mean = parts.number("mean", 0), sigma = parts.number("stddev", 0), bias = parts.number("bias_mean", 0),
               biasSigma = parts.number("bias_stddev", 0), precision = parts.number("precision", 0);
  parts.finish();
  if (type == "none") return out;
  if (type != "gaussian" && type != "gaussian_quantized") {
    unsupported_.add(e, fmt::format("a noise of type '{}' is not supported", type));
    return out;
  }
  out.bias = unit * (mean + bias);
  out.biasSigma = unit * std::abs(biasSigma);
  out.sigma = unit * std::abs(sigma);
  if (type == "gaussian_quantized") out.step = unit * std::abs(precision);
  return out;
}

/// The noises of x, y and z; `all`: field, and what they have where the element does not say.
void SensorReader::axes(Parts& parts, const char* tag, std::vector<Imperfection>& out, const Imperfection& all) {
  Parts axes = parts.in(tag);
  const double unit = std::string_view(all.field) == "rt" ? kDegrees : 1;
  bool any = false;
  std::vector<Imperfection> found;
  for (int i = 0; i < 3; ++i) {
    static constexpr const char* kAxes[] = {"x", "y", "z"};
    Parts axis = axes.in(kAxes[i]);
    Imperfection x = all;
    if (const auto e = axis.take("noise")) x = noise(*e, unit, all.field), any = true;
    x.indices = {i};
    found.push_back(std::move(x));
    axis.finish();
  }
  axes.finish();
  if (any)
    out = std::move(found);
  else
    out = {all};
}

void SensorReader::imu(Parts& parts) {
  mjcf::Imperfection rate{.field = "rt"}, acceleration{.field = "a"};
  Parts imu = parts.in("imu");
  // Old files: one noise for all axes.
  for (Parts* const of : {&imu, &parts}) {
    const auto e = of->take("noise");
    if (!e) continue;
    Parts both(*e, unsupported_);
    const std::string type = both.text("type", "gaussian");
    if (type != "gaussian" && type != "none")
      unsupported_.add(*e, fmt::format("a noise of type '{}' is not supported", type));
    if (const auto r = both.take("rate"); r && type == "gaussian") rate = noise(*r, kDegrees, "rt");
    if (const auto a = both.take("accel"); a && type == "gaussian") acceleration = noise(*a, 1, "a");
    both.finish();
  }
  std::vector<Imperfection> rates, accelerations;
  axes(imu, "angular_velocity", rates, rate);
  axes(imu, "linear_acceleration", accelerations, acceleration);
  imu.finish();
  add("gyro", "_gyro", Mat3::Identity()).imperfections = std::move(rates);
  add("accelerometer", "_acc", Mat3::Identity()).imperfections = std::move(accelerations);
}

void SensorReader::lidar(Parts& parts) {
  const bool ray = parts.take("ray").has_value();
  Parts lidar = parts.in(ray ? "ray" : "lidar");
  Parts scan = lidar.in("scan"), horizontal = scan.in("horizontal"), vertical = scan.in("vertical"),
        range = lidar.in("range");
  const double wanted = std::round(horizontal.number("samples", 640) * horizontal.number("resolution", 1));
  const int rays = static_cast<int>(std::clamp(wanted, 1.0, double(kMostRays)));
  if (wanted != rays) unsupported_.add(from_, fmt::format("a scan has 1 to {} rays", kMostRays));
  const double first = horizontal.number("min_angle", 0), last = horizontal.number("max_angle", 0);
  if (!(last >= first) || !std::isfinite(last - first))
    throw horizontal.element().error(
        fmt::format("expected a min_angle that is not above max_angle, found {} and {}", first, last));
  if (vertical.number("samples", 1) > 1)
    unsupported_.add(vertical.element(), "a scan has one layer, in the plane of the sensor's x and y axis");
  else if (vertical.number("min_angle", 0) != 0)
    unsupported_.add(vertical.element(),
                     "a layer is in the plane of the sensor's x and y axis: a vertical angle is "
                     "not supported");
  vertical.ignore({"resolution", "min_angle", "max_angle"});
  const double least = range.number("min", 0), most = std::min(range.number("max", 10), kFarthest);
  if (!(least >= 0) || !(most >= least))
    throw range.element().error(fmt::format("expected 0 <= min <= max [m], found {} and {}", least, most));
  Imperfection x{.field = "d"};
  const auto e = lidar.take("noise");
  const auto outside = parts.take("noise");
  if (e || outside) x = noise(e ? *e : *outside, 1, "d");
  x.step = std::max(x.step, range.number("resolution", 0));
  for (Parts* p : {&horizontal, &vertical, &scan, &range, &lidar}) p->finish();
  // A fan of 360 degrees would not repeat its first direction at its end.
  const double view = rays > 1 ? std::min((last - first) * kDegrees, 359.999) : 0;
  mjcf::Sensor& s = ahead("LidarPerceptor", "", (first + last) / 2);
  s.settings = {{"rays", rays}, {"fov", view}, {"minRange", least}, {"maxRange", most}};
  s.imperfections = {std::move(x)};
}

void SensorReader::camera(Parts& parts, bool depth, const char* ending) {
  Parts camera = parts.in("camera");
  Parts image = camera.in("image"), clip = camera.in("clip"), depths = camera.in("depth_camera"),
        ranges = depths.in("clip");
  const auto pixels = [&](const char* tag, double otherwise) {
    const double v = image.number(tag, otherwise);
    if (!(v >= 1 && v <= kMostPixels && v == std::floor(v)))
      throw image.element().error(
          fmt::format("expected a whole number from 1 to {} in <{}>, found {}", kMostPixels, tag, v));
    return static_cast<int>(v);
  };
  const int width = pixels("width", 320), height = pixels("height", 240);
  if (const std::string format = image.text("format", "R8G8B8");
      !depth && format != "R8G8B8" && format != "RGB_INT8" && format != "B8G8R8" && format != "BGR_INT8")
    unsupported_.add(image.element(),
                     fmt::format("the format '{}' of images is not supported: they have colours", format));
  const double view = camera.number("horizontal_fov", 1.047);
  if (!(view > 0 && view < kPi))
    throw camera.element().error(fmt::format("expected a horizontal_fov above 0 and below pi, found {}", view));
  double near = clip.number("near", 0.1), far = clip.number("far", 100);
  const double nearest = ranges.number("near", near), farthest = ranges.number("far", far);
  if (depth) near = nearest, far = farthest;
  far = std::min(far, kFarthest);
  if (!(near >= 0 && far > near))
    throw clip.element().error(fmt::format("expected 0 <= near < far [m], found {} and {}", near, far));
  Imperfection x;
  if (const auto e = camera.take("noise")) x = noise(*e, depth ? kMillimetres : kWhite, "");
  if (const auto pose = camera.take("pose"); pose && !contentOf(*pose).empty()) {
    const std::vector<double> v = numbersIn(*pose, 6);
    if (!*ending) pose_ = compose(pose_, {{v[0], v[1], v[2]}, rotationOf(v[3], v[4], v[5])});
  }
  camera.ignore({"visualize", "topic"});
  for (Parts* p : {&image, &clip, &ranges, &depths, &camera}) p->finish();
  const double vertical = 2 * std::atan(std::tan(view / 2) * height / width) * kDegrees;
  mjcf::Sensor& s = ahead("ImagePerceptor", ending);
  s.settings = {{"width", width}, {"height", height}, {"fov", vertical}, {"picture", depth ? "depth" : "colour"},
                {"zNear", near},  {"zFar", far}};
  s.imperfections = {std::move(x)};
}

/// The contacts of all shapes of the link.
void SensorReader::contact(Parts& parts) {
  Parts contact = parts.in("contact");
  contact.ignore({"collision", "topic"});
  contact.finish();
  std::size_t shapes = 0;
  for (const mjcf::Geom& g : body_->geoms) shapes += g.collides() ? 1 : 0;
  if (shapes > 1) unsupported_.add(from_, "a contact sensor senses the contacts of all shapes of its link");
  mjcf::Sensor s{from_, "", name_, body_->name, "body", "", "TouchPerceptor", {}};
  s.rate = rate_;
  model_.sensors.push_back(std::move(s));
}

void SensorReader::sonar(Parts& parts) {
  Parts sonar = parts.in("sonar");
  const double least = sonar.number("min", 0), most = std::min(sonar.number("max", 10), kFarthest),
               radius = sonar.number("radius", 0.5);
  if (!(least >= 0 && most > least && radius > 0))
    throw from_.error(
        fmt::format("expected 0 <= min < max and a radius above 0 [m], found {}, {} and {}", least, most, radius));
  sonar.ignore({"geometry"});
  sonar.finish();
  ahead("SonarPerceptor").settings = {{"byRays", true},
                                      {"maxEchoes", 1},
                                      {"senseCone", 2 * std::atan(radius / most) * kDegrees},
                                      {"minRange", least},
                                      {"maxRange", most}};
}

void SensorReader::gps(Parts& parts) {
  const bool gps = parts.take("gps").has_value();
  Parts of = parts.in(gps ? "gps" : "navsat");
  Parts sensing = of.in("position_sensing");
  std::vector<Imperfection> found;
  for (const bool vertical : {false, true}) {
    Parts direction = sensing.in(vertical ? "vertical" : "horizontal");
    const auto e = direction.take("noise");
    direction.finish();
    if (!e) continue;
    found.push_back(noise(*e, 1, "p"));
    found.back().indices = vertical ? std::vector<int>{2} : std::vector<int>{0, 1};
  }
  sensing.finish();
  of.finish();
  add("framepos", "", Mat3::Identity()).imperfections = std::move(found);
}

}  // namespace spark::urdf
