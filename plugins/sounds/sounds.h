#pragma once
/// \file
/// Sounds of the simulation, for monitors and the page.

#include <array>
#include <cstddef>
#include <string>

#include "api/monitor.h"

namespace spark {

/// A child of the monitor server. Each sound is an event `(sound name volume x y z)`, which every monitor receives
/// once, with the next frame. Sounds are not state: the simulation does not hear them.
class Sounds : public Leaf, public IMonitorItem {
  SPARK_CLASS(Sounds, Leaf)
 public:
  static constexpr const char* kPath = "/sys/server/monitor/sounds";
  /// Largest number of sounds in a frame; what exceeds it is dropped.
  static constexpr std::size_t kMost = 64;

  static void describe(Description<Sounds>& d);
  /// Plays a sound. `volume`: 0 to 1. `position`: world frame [m]. Does not allocate memory for a `name` that was
  /// played before.
  void play(const std::string& name, double volume, const Vec3f& position);
  void contribute(Environment& env) override;

 private:
  struct Sound {
    std::string name;
    double volume = 0;
    Vec3f position = Vec3f::Zero();
  };
  /// The method of the class: checks its arguments. Throws RefusedValue.
  void playChecked(const std::string& name, double volume, const Vec3f& position);

  std::array<Sound, kMost> pending_;
  std::size_t count_ = 0;
  std::int64_t dropped_ = 0;
};

}  // namespace spark
