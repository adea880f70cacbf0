#include "handlers.h"

#include <algorithm>

#include "spark/script.h"

namespace spark {

void RecorderHandler::describe(Description<RecorderHandler>& d) {
  d.doc("Records which colliders touched the one above it.");
  d.implements<ICollisionRecorder>();
  d.property("colliders", &RecorderHandler::paths).doc("Paths of the colliders that touched since clear().");
  d.method("clear", &RecorderHandler::clear).doc("Empties the record.");
}

void RecorderHandler::onCollision(const Collision& collision) {
  Leaf* other = &collision.other.leaf();
  for (const Ref<Leaf>& known : colliders_)
    if (known.get() == other) return;
  std::erase_if(colliders_, [](const Ref<Leaf>& r) { return !r; });
  colliders_.push_back(Ref<Leaf>(other));
}

std::vector<std::string> RecorderHandler::paths() const {
  std::vector<std::string> out;
  for (const Ref<Leaf>& r : colliders_)
    if (r) out.push_back(r->path());
  return out;
}

void ScriptHandler::describe(Description<ScriptHandler>& d) {
  d.doc(
      "Emits the event 'collide' at itself for each contact point of the collider above it, after the step. The data "
      "is "
      "{path of the other collider, {x, y, z} [m], depth [m]}.");
  d.property("script", &ScriptHandler::script, &ScriptHandler::setScript)
      .doc("A Lua file that is attached to this node; it calls self:on(\"collide\", function(self, event) ... end).");
}

void ScriptHandler::onLink() {
  kernel().events().define("collide", Order::parentsFirst, "At a ScriptHandler: something touches its collider.");
}

void ScriptHandler::onCollision(const Collision& collision) {
  touches_.push_back({Ref<Leaf>(&collision.other.leaf()), collision.contact.position, collision.contact.depth});
}

void ScriptHandler::emit(const Event& physics) {
  // A script may remove colliders and this handler itself.
  const std::vector<Touch> touches = std::exchange(touches_, {});
  const Ref<ScriptHandler> self(this);
  Channel& channel = kernel().events().channel("collide");
  for (const Touch& t : touches) {
    if (!t.other) continue;
    const Value data = List{t.other->path(), Convert<Vec3>::to(t.position), t.depth};
    channel.emitAt(*this, Event{"collide", physics.time, physics.step, physics.cycle, &data});
    if (!self) return;
  }
}

void ScriptHandler::setScript(std::string file) {
  if (!file.empty()) require<IScriptServer>().attach(*this, file);
  script_ = std::move(file);
}

}  // namespace spark
