#pragma once
/// \file
/// The content of a sense message. Frames of robot and head: x to the right, y forward, z up.

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

/// A flag or goal post with known position.
struct Landmark {
  std::string_view name;
  Vec3 place;  ///< in the frame of the left team: x towards the right goal [m]
};
/// The four flags and four goal posts.
const std::vector<Landmark>& landmarks();

/// An observed landmark.
struct Sighting {
  const Landmark* landmark;
  Vec3 place;  ///< head frame [m]
};
/// An observed robot.
struct SeenPlayer {
  std::string team;
  int unum;
  Vec3 place;  ///< of the first part in the percept, head frame [m]
};

/// Values that are sent once or rarely are kept from message to message; what was seen and heard is that of the last
/// message only.
struct Percepts {
  double now = 0, gameTime = 0;                  ///< s
  std::string playMode = "BeforeKickOff", side;  ///< side: "left", "right", "" before init
  int unum = 0, scoreLeft = 0, scoreRight = 0;
  Vec3 gyro = Vec3::Zero();                  ///< torso frame [rad/s]
  Vec3 acceleration = Vec3(0, 0, 9.81);      ///< torso frame; points up at rest [m/s^2]
  Pose joints{};                             ///< rad
  bool rightFoot = false, leftFoot = false;  ///< has contact
  bool seeing = false;                       ///< the message contains See
  std::vector<Sighting> sightings;
  std::vector<SeenPlayer> players;
  std::optional<Vec3> ball;        ///< head frame [m]
  std::vector<std::string> heard;  ///< messages of team-mates
  /// What is kept from message to message.
  template <class F>
  void fields(F& f) {
    f(now, gameTime, playMode, side, unum, scoreLeft, scoreRight, gyro, acceleration, joints);
  }
};

/// Reads a sense message for a player of `team` into `out`. Skips unknown percepts.
void read(const spark::Predicates& message, std::string_view team, Percepts& out);
/// The point at distance `d` [m], `h` [deg] to the left and `v` [deg] up, in the head frame [m].
Vec3 polar(double d, double h, double v);

}  // namespace humanoid
