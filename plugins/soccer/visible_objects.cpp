#include "visible_objects.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace spark::soccer {

namespace {
IRigidBody* bodyOf(const Transform* frame) { return frame ? frame->childOf<IRigidBody>() : nullptr; }
}  // namespace

void VisibleObjects::update(Kernel& kernel, float range) {
  if (tree_.changed(kernel.root())) collect(kernel);
  updatePositions();

  // The first limited range sets the cell size, so that an eye with that range reads at most three cells in each row.
  cells_.clear();
  if (cellSize_ == kUnlimited) cellSize_ = std::max(range, kMinCellSize);
  if (cellSize_ < kUnlimited) sortIntoCells();
}

void VisibleObjects::share(Kernel& kernel, std::uint64_t round, float range) {
  const bool needsCells = range < kUnlimited && cellSize_ == kUnlimited;
  if (round_ == round && !tree_.isStale(kernel.root()) && !needsCells) return;
  round_ = round;
  update(kernel, range);
}

void VisibleObjects::collect(Kernel& kernel) {
  field_.clear();
  parts_.clear();
  robots_.clear();
  lines_.clear();
  states_.clear();
  ISceneServer* server = kernel.root().find<ISceneServer>();
  Node* scene = server ? server->activeScene() : nullptr;
  if (!scene) return;

  std::vector<Line*> lines;
  scene->collect(lines);
  for (const Line* line : lines) lines_.push_back({line});

  // Objects outside of robots belong to the field. In a robot there is one AgentState; the other objects are parts.
  std::vector<ObjectState*> all;
  scene->collect(all);
  for (ObjectState* o : all) {
    auto* inner = o->ancestor<AgentAspect>();
    if (!inner) {
      if (!o->perceptName().empty()) field_.push_back({o, o->transform(), bodyOf(o->transform())});
      continue;
    }
    AgentAspect* agent = &inner->outermost();
    if (robots_.empty() || robots_.back().agent != agent)
      robots_.push_back({.agent = agent, .firstPart = static_cast<std::uint32_t>(parts_.size())});
    Robot& robot = robots_.back();
    if (auto state = o->as<AgentState>()) {
      robot.state = state;
      robot.frame = state->transform();
      robot.body = bodyOf(robot.frame);
    } else if (!o->id().empty()) {
      parts_.push_back({o, o->transform(), bodyOf(o->transform())});
      ++robot.parts;
    }
  }

  std::erase_if(robots_, [](const Robot& r) { return !r.state; });
  for (const Robot& r : robots_) states_.emplace_back(r.agent, r.state);
  std::stable_sort(states_.begin(), states_.end(),
                   [](const auto& a, const auto& b) { return std::less<>()(a.first, b.first); });
}

void VisibleObjects::updatePositions() {
  for (Object& o : field_) o.position = worldPosition(o.frame);
  for (Object& o : parts_) o.position = worldPosition(o.frame);
  for (Robot& r : robots_) r.position = worldPosition(r.frame);
  for (FieldLine& l : lines_) {
    const Matrix frame = l.line->transform() ? l.line->transform()->world() : Matrix(Matrix::Identity());
    l.begin = frame.block<3, 3>(0, 0) * l.line->begin() + positionOf(frame);
    l.end = frame.block<3, 3>(0, 0) * l.line->end() + positionOf(frame);
  }
}

const VisibleObjects::Object* VisibleObjects::ball() const {
  for (const Object& o : field_)
    if (o.state->perceptName() == "B") return &o;
  return nullptr;
}

AgentState* VisibleObjects::stateOf(const AgentAspect* agent) const {
  const auto next = std::upper_bound(states_.begin(), states_.end(), agent,
                                     [](const AgentAspect* a, const auto& s) { return std::less<>()(a, s.first); });
  return next != states_.begin() && std::prev(next)->first == agent ? std::prev(next)->second : nullptr;
}

std::uint32_t VisibleObjects::cellOf(float coordinate) const {
  constexpr std::int32_t kMiddle = 1 << 30;  // of the origin
  const float cells = std::floor(coordinate / cellSize_), limit = static_cast<float>(kMiddle);
  return static_cast<std::uint32_t>(
      kMiddle + (cells > -limit ? static_cast<std::int32_t>(std::min(cells, limit / 2)) : -kMiddle));
}

void VisibleObjects::sortIntoCells() {
  const auto add = [this](const Vec3f& p, std::uint32_t robot) {
    cells_.emplace_back(Cell{cellOf(p.y())} << 32 | cellOf(p.x()), robot);
  };
  for (std::uint32_t i = 0; i < robots_.size(); ++i) {
    add(robots_[i].position, i);
    for (const Object& part : partsOf(robots_[i])) add(part.position, i);
  }
  std::sort(cells_.begin(), cells_.end());
}

void VisibleObjects::findAll(std::vector<std::uint32_t>& out) const {
  out.resize(robots_.size());
  std::iota(out.begin(), out.end(), 0U);
}

void VisibleObjects::findNear(const Vec3f& position, float range, std::vector<std::uint32_t>& out) const {
  out.clear();
  if (range == kUnlimited) return findAll(out);
  const std::uint32_t left = cellOf(position.x() - range), right = cellOf(position.x() + range);
  const std::uint32_t first = cellOf(position.y() - range), last = cellOf(position.y() + range);
  if (last - first > robots_.size()) return findAll(out);  // the cells are much smaller than this range
  for (std::uint32_t row = first; row <= last; ++row) {
    const Cell end = Cell{row} << 32 | right;
    auto it = std::lower_bound(cells_.begin(), cells_.end(), std::pair(Cell{row} << 32 | left, std::uint32_t{0}));
    for (; it != cells_.end() && it->first <= end; ++it) out.push_back(it->second);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
}

}  // namespace spark::soccer
