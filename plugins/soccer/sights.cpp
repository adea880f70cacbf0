#include "sights.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace spark::soccer {

void Sights::update(Kernel& kernel, float range) {
  if (tree_.changed(kernel.root())) collect(kernel);
  place();
  cells_.clear();
  if (cell_ == kUnlimited) cell_ = std::max(range, kLeastCell);
  if (cell_ < kUnlimited) sortIntoCells();
}

void Sights::share(Kernel& kernel, std::uint64_t round, float range) {
  const bool wantsCells = range < kUnlimited && cell_ == kUnlimited;
  if (round_ == round && !tree_.isStale(kernel.root()) && !wantsCells) return;
  round_ = round;
  update(kernel, range);
}

void Sights::collect(Kernel& kernel) {
  field_.clear();
  parts_.clear();
  robots_.clear();
  lines_.clear();
  states_.clear();
  Node* scene = kernel.root().find<Node>("/usr/scene");
  if (!scene) return;
  std::vector<Line*> lines;
  scene->collect(lines);
  for (const Line* line : lines) lines_.push_back({line});
  std::vector<ObjectState*> all;
  scene->collect(all);
  for (ObjectState* o : all) {
    auto* inner = o->ancestor<AgentAspect>();
    if (!inner) {
      if (!o->perceptName().empty()) field_.push_back({o, o->transform()});
      continue;
    }
    AgentAspect* agent = &inner->outermost();
    if (robots_.empty() || robots_.back().agent != agent)
      robots_.push_back({.agent = agent, .firstPart = static_cast<std::uint32_t>(parts_.size())});
    Robot& robot = robots_.back();
    if (auto state = o->as<AgentState>()) {
      robot.state = state;
      robot.frame = state->transform();
    } else if (!o->id().empty()) {
      parts_.push_back({o, o->transform()});
      ++robot.parts;
    }
  }
  std::erase_if(robots_, [](const Robot& r) { return !r.state; });
  for (const Robot& r : robots_) states_.emplace_back(r.agent, r.state);
  std::stable_sort(states_.begin(), states_.end(),
                   [](const auto& a, const auto& b) { return std::less<>()(a.first, b.first); });
}

void Sights::place() {
  for (Mark& m : field_) m.place = placeOf(m.frame);
  for (Mark& m : parts_) m.place = placeOf(m.frame);
  for (Robot& r : robots_) r.place = placeOf(r.frame);
  for (Stroke& s : lines_) {
    const Matrix frame = s.line->transform() ? s.line->transform()->world() : Matrix(Matrix::Identity());
    s.begin = frame.block<3, 3>(0, 0) * s.line->begin() + positionOf(frame);
    s.end = frame.block<3, 3>(0, 0) * s.line->end() + positionOf(frame);
  }
}

const Sights::Mark* Sights::ball() const {
  for (const Mark& m : field_)
    if (m.object->perceptName() == "B") return &m;
  return nullptr;
}

AgentState* Sights::stateOf(const AgentAspect* agent) const {
  const auto behind = std::upper_bound(states_.begin(), states_.end(), agent,
                                       [](const AgentAspect* a, const auto& s) { return std::less<>()(a, s.first); });
  return behind != states_.begin() && std::prev(behind)->first == agent ? std::prev(behind)->second : nullptr;
}

/// Counted from far out; what is farther out, or nowhere, is in the last.
std::uint32_t Sights::cellOf(float coordinate) const {
  constexpr std::int32_t kMiddle = 1 << 30;
  const float cells = std::floor(coordinate / cell_), far = static_cast<float>(kMiddle);
  return static_cast<std::uint32_t>(kMiddle +
                                    (cells > -far ? static_cast<std::int32_t>(std::min(cells, far / 2)) : -kMiddle));
}

void Sights::sortIntoCells() {
  const auto put = [this](const Vec3f& place, std::size_t robot) {
    cells_.emplace_back(Cell{cellOf(place.y())} << 32 | cellOf(place.x()), static_cast<std::uint32_t>(robot));
  };
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    put(robots_[i].place, i);
    for (const Mark& part : partsOf(robots_[i])) put(part.place, i);
  }
  std::sort(cells_.begin(), cells_.end());
}

void Sights::all(std::vector<std::uint32_t>& out) const {
  out.resize(robots_.size());
  std::iota(out.begin(), out.end(), 0u);
}

void Sights::near(const Vec3f& place, float range, std::vector<std::uint32_t>& out) const {
  out.clear();
  if (range == kUnlimited) return all(out);
  const std::uint32_t left = cellOf(place.x() - range), right = cellOf(place.x() + range);
  const std::uint32_t first = cellOf(place.y() - range), last = cellOf(place.y() + range);
  if (last - first > robots_.size()) return all(out);  // it sees farther than those for whom the cells were made
  for (std::uint32_t row = first; row <= last; ++row) {
    const Cell end = Cell{row} << 32 | right;
    auto it = std::lower_bound(cells_.begin(), cells_.end(), std::pair(Cell{row} << 32 | left, std::uint32_t{0}));
    for (; it != cells_.end() && it->first <= end; ++it) out.push_back(it->second);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
}

}  // namespace spark::soccer
