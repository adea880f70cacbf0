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

std::optional<double> ContactMaterials::known(const std::string& material) const {
  const auto found = own_.find(material);
  return found == own_.end() ? std::nullopt : std::optional(found->second);
}

/// Gives each material of a pair whose other one is known what is missing to the mean.
void ContactMaterials::spread() {
  for (bool isNew = true; std::exchange(isNew, false);)
    for (const Pair& p : pairs_)
      for (const std::string* const material : {&p.first, &p.second}) {
        const auto other = known(p.other(*material));
        if (!other || known(*material)) continue;
        own_.emplace(*material, std::max(0.0, 2 * p.friction - *other));
        isNew = true;
      }
}

void ContactMaterials::solve(mjcf::Unsupported& unsupported) {
  own_.emplace(kOrdinary, 1);
  for (const Pair& p : pairs_)
    if (p.first == kOrdinary && p.second == kOrdinary) own_[kOrdinary] = p.friction;
  spread();
  // Materials that are listed among themselves alone.
  for (const Pair& p : pairs_)
    if (!known(p.first)) {
      own_.emplace(p.first, p.first == p.second ? p.friction : std::max(0.0, 2 - own_[kOrdinary]));
      spread();
    }
  for (const Pair& p : pairs_)
    if (const double mean = (own_[p.first] + own_[p.second]) / 2; std::abs(mean - p.friction) > 1e-9)
      unsupported.add(
          p.from->element(),
          fmt::format("the friction of \"{}\" on \"{}\" is {:g}, not {:g}: surfaces that touch have the mean "
                      "of theirs",
                      p.first, p.second, mean, p.friction));
}

Roughness ContactMaterials::of(const std::string& material) const {
  const double ordinary = known(kOrdinary).value_or(1);
  // A material that is not listed has a friction of 1 on "default".
  const double own = known(material).value_or(std::max(0.0, 2 - ordinary));
  Roughness out{own, (own + ordinary) / 2, own == ordinary};
  for (const Pair& p : pairs_)
    if (p.has(material) && p.other(material) == kOrdinary)
      out.beside = p.friction, out.isOrdinary = material == kOrdinary;
  return out;
}

}  // namespace spark::webots
