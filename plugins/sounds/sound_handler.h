#pragma once
/// \file
/// A collision handler that plays a sound.

#include <string>

#include "api/physics.h"
#include "sounds.h"

namespace spark {

/// Plays a sound when something hits its collider, or its collider hits something: when the two approach each other
/// faster than `minSpeed`. What rests or rolls makes no sound.
class SoundHandler : public CollisionHandler {
  SPARK_CLASS(SoundHandler, CollisionHandler)
 public:
  static void describe(Description<SoundHandler>& d);
  void onCollision(const Collision& collision) override;

 protected:
  void saveState(StateWriter& out) const override { out.write(quietUntil_); }
  void loadState(StateReader& in) override { quietUntil_ = in.readNumber(); }

 private:
  void prepare(const Event& event) { time_ = event.time; }
  void setSound(std::string name);
  const std::string& sound() const { return sound_; }

  std::string sound_ = "bump";
  double minSpeed_ = 0.3, fullSpeed_ = 5, gap_ = 0.1;
  double time_ = 0, quietUntil_ = 0;  ///< simulated time [s]
  Link<Sounds> sounds_;
};

}  // namespace spark
