#include "vision.h"

namespace spark::soccer {

Polar toPolar(const Vec3f& point) {
  const double x = point.x(), y = point.y(), z = point.z();
  return {std::sqrt(x * x + y * y + z * z), radToDeg(std::atan2(y, x)), radToDeg(std::atan2(z, std::hypot(x, y)))};
}

Vec3f toCartesian(const Polar& p) {
  const double h = degToRad(p.horizontal), v = degToRad(p.vertical);
  return Vec3(p.distance * std::cos(v) * std::cos(h), p.distance * std::cos(v) * std::sin(h), p.distance * std::sin(v))
      .cast<float>();
}

void appendSights(const VisibleObjects& objects, std::vector<IEye::Sight>& out) {
  for (const VisibleObjects::Object& o : objects.field()) out.push_back({o.state->perceptName(), o.position});
  for (const VisibleObjects::Robot& r : objects.robots()) {
    const std::string name = fmt::format("{} {} {}", r.state->perceptName(), r.state->team(), r.state->unum());
    out.push_back({name, r.position});
    for (const VisibleObjects::Object& part : objects.partsOf(r))
      out.push_back({fmt::format("{} {}", name, part.state->id()), part.position});
  }
}

Matrix teamView(const Vec3f& position, Side side) {
  Matrix m = translation(position);
  for (int axis = 0; axis < 3; ++axis) m.block<3, 1>(0, axis) = toTeamFrame(side, Vec3f::Unit(axis));
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

void EyeContext::refresh(const SceneNode& eye) {
  Kernel& kernel = eye.kernel();
  if (!tree_.changed(eye)) return;
  stateFound_ = false;
  auto* aspect = eye.ancestor<AgentAspect>();
  agent_ = aspect ? &aspect->outermost() : nullptr;
  object_ = aspect ? &aspect->object() : nullptr;
  state_ = nullptr;
  settings_ = kernel.root().find<SoccerSettings>();
  physics_ = kernel.root().find<IPhysicsServer>();
  if (!settings_ && !own_) own_ = std::make_unique<VisibleObjects>();
  objects_ = settings_ ? &settings_->visibleObjects() : own_.get();
}

void EyeContext::findState() {
  if (std::exchange(stateFound_, true)) return;
  state_ = objects_->stateOf(agent_);
}

void EyeContext::prepareOcclusion() {
  hides_ = (occlusion_ || (settings_ && settings_->visionOcclusion)) && physics_ && physics_->hasWorld();
  if (hides_) physics_->prepareRays();
}

void EyeContext::share(const SceneNode& eye, std::uint64_t round, float range) {
  refresh(eye);
  range_ = limitRange(range);
  objects_->share(eye.kernel(), round, range_);
  prepareOcclusion();
  findState();
  shared_ = true;
}

void EyeContext::beginSense(const SceneNode& eye, float range) {
  if (!std::exchange(shared_, false)) update(eye, range);
}

void EyeContext::update(const SceneNode& eye, float range) {
  refresh(eye);
  range_ = limitRange(range);
  objects_->update(eye.kernel(), range_);
  prepareOcclusion();
  findState();
}

std::span<const std::uint32_t> EyeContext::robotsNear(const Vec3f& position) {
  objects_->findNear(position, range_, near_);
  return near_;
}

}  // namespace spark::soccer
