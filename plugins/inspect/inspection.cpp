#include "inspection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/match.h"
#include "api/physics.h"
#include "spark/error.h"

namespace spark::inspect {

using Json = nlohmann::json;

namespace {
using namespace std::chrono_literals;

// Limits of an answer.
constexpr std::size_t kMaxContacts = 1024, kMaxJoints = 256, kMaxSeen = 512, kMaxLines = 256, kMaxTokens = 8192;

// Number of agents that are observed at the same time; a further one replaces the one that was requested longest ago.
constexpr std::size_t kMaxObserved = 4;
constexpr auto kObserveFor = 5s;  // after the last request

// Observing an agent takes place at most once per kObserveInterval, and takes at most 1 / kShare of wall time, so that
// it does not slow down a match that runs as fast as possible.
constexpr auto kObserveInterval = 40ms;
constexpr int kShare = 50;

/// Rounds to 0.1 mm: short, and exact enough for drawing.
double rounded(double v) { return std::round(v * 1e4) / 1e4; }

template <class Vector>
Json json(const Vector& v) {
  return {rounded(v.x()), rounded(v.y()), rounded(v.z())};
}

Json json(const Matrix& m) {
  Json out = Json::array();
  for (int i = 0; i < 16; ++i) out.push_back(rounded(double(m.data()[i])));
  return out;
}

/// An S-expression as JSON: lists are arrays, numbers that are not finite are null.
Json json(const Element& e) {
  if (!e.isList()) {
    const Token& token = e.token();
    if (token.kind == Token::Kind::integer) return e.integer();
    if (token.kind == Token::Kind::number)
      return std::isfinite(token.number) ? Json(rounded(token.number)) : Json(nullptr);
    return std::string(e.text());
  }
  Json out = Json::array();
  for (const Element inner : e) out.push_back(json(inner));
  return out;
}

const std::string& pathIn(const Json& request) {
  const auto at = request.find("path");
  if (at == request.end() || !at->is_string()) throw Error("the request lacks a text \"path\"");
  return at->get_ref<const std::string&>();
}

const char* nameOf(engine::JointType type) {
  switch (type) {
    case engine::JointType::ball:
      return "ball";
    case engine::JointType::hinge:
      return "hinge";
    case engine::JointType::hinge2:
      return "hinge2";
    case engine::JointType::slider:
      return "slider";
    case engine::JointType::universal:
      return "universal";
    case engine::JointType::fixed:
      return "fixed";
    case engine::JointType::angularMotor:
      return "motor";
  }
  return "";
}

Json describe(IJoint& joint) {
  const bool slides = joint.jointType() == engine::JointType::slider;
  const auto unit = [slides](double v) { return rounded(slides ? v : radToDeg(v)); };
  Json out{{"path", joint.leaf().path()}, {"type", nameOf(joint.jointType())}, {"anchor", json(joint.anchor())}};
  Json &axes = out["axes"] = Json::array(), &angles = out["angles"] = Json::array(),
       &rates = out["rates"] = Json::array();
  for (int axis = 0; axis < joint.axes(); ++axis) {
    axes.push_back(json(joint.axisNow(axis)));
    angles.push_back(unit(joint.angle(axis)));
    rates.push_back(unit(joint.angleRate(axis)));
  }
  if (joint.feedback()) out["torque"] = rounded(joint.feedbackTorque());
  if (joint.axes() == 0) return out;
  const double low = joint.parameter(engine::JointParameter::lowStop, 0),
               high = joint.parameter(engine::JointParameter::highStop, 0);
  if (std::isfinite(low)) out["low"] = unit(low);
  if (std::isfinite(high)) out["high"] = unit(high);
  return out;
}

Json describe(IEye& eye, const Leaf& leaf) {
  const auto [horizontal, vertical] = eye.cone();
  Json out{{"path", leaf.path()}, {"matrix", json(eye.view())}, {"horizontal", horizontal}, {"vertical", vertical}};
  if (const double range = eye.range(); std::isfinite(range)) out["range"] = range;
  return out;
}

/// Converts an eye's percept to world coordinates and adds the true positions.
class Sight {
 public:
  explicit Sight(IEye& eye) : eye_(eye) {
    eye.sights(truth_);
    std::stable_sort(truth_.begin(), truth_.end(),
                     [](const IEye::Sight& a, const IEye::Sight& b) { return a.name < b.name; });
  }

