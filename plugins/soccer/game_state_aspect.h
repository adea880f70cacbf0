#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <vector>

#include "api/match.h"
#include "api/status.h"
#include "soccer_control_aspect.h"

namespace spark {

/// Clock, half, play mode, score, teams and uniform numbers. The first of the soccer aspects in child order. Reports
/// mode and score (IStatus), and reads the init action for game control (IJoinPolicy).
class GameStateAspect : public SoccerControlAspect, public IStatus, public IJoinPolicy {
  SPARK_CLASS(GameStateAspect, SoccerControlAspect)
 public:
  using Side = soccer::Side;
  using PlayMode = soccer::PlayMode;
  /// Players of a team in a match of soccer. Soccer.TeamSize allows more.
  static constexpr int kTeamSize = 11;

  static void describe(Description<GameStateAspect>& d);
  void rule(const Event& event) override;
  /// Disabled: the clock of play is stopped.
  void rest(const Event&) override { advance_ = 0; }
  void agentLeaving(AgentAspect& agent) override;
  void report(std::vector<StatusEntry>& out) const override;
  std::string_view predicate() const override;
  Name read(const Element& action) const override;

  /// The match, refreshed; for rules and effectors. In the simulation's thread.
  soccer::Pitch& pitch() {
    pitch_.refresh(kernel());
    return pitch_;
  }
  /// The stream for coin tosses and shuffles.
  RandomStream& random() { return random_; }

  PlayMode mode() const { return mode_; }
  /// Sets the mode. Does nothing if it is the current one.
  void setMode(PlayMode mode);
  /// Time since the mode changed [s]; 0 in the cycle of the change. Measured on the clock of play while it runs, so
  /// that a trainer that sets the clock ahead also ends pauses; if the clock is set back, the mode starts again.
  double modeTime() const { return clockRuns() ? time_ - modeStart_ : stoppedTime_; }
  /// True when the mode has lasted `seconds`, within rounding.
  bool modeReached(double seconds) const { return modeTime() > seconds - kRounding; }
  /// Number of changes of the mode so far.
  std::int64_t modeChanges() const { return modeChanges_; }
  /// Time of play [s]. Stopped before kick-offs and after the match.
  double time() const { return time_; }
  void setTime(double seconds) {
    time_ = std::max(0.0, seconds);
    modeStart_ = std::min(modeStart_, time_);
  }
  /// By how much the time of play has advanced in this cycle, as it is summed; 0 while it is stopped. A trainer that
  /// sets the time does not change it [s].
  double advance() const { return advance_; }
  /// 1 or 2.
  int half() const { return half_; }
  /// Number of times that the teams have swapped sides.
  std::int64_t sideSwaps() const { return sideSwaps_; }
  /// True while beams are allowed and no fouls are judged: before kick-offs and after goals.
  bool paused() const {
    return mode_ == PlayMode::beforeKickOff || mode_ == PlayMode::goalLeft || mode_ == PlayMode::goalRight;
  }

  /// Goals of a side; 0 for none.
  int score(Side side) const { return side == Side::none ? 0 : team(side).score; }
  void addGoal(Side side) { ++team(side).score; }
  void setScores(int left, int right);
  /// Name of the team; "" while it is unknown. `side` must not be none.
  const std::string& teamName(Side side) const { return team(side).name; }
  /// True when a player of the side has this number.
  bool isTaken(Side side, int unum) const { return team(side).has(unum); }
  /// The side that kicks off this half. Before the coin is tossed it is assumed to be left in the first half.
  Side halfKickOff() const;

