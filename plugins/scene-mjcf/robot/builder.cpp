#include "builder.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <set>

#include "actuator_builder.h"
#include "api/agents.h"
#include "api/engine.h"
#include "api/extension.h"
#include "body_builder.h"
#include "constraint_builder.h"
#include "construction.h"
#include "geom_builder.h"
#include "sensor_builder.h"
#include "spark/access.h"

namespace spark::mjcf {

namespace {

/// World pose of the transform around a node.
Pose poseAround(Node& node) {
  const auto* const above = static_cast<SceneNode&>(node).transform();
  return above ? toPose(above->worldNow()) : Pose{};
}

/// The world of the scene that a node is in; nullptr when there is none.
Leaf* worldAround(Node& node) {
  for (Node* up = &node; up; up = up->parent())
    for (const auto& child : up->children())
      if (child->classObject()->name() == "World") return child.get();
  return nullptr;
}

/// True if a node of that class is below `node`.
bool hasBelow(const Node& node, std::string_view className) {
  return std::any_of(node.children().begin(), node.children().end(), [&](const auto& child) {
    const Node* const inner = child->asNode();
    return child->classObject()->name() == className || (inner && hasBelow(*inner, className));
  });
}

/// Says that the engine of the physics server does not read an extension; "": there is none, it reads it, or the
/// extension asks for nothing.
std::string withoutEffect(const engine::IExtension& e, const Leaf& node) {
  const Leaf* const server = node.kernel().root().find(IPhysicsServer::kPath);
  auto* const engine = server ? server->asNode()->childOf<engine::IEngine>() : nullptr;
  const std::string written = e.writtenAs();
  if (!engine || engine->reads(e.kind()) || written.empty()) return "";
  return fmt::format("{}: {} has no effect with {}", node.path(), written, engine->leaf().classObject()->name());
}

/// The robot of an agent can say that it has answered, so that lockstep waits for it, and senses the time.
void makeAgentParts(Construction& c, Node& root) {
  const AgentAspect* const nearest = root.as<AgentAspect>();
  const AgentAspect* const agent = nearest ? nearest : root.ancestor<AgentAspect>();
  if (!agent) return;
  const auto make = [&](const char* className, const char* name) {
    if (!hasBelow(*agent, className) && c.has(className)) c.top.create(className, c.names.unprefixed(c.top, name, ""));
  };
  c.names.effector("syn");  // an actuator of that name gets another one
  make("AgentSyncEffector", "syn");
  make("TimePerceptor", "time");
}

}  // namespace

void Builder::build(Node& root) {
  Names names(prefix_);
  Node& top = *root.create("Space", names.in(root, model_.name, "model")).asNode();
  try {
    if (!model_.selfCollides) callMethod(top, "disableInnerCollision", List{true});
    Construction c{model_, unsupported_, top, std::move(names), PlacedBodies(model_, poseAround(top))};
    if (prefix_.empty()) c.flags = model_.flags;
    BodyBuilder(c).build();
    GeomBuilder(c).build();
    ConstraintBuilder(c).build();
    makeAgentParts(c, root);
    ActuatorBuilder(c).build();
    SensorBuilder(c).build();
    withoutParts_ = c.withoutParts;
    if (!model_.options.empty() && !prefix_.empty())
      unsupported_.add(model_.options.front().from,
                       "the options of an attached model are ignored: the world has its own");
    if (prefix_.empty()) compareTimesteps(root);
    if (strict_) refuseLosses(top);
    if (prefix_.empty()) setOptions(root);
  } catch (...) {
    root.remove(top);
    throw;
  }
}

/// Throws Error if something is left out, is changed, or has no effect with the engine.
void Builder::refuseLosses(Node& top) const {
  std::vector<std::string> losses = unsupported_.sentences();
  std::set<std::uint64_t> known;  // kinds
  const std::function<void(const Leaf&)> visit = [&](const Leaf& leaf) {
    const engine::IExtension* const e = leaf.as<engine::IExtension>();
    if (std::string text = e ? withoutEffect(*e, leaf) : ""; !text.empty() && known.insert(e->kind()).second)
      losses.push_back(std::move(text));
    if (const Node* const node = leaf.asNode())
      for (const auto& child : node->children()) visit(*child);
  };
  visit(top);
  if (!losses.empty()) throw Error(fmt::format("{}", fmt::join(losses, "; ")));
}

/// A cycle has a whole number of steps, so their length may differ from that of the file.
void Builder::compareTimesteps(Node& root) {
  const Leaf* const simulation = root.kernel().root().find("/sys/server/simulation");
  if (!simulation || !simulation->classObject()->property("step")) return;
  const double cycle = getProperty(*simulation, "step").toNumber();
  for (const Option& o : model_.options) {
    if (std::string_view(o.property) != "timestep") continue;
    const double wanted = o.value.toNumber(), steps = std::max(1.0, std::round(cycle / wanted));
    if (cycle > 0 && std::abs(cycle / steps - wanted) > 1e-9 * wanted)
      unsupported_.add(
          o.from, fmt::format("the timestep of {} s does not divide the cycle of {} s: {} of {:.6g} s each "
                              "are used in its place",
                              wanted, cycle, steps == 1 ? "steps" : fmt::format("{} steps", steps), cycle / steps));
  }
}

void Builder::setOptions(Node& root) {
  Leaf* const world = worldAround(root);
  if (!world) return;
  ISceneServer* const scenes = root.kernel().root().find<ISceneServer>();
  struct Old {
    Leaf* node;
    const char* property;
    Value value;
  };
  std::vector<Old> before;
  if (Leaf* const node = model_.meshesAreHulls ? extensionOf(*world, "MujocoOptions") : nullptr) {
    // As in MuJoCo alone.
    if (scenes) scenes->willChange(*node);
    setWritten(*node, "");
    for (const char* const property : {"allContacts", "explicitLaws"}) {
      before.push_back({node, property, getProperty(*node, property)});
      setProperty(*node, property, true);
    }
  }
  for (const Option& o : model_.options) {
    Leaf* const node = o.ofMujoco ? extensionOf(*world, "MujocoOptions") : world;
    if (!node) continue;
    if (scenes) scenes->willChange(*node);
    try {
      before.push_back({node, o.property, getProperty(*node, o.property)});
      setProperty(*node, o.property, o.value);
      // What is so anyway is nothing lost.
      if (!o.ofMujoco || getProperty(*node, o.property) == before.back().value) continue;
      setWritten(*node, o.from.placed());
      const std::string text = withoutEffect(*node->as<engine::IExtension>(), *node);
      if (strict_ && !text.empty()) throw Error(text);
    } catch (const Error& e) {
      for (auto old = before.rbegin(); old != before.rend(); ++old) setProperty(*old->node, old->property, old->value);
      throw Error(o.from.where() + ": cannot set an option", e);
    }
  }
}

}  // namespace spark::mjcf