  void add(const ISightReader::Sightings& sightings) {
    for (const auto& thing : sightings.things) addThing(thing.name, thing.at);
    for (const auto& line : sightings.lines) addLine(line);
  }
  Json seen = Json::array(), lines = Json::array();

 private:
  using Polar = ISightReader::Polar;
  bool place(const Polar& polar, Vec3f& out) const {
    out = eye_.placeOf(polar.distance, polar.horizontalDeg, polar.verticalDeg);
    return out.allFinite();
  }
  void addThing(const std::string& name, const Polar& polar) {
    Vec3f where;
    if (seen.size() >= kMaxSeen || !place(polar, where)) return;
    Json thing{{"name", name}, {"seen", json(where)}};
    const auto at = std::lower_bound(truth_.begin(), truth_.end(), name,
                                     [](const IEye::Sight& s, const std::string& n) { return s.name < n; });
    if (at != truth_.end() && at->name == name) thing["true"] = json(at->place);
    seen.push_back(std::move(thing));
  }
  void addLine(const ISightReader::Sightings::Line& line) {
    Vec3f from, to;
    if (lines.size() < kMaxLines && place(line.from, from) && place(line.to, to))
      lines.push_back({json(from), json(to)});
  }

  IEye& eye_;
  std::vector<IEye::Sight> truth_;  ///< sorted by name
};

struct Eye {
  Perceptor* perceptor;
  IEye* eye;
};

std::vector<Eye> eyesOf(AgentAspect& agent) {
  std::vector<Perceptor*> all;
  agent.collect(all);
  std::vector<Eye> eyes;
  for (Perceptor* p : all)
    if (auto eye = p->as<IEye>()) eyes.push_back({p, eye});
  return eyes;
}

/// The agent that a node belongs to; nullptr if there is none.
AgentAspect* agentOf(Leaf& leaf) {
  AgentAspect* found = nullptr;
  for (Leaf* up = &leaf; up; up = up->parent())
    if (auto aspect = up->as<AgentAspect>()) found = aspect;
  return found;
}

}  // namespace

std::string Inspection::answer(const Json& request) {
  Json out;
  try {
    const std::string what = request.value("do", "");
    if (what == "contacts")
      out = contacts();
    else if (what == "joints")
      out = joints(request);
    else if (what == "percepts")
      out = percepts(request);
    else
      throw Error(fmt::format("expected contacts, joints or percepts, found '{}'", what));
    out["ok"] = true;
  } catch (const std::exception& e) {
    out = {{"ok", false}, {"error", e.what()}};
  }
  return out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

double Inspection::time() const {
  const auto* simulation = kernel_.root().find<ISimulation>();
  return simulation ? simulation->time() : 0;
}

Json Inspection::contacts() const {
  auto& physics = kernel_.root().require<IPhysicsServer>();
  Json list = Json::array();
  for (const engine::Contact& c : physics.contacts()) {
    if (list.size() >= kMaxContacts) break;
    ICollider &a = physics.colliderOf(c.ownerA), &b = physics.colliderOf(c.ownerB);
    if (!a.body() && !b.body()) continue;  // both are static
    list.push_back(
        {{"position", json(c.position)}, {"normal", json(c.normal)}, {"depth", rounded(c.depth)}, {"solved", c.solve}});
    Json& contact = list.back();
    if (c.solve && c.feedback) contact["force"] = json(c.forceOnA);
    contact["a"] = a.leaf().path();
    contact["b"] = b.leaf().path();
  }
  return {{"contacts", std::move(list)}};
}

Json Inspection::joints(const Json& request) const {
  Leaf& leaf = kernel_.root().require<Leaf>(pathIn(request));
  AgentAspect* agent = agentOf(leaf);
  Node* robot = agent ? agent : leaf.asNode();
  std::vector<IJoint*> joints;
  if (robot) robot->collect(joints);
  if (joints.size() > kMaxJoints) joints.resize(kMaxJoints);
  Json list = Json::array();
  for (IJoint* joint : joints) list.push_back(describe(*joint));
  return {{"joints", std::move(list)}};
}

Json Inspection::percepts(const Json& request) {
  const std::string& path = pathIn(request);
  AgentAspect* agent = agentOf(kernel_.root().require<Leaf>(path));
  if (!agent)
    throw Error(fmt::format("{} is no agent's: expected an agent, as below /usr/scene, or a node of one", path));
  const auto now = Clock::now();
  Observed& observed = this->observed(*agent);
  observed.requestedAt = now;
  if (observed.sight.is_null()) storeSight(observed, now);

  Json out{{"time", rounded(time())},
           {"percepts", Json::array()},
           {"seen", Json::array()},
           {"lines", Json::array()},
           {"cones", Json::array()}};
  // Its current percepts; if the eye did not see in this cycle, together with the stored percept of the eye.
  auto& control = kernel_.root().require<IGameControl>();
  bool sees = false;
  if (const Predicates* all = control.percepts(*agent); all && all->size() <= kMaxTokens)
    for (const Element e : *all) {
      sees |= !observed.see.is_null() && e.isList() && observed.see[0] == e.head();
      out["percepts"].push_back(json(e));
    }
  if (!observed.sight.is_null()) out.update(observed.sight);
  if (!sees && !observed.see.is_null()) out["percepts"].push_back(observed.see);
  for (const Eye& e : eyesOf(*agent)) {
    if (!out.contains("head")) out["head"] = json(e.eye->view());
    out["cones"].push_back(describe(*e.eye, *e.perceptor));
  }
  return out;
}

Inspection::Observed& Inspection::observed(AgentAspect& agent) {
  const auto known =
      std::find_if(observed_.begin(), observed_.end(), [&](const Observed& o) { return o.agent.get() == &agent; });
  if (known != observed_.end()) return *known;
  if (observed_.size() >= kMaxObserved)
    observed_.erase(std::min_element(observed_.begin(), observed_.end(), [](const Observed& a, const Observed& b) {
      return a.requestedAt < b.requestedAt;
    }));
  return observed_.emplace_back(Observed{Ref<AgentAspect>(&agent), {}, {}, nullptr, nullptr});
}

void Inspection::observe() {
  if (observed_.empty()) return;
  const auto* simulation = kernel_.root().find<ISimulation>();
  if (!simulation || std::exchange(lastCycle_, simulation->cycle()) == simulation->cycle()) return;
  const auto now = Clock::now();
  if (now < observeDue_) return;
  std::erase_if(observed_, [&](const Observed& o) { return !o.agent || now - o.requestedAt > kObserveFor; });
  for (Observed& o : observed_)
    if (now - o.storedAt >= kObserveInterval) storeSight(o, now);
  observeDue_ = now + (Clock::now() - now) * kShare;
}

/// Stores what the agent's first eye with a percept in this cycle sees.
void Inspection::storeSight(Observed& observed, Clock::time_point now) const {
  auto* control = kernel_.root().find<IGameControl>();
  const Predicates* all = control ? control->percepts(*observed.agent) : nullptr;
  if (!all || all->size() > kMaxTokens) return;
  for (const Eye& e : eyesOf(*observed.agent)) {
    const auto reader = e.perceptor->as<ISightReader>();
    if (!reader) continue;
    for (const Element see : *all) {
      if (see.head() != e.perceptor->predicateName()) continue;
      ISightReader::Sightings sightings;
      reader->read(see, sightings);
      Sight sight(*e.eye);
      sight.add(sightings);
      observed.storedAt = now;
      observed.see = json(see);
      observed.sight = {
          {"seenTime", rounded(time())}, {"seen", std::move(sight.seen)}, {"lines", std::move(sight.lines)}};
      return;
    }
  }
}

}  // namespace spark::inspect
