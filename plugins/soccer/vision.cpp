#include "vision.h"

namespace spark::soccer {

Polar polarOf(const Vec3f& r) {
  const double x = r.x(), y = r.y(), z = r.z();
  return {std::sqrt(x * x + y * y + z * z), radToDeg(std::atan2(y, x)), radToDeg(std::atan2(z, std::hypot(x, y)))};
}

Vec3f pointOf(const Polar& p) {
  const double h = degToRad(p.horizontal), v = degToRad(p.vertical);
  return Vec3(p.distance * std::cos(v) * std::cos(h), p.distance * std::cos(v) * std::sin(h), p.distance * std::sin(v))
      .cast<float>();
}

void tellSights(const Sights& sights, std::vector<IEye::Sight>& out) {
  for (const Sights::Mark& m : sights.field()) out.push_back({m.object->perceptName(), m.place});
  for (const Sights::Robot& r : sights.robots()) {
    const std::string name = fmt::format("{} {} {}", r.state->perceptName(), r.state->team(), r.state->unum());
    out.push_back({name, r.place});
    for (const Sights::Mark& part : sights.partsOf(r))
      out.push_back({fmt::format("{} {}", name, part.object->id()), part.place});
  }
}

Matrix fieldView(const Vec3f& place, Side side) {
  Matrix m = translation(place);
  for (int axis = 0; axis < 3; ++axis) m.block<3, 1>(0, axis) = seenBy(side, Vec3f::Unit(axis));
  return m;
}

Matrix headView(const Transform& head) {
  Matrix m = head.world();
  m.col(0) = head.world().col(1);
  m.col(1) = -head.world().col(0);
  return m;
}

void writePoint(Predicates& out, std::string_view name, const Vec3f& p) {
  out.open(name).add(double(p.x())).add(double(p.y())).add(double(p.z())).close();
}

void Outlook::refresh(const SceneNode& eye) {
  Kernel& kernel = eye.kernel();
  if (!tree_.changed(eye)) return;
  stateFound_ = false;
  auto* aspect = eye.ancestor<AgentAspect>();
  agent_ = aspect ? &aspect->outermost() : nullptr;
  state_ = nullptr;
  settings_ = kernel.root().find<SoccerSettings>();
  if (!settings_ && !own_) own_ = std::make_unique<Sights>();
  sights_ = settings_ ? &settings_->sights() : own_.get();
}

void Outlook::findState() {
  if (std::exchange(stateFound_, true)) return;
  state_ = sights_->stateOf(agent_);
}

void Outlook::share(const SceneNode& eye, std::uint64_t round, float range) {
  refresh(eye);
  range_ = limited(range);
  sights_->share(eye.kernel(), round, range_);
  findState();
  shared_ = true;
}

void Outlook::open(const SceneNode& eye, float range) {
  if (!std::exchange(shared_, false)) bring(eye, range);
}

void Outlook::bring(const SceneNode& eye, float range) {
  refresh(eye);
  range_ = limited(range);
  sights_->update(eye.kernel(), range_);
  findState();
}

std::span<const std::uint32_t> Outlook::robotsNear(const Vec3f& place) {
  sights_->near(place, range_, near_);
  return near_;
}

}  // namespace spark::soccer
