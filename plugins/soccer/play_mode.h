#pragma once
/// \file
/// Sides and play modes: names, numbers, mirror images.

#include <array>
#include <string>
#include <string_view>

namespace spark::soccer {

/// The side of a team: the half of the field that it defends. Left attacks towards +x. The numbers are those of the
/// monitor protocol.
enum class Side { none = 0, left = 1, right = 2 };
/// The other side; none for none.
constexpr Side opponent(Side s) { return s == Side::left ? Side::right : s == Side::right ? Side::left : Side::none; }
/// +1 for left, -1 for right. x and y times this factor are in the team's frame, in which it attacks towards +x.
constexpr double direction(Side s) { return s == Side::right ? -1.0 : 1.0; }
/// "left", "right" or "none", as in percepts.
constexpr const char* sideName(Side s) { return s == Side::left ? "left" : s == Side::right ? "right" : "none"; }
/// The side for "Left" or "Right" in a trainer command; none for all other texts.
constexpr Side sideFromTrainer(std::string_view text) {
  return text == "Left" ? Side::left : text == "Right" ? Side::right : Side::none;
}

/// The play modes. Their values are those of the monitor protocol.
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

/// Names of the play modes in all protocols, by value.
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

/// Name of a play mode.
constexpr const char* playModeName(PlayMode mode) { return kPlayModeNames[static_cast<std::size_t>(mode)]; }
/// Sets `out` to the play mode with this name. Returns false when there is none.
inline bool playModeFromName(std::string_view name, PlayMode& out) {
  for (std::size_t i = 0; i < kPlayModeNames.size(); ++i)
    if (name == kPlayModeNames[i]) return out = static_cast<PlayMode>(i), true;
  return false;
}

/// The side that a mode is for; none for BeforeKickOff, PlayOn and GameOver.
constexpr Side sideOf(PlayMode m) {
  if (m == PlayMode::beforeKickOff || m == PlayMode::playOn || m == PlayMode::gameOver) return Side::none;
  const int n = static_cast<int>(m);
  // In each pair the left mode comes first: 1 for kick-offs, even numbers up to offside, odd ones from goals on.
  if (n <= 2) return n == 1 ? Side::left : Side::right;
  return (n < 12) == (n % 2 == 0) ? Side::left : Side::right;
}
/// The mode for `side`, given that for left: `forSide(PlayMode::kickInLeft, Side::right)` is kickInRight.
constexpr PlayMode forSide(PlayMode left, Side side) {
  return side == Side::right ? static_cast<PlayMode>(static_cast<int>(left) + 1) : left;
}

}  // namespace spark::soccer
