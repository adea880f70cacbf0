#pragma once

#include <array>
#include <chrono>
#include <string>
#include <vector>

#include "api/match.h"
#include "api/status.h"
#include "soccer_control_aspect.h"

namespace spark {

/// Clock, half, play mode, score, teams and their numbers. The first of the soccer aspects in child order. Reports mode
/// and score, and reads for game control who joins.
class GameStateAspect : public SoccerControlAspect, public IStatus, public IJoinPolicy {
  SPARK_CLASS(GameStateAspect, SoccerControlAspect)
 public:
  using Side = soccer::Side;
  using PlayMode = soccer::PlayMode;
  /// Of a match of soccer; Soccer.TeamSize lets more come.
  static constexpr int kTeamSize = 11;

  static void describe(Description<GameStateAspect>& d);
  void rule(const Event& event) override;
  void agentLeaving(AgentAspect& agent) override;
  void report(std::vector<StatusEntry>& out) const override;
  std::string_view predicate() const override;
  Name read(const Element& action) const override;

  /// Refreshed; for rules and effectors.
  soccer::Pitch& pitch() {
    pitch_.refresh(kernel());
    return pitch_;
  }
  RandomStream& random() { return random_; }

  PlayMode mode() const { return mode_; }
  /// Sets the mode; nothing happens when it is the mode already.
  void setMode(PlayMode mode);
  /// s since the last real change, 0 in the cycle of the change. On the clock of play, where it runs: a trainer who
  /// sets the clock ahead ends pauses too; set back, the mode begins anew.
  double modeTime() const { return clockRuns() ? time_ - modeStart_ : standing_; }
  /// The mode has lasted `seconds`, but for rounding.
  bool modeReached(double seconds) const { return modeTime() > seconds - kRounding; }
  /// Counts real changes of the mode.
  std::int64_t modeChanges() const { return modeChanges_; }
  /// s of play: stands before the kick-off and after the match.
  double time() const { return time_; }
  void setTime(double seconds) {
    time_ = std::max(0.0, seconds);
    modeStart_ = std::min(modeStart_, time_);
  }
  int half() const { return half_; }
  /// Counts the times that teams swapped sides.
  std::int64_t sideSwaps() const { return sideSwaps_; }
  /// No fouls are judged, beams are allowed.
  bool paused() const {
    return mode_ == PlayMode::beforeKickOff || mode_ == PlayMode::goalLeft || mode_ == PlayMode::goalRight;
  }

  int score(Side side) const { return side == Side::none ? 0 : team(side).score; }
  void addGoal(Side side) { ++team(side).score; }
  void setScores(int left, int right);
  const std::string& teamName(Side side) const { return team(side).name; }
  /// A player of the side has that number, from 1.
  bool isTaken(Side side, int unum) const { return team(side).has(unum); }
  /// Who kicks this half off, as far as it is decided: left, unless a coin said otherwise, then the other.
  Side halfKickOff() const;

  /// Kick-off for a side; none: who is due, or a coin decides. The ball goes to the centre.
  void kickOff(Side side);
  /// Gives an agent its team and number (0: the lowest free one). Returns "" or what forbids it; nothing has changed
  /// then.
  std::string join(AgentState& state, const std::string& teamName, std::int64_t unum);
  /// The next start position of the team.
  Vec3 nextStart(Side side);
  /// True when one more line about who joins may be written: a hundred at once, then one a second (wall clock), so that
  /// clients that come again and again do not fill a disk.
  bool mayTell();

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  struct Team {
    std::string name;
    int score = 0;
    std::vector<char> taken = std::vector<char>(kTeamSize + 1);  ///< by number
    int starts = 0;                                              ///< start positions given so far
    bool has(int unum) const { return static_cast<std::size_t>(unum) < taken.size() && taken[unum]; }
  };
  Team& team(Side s) { return teams_[s == Side::right]; }
  const Team& team(Side s) const { return teams_[s == Side::right]; }
  static constexpr double kRounding = 1e-6;  ///< s; sums of steps are not exact
  /// Time of play passes.
  bool clockRuns() const { return mode_ != PlayMode::beforeKickOff && mode_ != PlayMode::gameOver; }
  int teamSize() const;
  void advanceHalf();
  void advanceClock(double step);
  Side dueSide();
  void swapSides();
  std::string robotTypeProblem(Side side, const AgentState& joining) const;

  // Script view
  std::string modeText() const { return soccer::playModeName(mode_); }
  void setModeText(std::string name);
  std::vector<int> scoreList() const { return {teams_[0].score, teams_[1].score}; }
  std::string leftName() const { return teams_[0].name; }
  std::string rightName() const { return teams_[1].name; }
  void kickOffForWhoIsDue() { kickOff(Side::none); }

  soccer::Pitch pitch_;
  RandomStream random_{*this, "referee"};
  PlayMode mode_ = PlayMode::beforeKickOff;
  /// As in the installed base the clock of play is summed in single precision: behind 64 s it is a little slow, and a
  /// freeze or a kick-off lasts a cycle longer. No match is as long as this [s]; behind it the clock would go wrong by
  /// per cents, and stand in the end.
  static constexpr double kSingleUntil = 4096;
  double time_ = 0, modeStart_ = 0;  ///< s of play
  double standing_ = 0;  ///< s that the clock of play has stood: before the kick-off with agents there, after the match
  std::int64_t modeChanges_ = 0, sideSwaps_ = 0;
  static constexpr int kLinesPerCycle = 4;
  int linesLeft_ = kLinesPerCycle;  ///< in the log, about modes
  static constexpr double kLinesAboutAgents = 100;
  double linesAboutAgents_ = kLinesAboutAgents;
  std::chrono::steady_clock::time_point toldAt_{};
  int half_ = 1;
  bool kickedOffInHalf_ = false;
  Side firstKickOff_ = Side::none;  ///< predetermined for the first half; none: not determined yet
  std::array<Team, 2> teams_;
};

/// The SPL variant: accepted, plays by the same rules.
class SPLState : public GameStateAspect {
  SPARK_CLASS(SPLState, GameStateAspect)
 public:
  static void describe(Description<SPLState>& d) { d.doc("Accepted for SPL configs; the same as GameStateAspect."); }
};

}  // namespace spark