  /// Starts a kick-off with the ball at the centre. `side` none: the side that is due in this half, after the half's
  /// first kick-off a random one.
  void kickOff(Side side);
  /// Assigns a team and a number to an agent. Returns "", or the reason why not; nothing has changed then. A team that
  /// has left frees its name, and a client that hangs its number.
  std::string join(AgentState& state, soccer::Application& application);
  /// The next start position of the team [m]. Start positions form a grid in the team's half; they are not given back,
  /// and after the last the first comes again.
  Vec3 nextStartPosition(Side side);
  /// Takes one of the log lines about joining agents; false when there is none left. Token bucket: 100 lines, refilled
  /// by one per second of wall time, so that clients that connect again and again do not fill the disk.
  bool mayLogJoin();

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  struct Team {
    std::string name;
    int score = 0;
    std::vector<char> taken = std::vector<char>(kTeamSize + 1);  ///< by number
    int starts = 0;                                              ///< start positions used so far
    bool has(int unum) const { return std::size_t(unum) < taken.size() && taken[unum]; }
    bool hasLeft() const {
      return std::none_of(taken.begin(), taken.end(), [](char t) { return t != 0; });
    }
  };
  Team& team(Side s) { return teams_[s == Side::right]; }
  const Team& team(Side s) const { return teams_[s == Side::right]; }
  static constexpr double kRounding = 1e-6;  ///< of sums of steps [s]
  /// True while the time of play advances.
  bool clockRuns() const { return mode_ != PlayMode::beforeKickOff && mode_ != PlayMode::gameOver; }
  int teamSize() const;
  /// Ends a half or the match when its time is over. GameOver is imposed again in every cycle, as in the installed
  /// base.
  void advanceHalf();
  void advanceClock(double step);
  /// The side of a kick-off for which none was named.
  Side dueSide();
  void swapSides();
  /// The side for a team of this name: its own, or one without a team, or one whose team has left; none: there is none.
  Side sideFor(const std::string& name) const;
  /// Takes the number from a player whose client hangs; false: from none. `again`: see ISuccession. Sets
  /// application.waiting.
  bool vacate(Side side, soccer::Application& application, bool again);
  /// Why the type of the robot is not allowed in the team, by the league's limits; "": it is.
  std::string robotTypeProblem(Side side, const AgentState& joining) const;

  // Properties and methods of scripts.
  std::string modeText() const { return soccer::playModeName(mode_); }
  void setModeText(const std::string& name);
  std::vector<int> scoreList() const { return {teams_[0].score, teams_[1].score}; }
  std::string leftName() const { return teams_[0].name; }
  std::string rightName() const { return teams_[1].name; }
  void kickOffDueSide() { kickOff(Side::none); }

  soccer::Pitch pitch_;
  RandomStream random_{*this, "referee"};
  PlayMode mode_ = PlayMode::beforeKickOff;
  /// As in the installed base, the time of play is summed in single precision up to this time [s]: after 64 s it is a
  /// little slow, so that some durations last one cycle longer. Matches are shorter; beyond it single precision would
  /// be wrong by per cents and stop in the end.
  static constexpr double kSinglePrecisionUntil = 4096;
  double time_ = 0, modeStart_ = 0;  ///< time of play [s]
  double advance_ = 0;               ///< of the time of play in this cycle [s]
  double stoppedTime_ =
      0;  ///< time in this mode while the clock of play is stopped; before kick-offs with agents only [s]
  std::int64_t modeChanges_ = 0, sideSwaps_ = 0;
  static constexpr int kModeLinesPerCycle = 4;
  int modeLinesLeft_ = kModeLinesPerCycle;  ///< log lines about modes, in this cycle
  static constexpr double kJoinLines = 100;
  double joinLinesLeft_ = kJoinLines;  ///< log lines about joining agents
  std::chrono::steady_clock::time_point joinLinesUpdated_{};
  int half_ = 1;
  bool kickedOffInHalf_ = false;
  Side firstKickOff_ = Side::none;  ///< of the first half; none: not determined yet
  std::array<Team, 2> teams_;
};

/// The class of the SPL server: accepted, with the same rules.
class SPLState : public GameStateAspect {
  SPARK_CLASS(SPLState, GameStateAspect)
 public:
  static void describe(Description<SPLState>& d) { d.doc("Accepted for SPL configs; the same as GameStateAspect."); }
};

}  // namespace spark
