#include "scene_feed.h"

#include <algorithm>

#include "api/physics.h"
#include "api/scene_calls.h"
#include "messages.h"
#include "spark/access.h"
#include "wire.h"

// Poses change in each cycle and are compared in each. Looks and shapes change seldom: a few nodes are compared in each
// cycle in turn, all when the scene server counts a change, and a node that the client changes at once. One message is
// on its way at a time, so that a client that is slower than this host gets the newest values and no queue of old ones;
// what a handler or an answer depends on is sent in any case.

namespace spark::remote {

namespace {
constexpr std::size_t kMostPoses = 4096;         // in a message; others follow in the next
constexpr std::size_t kMostLookBytes = 1 << 20;  // in a message, after which no other is begun
constexpr std::size_t kLooks = 32;               // compared in a cycle
constexpr std::size_t kMostFollowed = 10'000;    // properties

List numbersOf(const Matrix& m) {
  List all;
  all.reserve(16);
  for (int i = 0; i < 16; ++i) all.emplace_back(double(m.data()[i]));
  return all;
}

/// Files leave out calls for what a new node is anyway; a node that has been something else needs them.
void addDefaults(const Leaf& leaf, List& calls) {
  const auto lacks = [&](std::string_view method) {
    return std::none_of(calls.begin(), calls.end(),
                        [&](const Value& call) { return call.toList()[0].toString() == method; });
  };
  if (leaf.as<ICollider>() && lacks("setLocalPose"))
    calls.insert(calls.begin(), List{"setLocalPose", List{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}});
  if (leaf.as<IVisual>() && leaf.classObject()->method("setScale") && lacks("setScale"))
    calls.emplace_back(List{"setScale", List{1, 1, 1}});
}

/// Calls and properties that make a new node of its class what `leaf` is.
List lookOf(Leaf& leaf) {
  List calls, properties;
  const auto described = leaf.as<ISceneCalls>();
  std::vector<std::string_view> byCalls;
  if (described) {
    byCalls = described->setByCalls();
    for (SceneCall& call : described->sceneCalls()) calls.emplace_back(List{call.method, std::move(call.arguments)});
  }
  addDefaults(leaf, calls);
  for (const Property* p : leaf.classObject()->properties()) {
    if (p->readOnly || p->ofProcess || p->name == "name" ||
        std::find(byCalls.begin(), byCalls.end(), p->name) != byCalls.end())
      continue;
    properties.emplace_back(List{p->name, p->get(leaf)});
  }
  return {std::move(calls), std::move(properties)};
}

/// The same, encoded; "" if it cannot be expressed.
std::string encodedLook(Leaf& leaf, List& look) {
  try {
    look = lookOf(leaf);
    return encode({"look", look});
  } catch (const std::exception&) {
    return {};
  }
}

std::string encodedValue(const Value& value) { return encode({"value", value}); }
}  // namespace

bool isOfScene(ClassObject& c) {
  if (c.isAbstract() || !c.isA(SceneNode::kClassName)) return false;
  if (c.isA(Transform::kClassName)) return true;
  try {
    if (!c.hooks().empty()) return false;
  } catch (const Error&) {  // a base is missing
    return false;
  }
  if (c.isA("PlaneCollider") || c.isA("RayCollider")) return false;
  return c.isA("Axis") || c.isA("Camera") || c.isA("RecorderHandler") || c.isA(ContactJointHandler::kClassName) ||
         c.isOrOffers(std::string(IVisual::kInterface.name)) || c.isOrOffers(std::string(ICollider::kInterface.name));
}

bool SceneFeed::isOfScene(const Leaf& leaf) {
  const auto [at, isNew] = classes_.try_emplace(leaf.classObject()->id());
  if (isNew) at->second = remote::isOfScene(*leaf.classObject());
  return at->second;
}

Value SceneFeed::describe(Leaf& leaf) {
  if (!wanted_ || !isOfScene(leaf)) return {};
  Known& known = known_[leaf.id()];
  if (const auto transform = leaf.as<Transform>()) {
    known.pose = transform->local();
    return List{numbersOf(known.pose), List(), List()};
  }
  List look;
  known.look = encodedLook(leaf, look);
  if (known.look.empty()) return {};
  return List{List(), std::move(look[0]), std::move(look[1])};
}

bool SceneFeed::follow(Leaf& leaf, const std::string& property, const Value& value) {
  if (isFollowed_.contains({leaf.id(), property})) return true;
  if (followed_.size() >= kMostFollowed) return false;
  isFollowed_.emplace(leaf.id(), property);
  followed_.push_back({Ref<Leaf>(&leaf), leaf.id(), property, encodedValue(value)});
  return true;
}

void SceneFeed::collect(Node& root) {
  root_ = root.id();
  version_ = root.changedAt();
  ++round_;
  places_.clear();
  looks_.clear();
  std::vector<SceneNode*> all;
  root.collect(all);
  for (SceneNode* node : all) {
    if (!isOfScene(*node)) continue;
    Known& known = known_[node->id()];
    known.round = round_;
    const auto transform = node->as<Transform>();
    (transform ? places_ : looks_).push_back({node, transform, &known});
  }
  std::erase_if(known_, [&](const auto& known) { return known.second.round != round_; });
}

void SceneFeed::update(Node& root, bool now, const ISimulation* simulation, Wire& out) {
  const std::int64_t cycle = simulation ? simulation->cycle() : 0;
  if (!now && (handled_ < sent_ || cycle == cycle_)) return;
  List poses, looks;
  if (wanted_) {
    if (root_ != root.id() || version_ != root.changedAt()) collect(root);
    poses = this->poses();
    const auto* const scenes = root.kernel().root().find<ISceneServer>();
    const std::uint64_t modified = scenes ? scenes->modifiedCount() : 0;
    const bool shown = std::exchange(modified_, modified) != modified;
    looks = this->looks(shown ? looks_.size() : now ? 0 : kLooks);
  }
  List values = this->values();
  if (now && poses.empty() && looks.empty() && values.empty()) return;
  cycle_ = cycle;
  out.send({kScene, ++sent_, std::move(poses), std::move(looks), std::move(values)});
}

/// {id, 16 numbers} of each transform that has moved.
List SceneFeed::poses() {
  List moved;
  for (Entry& e : places_) {
    if (e.transform->local() == e.known->pose) continue;
    if (moved.size() == kMostPoses) break;
    e.known->pose = e.transform->local();
    moved.emplace_back(List{e.leaf->id(), numbersOf(e.known->pose)});
  }
  return moved;
}

/// {id, calls, properties} of nodes that are not what they were: those that the client has changed, and of the next
/// `count`.
List SceneFeed::looks(std::size_t count) {
  List changed;
  std::size_t bytes = 0;
  if (!touched_.empty()) {
    for (Entry& e : looks_)
      if (touched_.contains(e.leaf->id())) compare(e, changed, bytes);
    touched_.clear();
  }
  for (std::size_t n = std::min(count, looks_.size()); n > 0 && bytes < kMostLookBytes; --n) {
    if (next_ >= looks_.size()) next_ = 0;
    compare(looks_[next_++], changed, bytes);
  }
  return changed;
}

void SceneFeed::compare(Entry& entry, List& changed, std::size_t& bytes) {
  List look;
  std::string encoded = encodedLook(*entry.leaf, look);
  if (encoded.empty() || encoded == entry.known->look) return;
  bytes += encoded.size();
  entry.known->look = std::move(encoded);
  changed.emplace_back(List{entry.leaf->id(), std::move(look[0]), std::move(look[1])});
}

/// {id, property, value} of each followed property that has another value.
List SceneFeed::values() {
  List changed;
  std::erase_if(followed_, [this](const Followed& f) {
    if (!f.leaf) isFollowed_.erase({f.id, f.property});
    return !f.leaf;
  });
  for (Followed& f : followed_) try {
      Value value = getProperty(*f.leaf, f.property);
      std::string encoded = encodedValue(value);
      if (encoded == f.value) continue;
      f.value = std::move(encoded);
      changed.emplace_back(List{f.id, f.property, std::move(value)});
    } catch (const std::exception&) {  // it has none now
    }
  return changed;
}

}  // namespace spark::remote
