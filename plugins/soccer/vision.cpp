#include "vision.h"

namespace spark::soccer {

Polar polarOf(const Vec3f& r) {
  const double x = r.x(), y = r.y(), z = r.z();
  return {std::sqrt(x * x + y * y + z * z), radToDeg(std::atan2(y, x)), radToDeg(std::atan2(z, std::hypot(x, y)))};
}

void writePolar(Predicates& out, const Polar& p) { out.open("pol").add(p.distance).add(p.horizontal).add(p.vertical).close(); }

void writePoint(Predicates& out, std::string_view name, const Vec3f& p) {
  out.open(name).add(double(p.x())).add(double(p.y())).add(double(p.z())).close();
}

void VisibleObjects::refresh(const SceneNode& eye) {
  Kernel& kernel = eye.kernel();
  if (version_ == kernel.structureVersion()) return;
  version_ = kernel.structureVersion();
  field_.clear();
  robots_.clear();
  lines_.clear();
  auto* aspect = eye.ancestor<AgentAspect>();
  agent_ = aspect ? &aspect->outermost() : nullptr;
  state_ = nullptr;
  settings_ = kernel.root().find<SoccerSettings>("/sys/variables/Soccer");
  Node* scene = kernel.root().find<Node>("/usr/scene");
  if (!scene) return;
  scene->collect(lines_);
  std::vector<ObjectState*> all;
  scene->collect(all);
  for (ObjectState* o : all) {
    auto* inner = o->ancestor<AgentAspect>();
    if (!inner) {
      if (!o->perceptName().empty()) field_.push_back(o);
      continue;
    }
    AgentAspect* agent = &inner->outermost();
    if (robots_.empty() || robots_.back().agent != agent) robots_.push_back({agent, nullptr, {}});
    if (auto* state = o->as<AgentState>())
      robots_.back().state = state;
    else if (!o->id().empty())
      robots_.back().parts.push_back(o);
  }
  std::erase_if(robots_, [](const Robot& r) { return !r.state; });
  for (const Robot& r : robots_)
    if (r.agent == agent_) state_ = r.state;
}

const ObjectState* VisibleObjects::ball() const {
  for (const ObjectState* o : field_)
    if (o->perceptName() == "B") return o;
  return nullptr;
}

}  // namespace spark::soccer
