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
template <class Numbers>
bool isRange(const Numbers& range) {
  return range[0] < range[1];
}
std::string sitePose(const std::array<double, 3>& point, const std::array<double, 4>& rotation) {
  return fmt::format(R"(pos="{}" quat="{}")", fmt::join(point, " "), fmt::join(rotation, " "));
}
std::string tendonName(int number) { return fmt::format("t{}", number); }
std::string siteName(int tendon, std::int64_t element) { return fmt::format("t{}s{}", tendon, element); }

}  // namespace

std::string actuatorName(int number) { return fmt::format("a{}", number); }

Constraints::Constraints(const Model& model, const Trees& trees)
    : model_(model), hasBody_(model.bodies.size(), 0), hasJoint_(model.joints.size(), 0) {
  for (const Link& link : trees.links) {
    hasBody_[link.body] = link.carrier == kNone;
    if (link.joint != kNone) hasJoint_[link.joint] = 1;
  }
  const engine::Blocks& blocks = model.extensions.world;
  for (const auto& [number, n] : blocks.all<PairNumbers>(kConstraintNumbers)) add(number, n);
  for (const auto& [number, n] : blocks.all<TendonNumbers>(kConstraintNumbers)) add(number, n);
  for (const auto& [number, n] : blocks.all<EqualityNumbers>(kConstraintNumbers)) add(number, n);
  for (const auto& [number, n] : blocks.all<ActuatorNumbers>(kConstraintNumbers)) add(number, n);
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

std::string Constraints::tendon(std::uint64_t target) const {
  const int number = static_cast<int>(target) - 1;
  return std::find(made_.begin(), made_.end(), number) == made_.end() ? "" : tendonName(number);
}

std::string Constraints::jointOfActuator(const ActuatorNumbers& n) const {
  if (n.ofFreeBody != 0) {
    const Index i = engine::indexOf(model_.bodies, n.target);
    return i == kNone || !hasBody_[i] || model_.bodies[i].joints > 0 ? "" : freeJointName(i);
  }
  const Index i = engine::indexOf(model_.joints, n.target);
  if (i != kNone && hasJoint_[i] && model_.joints[i].type == JointType::ball) return jointName(i, 0);
  return joint(n.target);
}

void Constraints::put(std::uint64_t body, const std::string& text) {
  sites_.emplace_back(body == 0 ? kNone : engine::indexOf(model_.bodies, body), text);
}

void Constraints::add(int number, const PairNumbers& n) {
  const Index first = engine::indexOf(model_.geoms, n.first), second = engine::indexOf(model_.geoms, n.second);
  if (n.first == 0 || n.second == 0 || first == kNone || second == kNone || first == second)
    return skipped_.push_back(number);
  mujoco::put(pairs_, R"(<pair geom1="{}" geom2="{}" condim="{}" friction="{}" solref="{}" solimp="{}")",
              geomName(first), geomName(second), n.condim, fmt::join(n.friction, " "), fmt::join(n.solref, " "),
              fmt::join(n.solimp, " "));
  mujoco::put(pairs_, "margin=\"{}\" gap=\"{}\"/>\n", n.margin, n.gap);
}

void Constraints::add(int number, const ActuatorNumbers& n) {
  const std::string_view type = ActuatorNumbers::kTypes[static_cast<std::size_t>(n.type)];
  const std::string name = actuatorName(number);
  std::string target;
  if (type == "tendon")
    target = tendon(n.target);
  else if (type == "joint" || type == "jointinparent")
    target = jointOfActuator(n);
  else
    target = body(n.target, n.part);
  if (n.lacks != 0 || target.empty()) return skipped_.push_back(number);
  // Those with an activation come last.
  std::string& out = n.dynamics == 0 ? actuators_ : dynamicActuators_;
  mujoco::put(out, R"(<general name="{}")", name);
  const auto site = [&](const char* attribute, const char* end, std::uint64_t of, const auto& point,
                        const auto& rotation) {
    put(of, fmt::format(R"(<site name="{}{}" {}/>)", name, end, sitePose(point, rotation)));
    mujoco::put(out, R"( {}="{}{}")", attribute, name, end);
  };
  if (type == "site" || type == "slidercrank") {
    site(type == "site" ? "site" : "cranksite", "s", n.target, n.point, n.rotation);
    if (n.hasReference != 0 || type == "slidercrank")
      site(type == "site" ? "refsite" : "slidersite", "r", n.reference, n.point2, n.rotation2);
    if (type == "slidercrank") mujoco::put(out, R"( cranklength="{}")", n.crankLength);
  } else {
    mujoco::put(out, R"( {}="{}")", type, target);
  }
  mujoco::put(out, R"( gear="{}" dyntype="{}" gaintype="{}" biastype="{}")", fmt::join(n.gear, " "),
              ActuatorNumbers::kDynamics[static_cast<std::size_t>(n.dynamics)],
              ActuatorNumbers::kGains[static_cast<std::size_t>(n.gain)],
              ActuatorNumbers::kBiases[static_cast<std::size_t>(n.bias)]);
  mujoco::put(out, R"( dynprm="{}" gainprm="{}" biasprm="{}")", fmt::join(n.dynamicsNumbers, " "),
              fmt::join(n.gainNumbers, " "), fmt::join(n.biasNumbers, " "));
  const auto range = [&](const char* attribute, const char* flag, const std::array<double, 2>& r) {
    if (isRange(r)) mujoco::put(out, R"( {}="true" {}="{} {}")", flag, attribute, r[0], r[1]);
  };
  range("ctrlrange", "ctrllimited", n.controlRange);
  range("forcerange", "forcelimited", n.forceRange);
  range("actrange", "actlimited", n.activationRange);
  if (isRange(n.lengthRange)) mujoco::put(out, R"( lengthrange="{}")", fmt::join(n.lengthRange, " "));
  out += "/>\n";
}

void Constraints::add(int number, const EqualityNumbers& n) {
  const bool tendons = n.type == 3, joints = n.type == 2 || tendons;
  const auto nameOf = [&](std::uint64_t id, std::int64_t part, int bit) {
    const bool named = (n.named & bit) != 0;
    if (named && id == 0) return std::string();  // it was not there
    if (joints) return !named ? "" : tendons ? tendon(id) : joint(id);
    return body(id, part);
  };
  const std::string first = nameOf(n.first, n.part1, 1), second = nameOf(n.second, n.part2, 2);
  const bool alone = joints && (n.named & 2) == 0;
  if (first.empty() || (second.empty() && !alone) || first == second) {
    skipped_.push_back(number);
    return;
  }
  const char* const type = EqualityNumbers::kTypes[static_cast<std::size_t>(n.type)];
  const char* const element = tendons ? "tendon" : joints ? "joint" : "body";
  mujoco::put(equalities_, R"(<{} name="{}" {}1="{}")", type, equalityName(number), element, first);
  if (!alone) mujoco::put(equalities_, R"( {}2="{}")", element, second);
  if (joints) mujoco::put(equalities_, R"( polycoef="{}")", fmt::join(n.polynomial, " "));
  if (n.type == 0) mujoco::put(equalities_, R"( anchor="{}")", fmt::join(n.anchor1, " "));
  if (n.type == 1) mujoco::put(equalities_, R"( torquescale="{}")", n.torqueScale);
  mujoco::put(equalities_, R"( active="{}" solref="{}" solimp="{}"/>)", n.active ? "true" : "false",
              fmt::join(n.solref, " "), fmt::join(n.solimp, " "));
  equalities_ += '\n';
}

void Constraints::add(int number, const TendonNumbers& n) {
  const auto count = std::clamp<std::int64_t>(n.count, 0, TendonNumbers::kMaxElements);
  std::string path;
  std::vector<std::pair<Index, std::string>> sites;
  bool whole = n.lacks == 0 && count >= (n.spatial ? 2 : 1);
  for (std::int64_t i = 0; i < count; ++i) {
    const TendonNumbers::Element& e = n.elements[static_cast<std::size_t>(i)];
    if (!n.spatial) {
      const std::string name = joint(e.id);
      whole = whole && !name.empty();
      mujoco::put(path, R"(<joint joint="{}" coef="{}"/>)", name, e.point[0]);
      continue;
    }
    if (e.kind == TendonNumbers::kPulley) {
      mujoco::put(path, R"(<pulley divisor="{}"/>)", e.point[0]);
      continue;
    }
    whole = whole && !body(e.id).empty() && !body(e.sideId).empty();
    const auto bodyOf = [&](std::uint64_t id) { return id == 0 ? kNone : engine::indexOf(model_.bodies, id); };
    const std::string name = siteName(number, i);
    if (e.kind == TendonNumbers::kPoint) {
      mujoco::put(path, R"(<site site="{}"/>)", name);
      sites.emplace_back(bodyOf(e.id), fmt::format(R"(<site name="{}" pos="{}"/>)", name, fmt::join(e.point, " ")));
      continue;
    }
    mujoco::put(path, R"(<geom geom="{}")", name);
    // It has no mass, and nothing touches it.
    sites.emplace_back(
        bodyOf(e.id),
        fmt::format(R"(<geom name="{}" type="{}" size="{} 1" {} contype="0" conaffinity="0"/>)", name,
                    e.kind == TendonNumbers::kSphere ? "sphere" : "cylinder", e.radius, sitePose(e.point, e.rotation)));
    if (e.hasSide != 0) {
      mujoco::put(path, R"( sidesite="{}s")", name);
      sites.emplace_back(bodyOf(e.sideId), fmt::format(R"(<site name="{}s" pos="{}"/>)", name, fmt::join(e.side, " ")));
    }
    path += "/>";
  }
  if (!whole) {
    skipped_.push_back(number);
    return;
  }
  made_.push_back(number);
  sites_.insert(sites_.end(), sites.begin(), sites.end());
  const char* const type = n.spatial ? "spatial" : "fixed";
  mujoco::put(tendons_, R"(<{} name="{}" stiffness="{}" damping="{}" frictionloss="{}")", type, tendonName(number),
              n.stiffness, n.damping, n.frictionLoss);
  if (n.limited && n.range[0] < n.range[1])
    mujoco::put(tendons_, R"( limited="true" range="{}" margin="{}")", fmt::join(n.range, " "), n.margin);
  mujoco::put(tendons_, R"( solreflimit="{}" solimplimit="{}" solreffriction="{}" solimpfriction="{}">)",
              fmt::join(n.limitSolref, " "), fmt::join(n.limitSolimp, " "), fmt::join(n.frictionSolref, " "),
              fmt::join(n.frictionSolimp, " "));
  mujoco::put(tendons_, "{}</{}>\n", path, type);
}

std::string Constraints::sites(Index body) const {
  std::string out;
  for (const auto& [of, text] : sites_)
    if (of == body) out += text;
  return out;
}

std::string Constraints::text() const {
  std::string out;
  if (!pairs_.empty()) mujoco::put(out, "<contact>\n{}</contact>\n", pairs_);
  if (!equalities_.empty()) mujoco::put(out, "<equality>\n{}</equality>\n", equalities_);
  if (!tendons_.empty()) mujoco::put(out, "<tendon>\n{}</tendon>\n", tendons_);
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
    if (const int i = mj_name2id(&m, mjOBJ_TENDON, tendonName(number).c_str());
        i >= 0 && (n.spatial == 0 || n.springLength >= 0))
      m.tendon_lengthspring[i] = n.springLength;
  for (const auto& [number, n] : blocks.all<FreedomNumbers>(kConstraintNumbers)) {
    if (n.ofBody == 0) continue;
    const Index body = engine::indexOf(model.bodies, n.of);
    const int joint = body == kNone ? -1 : mj_name2id(&m, mjOBJ_JOINT, freeJointName(body).c_str());
    if (joint < 0) continue;
    mjtNum* const rest = m.qpos_spring + m.jnt_qposadr[joint];
    std::copy(n.restPosition.begin(), n.restPosition.end(), rest);
    std::copy(n.restRotation.begin(), n.restRotation.end(), rest + 3);
  }
}

}  // namespace spark::mujoco
