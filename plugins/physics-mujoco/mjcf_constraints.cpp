#include "mjcf_constraints.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <iterator>

namespace spark::mujoco {

using engine::JointType;
using engine::Model;

namespace {

template <class... A>
void put(std::string& out, fmt::format_string<A...> format, A&&... arguments) {
  fmt::format_to(std::back_inserter(out), format, std::forward<A>(arguments)...);
}

std::string equalityName(int number) { return fmt::format("e{}", number); }
std::string tendonName(int number) { return fmt::format("t{}", number); }
std::string siteName(int tendon, std::int64_t element) { return fmt::format("t{}s{}", tendon, element); }

}  // namespace

Constraints::Constraints(const Model& model, const Trees& trees)
    : model_(model), hasBody_(model.bodies.size(), 0), hasJoint_(model.joints.size(), 0) {
  for (const Link& link : trees.links) {
    hasBody_[link.body] = link.carrier == kNone;
    if (link.joint != kNone) hasJoint_[link.joint] = 1;
  }
  for (const auto& [number, n] : model.extensions.world.all<EqualityNumbers>(kConstraintNumbers)) add(number, n);
  for (const auto& [number, n] : model.extensions.world.all<TendonNumbers>(kConstraintNumbers)) add(number, n);
}

std::string Constraints::body(std::uint64_t id, std::int64_t part) const {
  if (id == 0) return "world";
  const Index i = engine::indexOf(model_.bodies, id);
  if (i == kNone || !hasBody_[i]) return "";
  const auto k = static_cast<std::size_t>(part);
  return part > 0 && k < model_.bodies[i].parts.size() ? partName(i, k) : bodyName(i);
}

std::string Constraints::joint(std::uint64_t id) const {
  const Index i = id == 0 ? kNone : engine::indexOf(model_.joints, id);
  if (i == kNone || !hasJoint_[i]) return "";
  const JointType type = model_.joints[i].type;
  return type == JointType::hinge || type == JointType::slider ? jointName(i, 0) : "";
}

void Constraints::add(int number, const EqualityNumbers& n) {
  const bool joints = n.type == 2;
  const auto nameOf = [&](std::uint64_t id, std::int64_t part, int bit) {
    const bool named = (n.named & bit) != 0;
    if (named && id == 0) return std::string();  // it was not there
    return joints ? named ? joint(id) : "" : body(id, part);
  };
  const std::string first = nameOf(n.first, n.part1, 1), second = nameOf(n.second, n.part2, 2);
  const bool alone = joints && (n.named & 2) == 0;
  if (first.empty() || (second.empty() && !alone) || first == second) {
    skipped_.push_back(number);
    return;
  }
  const char* const type = EqualityNumbers::kTypes[static_cast<std::size_t>(n.type)];
  put(equalities_, R"(<{} name="{}" {}1="{}")", type, equalityName(number), joints ? "joint" : "body", first);
  if (!alone) put(equalities_, R"( {}2="{}")", joints ? "joint" : "body", second);
  if (joints) put(equalities_, R"( polycoef="{}")", fmt::join(n.polynomial, " "));
  if (n.type == 0) put(equalities_, R"( anchor="{}")", fmt::join(n.anchor1, " "));
  if (n.type == 1) put(equalities_, R"( torquescale="{}")", n.torqueScale);
  put(equalities_, R"( active="{}" solref="{}" solimp="{}"/>)", n.active ? "true" : "false", fmt::join(n.solref, " "),
      fmt::join(n.solimp, " "));
  equalities_ += '\n';
}

void Constraints::add(int number, const TendonNumbers& n) {
  const auto count = std::clamp<std::int64_t>(n.count, 0, TendonNumbers::kMaxElements);
  std::string path;
  std::vector<std::pair<Index, std::string>> sites;
  bool whole = n.lacks == 0 && count >= (n.spatial ? 2 : 1);
  for (std::int64_t i = 0; i < count; ++i) {
    const TendonNumbers::Element& e = n.elements[static_cast<std::size_t>(i)];
    const std::string name = n.spatial ? body(e.id) : joint(e.id);
    whole = whole && !name.empty();
    if (n.spatial) {
      put(path, R"(<site site="{}"/>)", siteName(number, i));
      sites.emplace_back(e.id == 0 ? kNone : engine::indexOf(model_.bodies, e.id),
                         fmt::format(R"(<site name="{}" pos="{}"/>)", siteName(number, i), fmt::join(e.point, " ")));
    } else {
      put(path, R"(<joint joint="{}" coef="{}"/>)", name, e.point[0]);
    }
  }
  if (!whole) {
    skipped_.push_back(number);
    return;
  }
  sites_.insert(sites_.end(), sites.begin(), sites.end());
  const char* const type = n.spatial ? "spatial" : "fixed";
  put(tendons_, R"(<{} name="{}" stiffness="{}" damping="{}" frictionloss="{}")", type, tendonName(number), n.stiffness,
      n.damping, n.frictionLoss);
  if (n.limited && n.range[0] < n.range[1])
    put(tendons_, R"( limited="true" range="{}" margin="{}")", fmt::join(n.range, " "), n.margin);
  put(tendons_, R"( solreflimit="{}" solimplimit="{}" solreffriction="{}" solimpfriction="{}">)",
      fmt::join(n.limitSolref, " "), fmt::join(n.limitSolimp, " "), fmt::join(n.frictionSolref, " "),
      fmt::join(n.frictionSolimp, " "));
  put(tendons_, "{}</{}>\n", path, type);
}

std::string Constraints::sites(Index body) const {
  std::string out;
  for (const auto& [of, text] : sites_)
    if (of == body) out += text;
  return out;
}

std::string Constraints::text() const {
  std::string out;
  if (!equalities_.empty()) put(out, "<equality>\n{}</equality>\n", equalities_);
  if (!tendons_.empty()) put(out, "<tendon>\n{}</tendon>\n", tendons_);
  return out;
}

void placeConstraints(const Model& model, mjModel& m) {
  const engine::Blocks& blocks = model.extensions.world;
  for (const auto& [number, n] : blocks.all<EqualityNumbers>(kConstraintNumbers)) {
    const int i = mj_name2id(&m, mjOBJ_EQUALITY, equalityName(number).c_str());
    if (i < 0) continue;
    mjtNum* const data = m.eq_data + mjNEQDATA * i;
    if (m.eq_type[i] == mjEQ_CONNECT) {
      std::copy(n.anchor1.begin(), n.anchor1.end(), data);
      std::copy(n.anchor2.begin(), n.anchor2.end(), data + 3);
    } else if (m.eq_type[i] == mjEQ_WELD) {
      std::copy(n.anchor2.begin(), n.anchor2.end(), data);
      std::copy(n.anchor1.begin(), n.anchor1.end(), data + 3);
      std::copy(n.rotation.begin(), n.rotation.end(), data + 6);
      mju_normalize4(data + 6);
    }
  }
  for (const auto& [number, n] : blocks.all<TendonNumbers>(kConstraintNumbers))
    if (const int i = mj_name2id(&m, mjOBJ_TENDON, tendonName(number).c_str()); i >= 0)
      m.tendon_lengthspring[i] = n.springLength;
}

}  // namespace spark::mujoco
