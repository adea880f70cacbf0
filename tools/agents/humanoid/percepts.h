#pragma once
/// \file
/// What one sense message says, as numbers. Frames: robot and head have x to the right, y forward, z up.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "nao.h"
#include "spark/predicates.h"

namespace humanoid {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// A flag or goal post; where it stands is known.
struct Landmark {
  std::string_view name;
  Vec3 place;  ///< m, field frame of the left team: x to the right goal
};
/// All eight.
const std::vector<Landmark>& landmarks();

/// One landmark as it was seen.
struct Sighting {
  const Landmark* landmark;
  Vec3 place;  ///< m, head frame
};
/// Another robot as it was seen.
struct SeenPlayer {
  std::string team;
  int unum;
  Vec3 place;  ///< m, head frame: the part that was named first
};

/// What is told once or seldom stays from message to message; what is seen counts for its message alone.
struct Percepts {
  double now = 0, gameTime = 0;                  ///< s
  std::string playMode = "BeforeKickOff", side;  ///< side: "left", "right", "" before it was told
  int unum = 0, scoreLeft = 0, scoreRight = 0;
  Vec3 gyro = Vec3::Zero();                  ///< rad/s, torso frame
  Vec3 acceleration = Vec3(0, 0, 9.81);      ///< m/s^2, torso frame: at rest it points up
  Pose joints{};                             ///< rad
  bool rightFoot = false, leftFoot = false;  ///< touches something
  bool seeing = false;                       ///< this message has a See
  std::vector<Sighting> sightings;
  std::vector<SeenPlayer> players;
  std::optional<Vec3> ball;        ///< m, head frame
  std::vector<std::string> heard;  ///< what players of `team` said, not oneself
};

/// Takes a sense message in, for a player of `team`. Unknown parts are skipped.
void read(const spark::Predicates& message, std::string_view team, Percepts& out);
/// The point at distance `d` [m], `h` [deg] to the left and `v` [deg] up.
Vec3 polar(double d, double h, double v);

}  // namespace humanoid
