#include "sound_handler.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "spark/predicates.h"

namespace spark {

namespace {
/// Velocity of the point `at` of the collider's body [m/s]; 0 if it is static.
Vec3 velocityAt(const ICollider& collider, const Vec3& at) {
  const IRigidBody* body = collider.body();
  if (!body) return Vec3::Zero();
  const engine::BodyState state = body->state();
  return state.linearVelocity + state.angularVelocity.cross(at - state.position);
}
}  // namespace

void SoundHandler::describe(Description<SoundHandler>& d) {
  using H = SoundHandler;
  d.doc("Plays a sound when its collider hits something.");
  d.link(&H::sounds_, At<Sounds>(Sounds::kPath));
  d.property("sound", &H::sound, &H::setSound).doc("Name of the sound, one word.");
  d.property("minSpeed", &H::minSpeed_)
      .unit("m/s")
      .min(0)
      .doc("Speed of approach, along the contact's normal, from which on there is a sound.");
  d.property("fullSpeed", &H::fullSpeed_)
      .unit("m/s")
      .min(1e-3)
      .doc("Speed of approach at which the volume is 1; below, it is in proportion.");
  d.property("gap", &H::gap_).unit("s").min(0).doc("Shortest time between two sounds of this handler.");
  d.on<&H::prepare>(phase::kPrepare);
}

void SoundHandler::setSound(std::string name) {
  if (!isWord(name))
    throw RefusedValue("expected the name of a sound: one word without blanks, brackets and quotes, found \"" + name +
                       "\"");
  sound_ = std::move(name);
}

void SoundHandler::onCollision(const Collision& c) {
  if (time_ < quietUntil_) return;
  // The normal points into A: A and B approach each other if A moves against it.
  const Vec3 relative = velocityAt(c.self, c.contact.position) - velocityAt(c.other, c.contact.position);
  const double speed = relative.dot(c.contact.normal) * (c.direct ? -1 : 1);
  if (speed < minSpeed_) return;
  quietUntil_ = time_ + gap_;
  if (sounds_) sounds_->play(sound_, std::min(1.0, speed / fullSpeed_), c.contact.position.cast<float>());
}

}  // namespace spark
