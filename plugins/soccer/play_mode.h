#pragma once
/// \file
/// Sides and play modes: names, numbers, mirror images.

#include <array>
#include <string>
#include <string_view>

namespace spark::soccer {

/// A team's half, and thereby the team: left plays towards +x. The numbers are those of the monitor protocol.
enum class Side { none = 0, left = 1, right = 2 };
constexpr Side opponent(Side s) { return s == Side::left ? Side::right : s == Side::right ? Side::left : Side::none; }
/// +1 for left, -1 for right: multiplies x and y to see the field as the team does. Teams attack towards +x of their
/// own view.
constexpr double direction(Side s) { return s == Side::right ? -1.0 : 1.0; }
/// "left", "right", "none": as agents read them.
constexpr const char* sideName(Side s) { return s == Side::left ? "left" : s == Side::right ? "right" : "none"; }
/// "Left" and "Right" as trainers write them; everything else is none.
constexpr Side sideFromTrainer(std::string_view text) {
  return text == "Left" ? Side::left : text == "Right" ? Side::right : Side::none;
}

/// The order is the number on the wire.
enum class PlayMode {
  beforeKickOff,
  kickOffLeft,
  kickOffRight,
  playOn,
  kickInLeft,
  kickInRight,
  cornerKickLeft,
  cornerKickRight,
  goalKickLeft,
  goalKickRight,
  offsideLeft,
  offsideRight,
  gameOver,
  goalLeft,
  goalRight,
  freeKickLeft,
  freeKickRight,
  directFreeKickLeft,
  directFreeKickRight,
  passLeft,
  passRight
};

/// Names as agents, monitors and trainers know them.
inline constexpr std::array<const char*, 21> kPlayModeNames{"BeforeKickOff",
                                                            "KickOff_Left",
                                                            "KickOff_Right",
                                                            "PlayOn",
                                                            "KickIn_Left",
                                                            "KickIn_Right",
                                                            "corner_kick_left",
                                                            "corner_kick_right",
                                                            "goal_kick_left",
                                                            "goal_kick_right",
                                                            "offside_left",
                                                            "offside_right",
                                                            "GameOver",
                                                            "Goal_Left",
                                                            "Goal_Right",
                                                            "free_kick_left",
                                                            "free_kick_right",
                                                            "direct_free_kick_left",
                                                            "direct_free_kick_right",
                                                            "pass_left",
                                                            "pass_right"};

constexpr const char* playModeName(PlayMode mode) { return kPlayModeNames[static_cast<std::size_t>(mode)]; }
/// False when there is no mode of that name.
inline bool playModeFromName(std::string_view name, PlayMode& out) {
  for (std::size_t i = 0; i < kPlayModeNames.size(); ++i)
    if (name == kPlayModeNames[i]) return out = static_cast<PlayMode>(i), true;
  return false;
}

/// The team that a mode names; none for modes without one.
constexpr Side sideOf(PlayMode m) {
  if (m == PlayMode::beforeKickOff || m == PlayMode::playOn || m == PlayMode::gameOver) return Side::none;
  const int n = static_cast<int>(m);
  // up to offside the left mode of a pair is kick-off's 1 or an even number, from the goals on an odd one
  if (n <= 2) return n == 1 ? Side::left : Side::right;
  return (n < 12) == (n % 2 == 0) ? Side::left : Side::right;
}
/// The mode of that kind for the other side: `forSide(PlayMode::kickInLeft, Side::right)` is kickInRight.
constexpr PlayMode forSide(PlayMode left, Side side) {
  return side == Side::right ? static_cast<PlayMode>(static_cast<int>(left) + 1) : left;
}

}  // namespace spark::soccer
