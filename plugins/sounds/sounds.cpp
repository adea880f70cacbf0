#include "sounds.h"

#include "spark/describe.h"

namespace spark {

void Sounds::describe(Description<Sounds>& d) {
  d.doc("Sounds for monitors: each is an event (sound name volume x y z).");
  d.implements<IMonitorItem>();
  d.property("dropped", &Sounds::dropped_)
      .readOnly()
      .ofProcess()
      .doc("Sounds that were not sent because a frame had 64 already.");
  d.method("play", &Sounds::playChecked)
      .parameters({"name", "volume", "position [m]"})
      .doc("Plays a sound: its name is one word, its volume 0 to 1, its position in the world frame.");
}

void Sounds::playChecked(const std::string& name, double volume, const Vec3f& position) {
  if (!isWord(name))
    throw RefusedValue("expected the name of a sound: one word without blanks, brackets and quotes, found \"" + name +
                       "\"");
  if (!(volume >= 0 && volume <= 1)) throw RefusedValue(fmt::format("expected a volume of 0 to 1, found {}", volume));
  if (!position.allFinite()) throw RefusedValue("expected a position of finite numbers");
  play(name, volume, position);
}

void Sounds::play(const std::string& name, double volume, const Vec3f& position) {
  if (count_ == pending_.size()) {
    ++dropped_;
    return;
  }
  Sound& sound = pending_[count_++];
  sound.name = name;
  sound.volume = volume;
  sound.position = position;
}

void Sounds::contribute(Environment& env) {
  for (std::size_t i = 0; i < count_; ++i) {
    const Sound& s = pending_[i];
    env.open(EnvPolicy::once, "sound").add(s.name).add(s.volume);
    env.predicates.add(s.position.x()).add(s.position.y()).add(s.position.z()).close();
  }
  count_ = 0;
}

}  // namespace spark
