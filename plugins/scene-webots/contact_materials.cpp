#include "contact_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace spark::webots {

namespace {

constexpr const char* kOrdinary = "default";
constexpr double kFirmest = 1000;  ///< friction that nothing overcomes

/// The first number of `coulombFriction`; -1 means that nothing slides.
double frictionOf(Fields& f) {
  const Field* const given = f.node().field("coulombFriction");
  if (!given || given->value->numbers.size() <= 1) {
    const double one = f.number("coulombFriction", 1);
    return one == -1 ? kFirmest : one;
  }
  const std::vector<double>& all = *f.numbers("coulombFriction");
  if (std::any_of(all.begin(), all.end(), [&](double v) { return v != all.front(); }))
    f.wrong("coulombFriction",
            "a coulombFriction that differs in its directions is not supported: the first one counts");
  return all.front() == -1 ? kFirmest : all.front();
}

}  // namespace

void ContactMaterials::read(const Node& node, mjcf::Unsupported& unsupported) {
  Fields f(node, unsupported);
  f.ignore({"bumpSound", "rollSound", "slideSound", "maxContactJoints"});
  Pair p{&node, f.text("material1", kOrdinary), f.text("material2", kOrdinary), frictionOf(f)};
  if (!(p.friction >= 0)) {
    f.wrong("coulombFriction",
            fmt::format("expected a coulombFriction of 0 or more, or -1, found {}; 1 is taken", p.friction));
    p.friction = 1;
  }
  f.finish();
  const auto isSame = [&](const Pair& q) { return q.has(p.first) && q.other(p.first) == p.second; };
  if (std::any_of(pairs_.begin(), pairs_.end(), isSame))
    return unsupported.add(node.element(), "a second ContactProperties for two materials is ignored");
  pairs_.push_back(std::move(p));
}

void ContactMaterials::solve(mjcf::Unsupported& unsupported) {
  own_[kOrdinary] = 1;
  for (const Pair& p : pairs_)
    if (p.has(kOrdinary)) own_[p.other(kOrdinary)] = p.friction;
  // Of others each has what its partner lacks of the mean.
  for (const Pair& p : pairs_) {
    const auto first = own_.find(p.first), second = own_.find(p.second), none = own_.end();
    if (first == none && second == none)
      own_[p.first] = own_[p.second] = p.friction;
    else if (first == none)
      own_[p.first] = std::max(0.0, 2 * p.friction - second->second);
    else if (second == none)
      own_[p.second] = std::max(0.0, 2 * p.friction - first->second);
  }
  for (const Pair& p : pairs_)
    if (const double is = between(p); std::abs(is - p.friction) > 1e-9)
      unsupported.add(p.from->element(),
                      fmt::format("the friction of \"{}\" on \"{}\" is {:g}, not {:g}: two surfaces have the mean of "
                                  "theirs",
                                  p.first, p.second, is, p.friction));
}

double ContactMaterials::between(const Pair& p) const {
  if (p.has(kOrdinary)) return friction(p.other(kOrdinary));
  return (friction(p.first) + friction(p.second)) / 2;
}

double ContactMaterials::friction(const std::string& material) const {
  const auto found = own_.find(material);
  return found == own_.end() ? 1 : found->second;
}

bool ContactMaterials::rules(const std::string& material) const {
  return material != kOrdinary && (own_.contains(material) || friction(kOrdinary) != 1);
}

}  // namespace spark::webots
