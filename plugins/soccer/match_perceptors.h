#pragma once
/// \file
/// The perceptors for the match and the agent's own state. Percepts are those of the installed base.

#include "match_lookup.h"

namespace spark {

/// `(GS (unum 3) (team left) (sl 0) (sr 0) (t 0.00) (pm BeforeKickOff))`. unum and team are sent after init,
/// and when the team changes sides.
class GameStatePerceptor : public Perceptor {
  SPARK_CLASS(GameStatePerceptor, Perceptor)
 public:
  static void describe(Description<GameStatePerceptor>& d) {
    d.doc("The state of the match: (GS (sl n) (sr n) (t s) (pm mode)).");
  }
  void sense(Predicates& out, const Event&) override {
    match_.refresh(*this);
    const GameStateAspect* game = match_.game();
    if (!game || !match_.settings()) return;
    const bool longNames = match_.settings()->longNames;
    out.open(longNames ? "GameState" : "GS");
    if (AgentState* s = match_.state(); s && s->takeAnnouncement()) {
      out.pair("unum", s->unum());
      out.pair("team", sideName(s->side()));
      if (longNames) writeSizes(out, *match_.settings());
    }
    if (match_.settings()->reportScore) {
      out.pair("sl", game->score(soccer::Side::left));
      out.pair("sr", game->score(soccer::Side::right));
    }
    out.pair(longNames ? "time" : "t", game->time());
    out.pair(longNames ? "playmode" : "pm", playModeName(game->mode()));
    if (match_.settings()->extraGameState) writeExtra(out, *game, match_.settings()->teamSize);
    out.close();
  }

 private:
  /// Writes what robots of 2004 are told once.
  static void writeSizes(Predicates& out, const SoccerSettings& s) {
    out.pair("FieldLength", s.fieldLength).pair("FieldWidth", s.fieldWidth).pair("FieldHeight", s.fieldHeight);
    out.pair("GoalWidth", s.goalWidth).pair("GoalDepth", s.goalDepth).pair("GoalHeight", s.goalHeight);
    out.pair("BorderSize", s.borderSize);
    out.pair("AgentMass", s.agentMass).pair("AgentRadius", s.agentRadius).pair("AgentMaxSpeed", s.agentMaxSpeed);
    out.pair("BallRadius", s.ballRadius).pair("BallMass", s.ballMass);
  }
  /// Writes `(k left) (ti ((1 penalty_none 0.000)) ())` with Soccer.ExtraGameState: the kick-off side, and for each
  /// player of each team number, penalty and remaining time. Without a penalty the remaining time is minus the time of
  /// play, as in the SPL server.
  static void writeExtra(Predicates& out, const GameStateAspect& game, int teamSize) {
    out.pair("k", sideName(game.halfKickOff()));
    out.open("ti");
    for (const soccer::Side side : {soccer::Side::left, soccer::Side::right}) {
      out.open();
      for (int unum = 1; unum <= teamSize; ++unum)
        if (game.isTaken(side, unum)) out.open().add(unum).add("penalty_none").add(0.0 - game.time()).close();
      out.close();
    }
    out.close();
  }
  MatchLookup match_;
};

/// `(hear A 1.20 self hello)(hear A 1.20 -45.00 hi)`: the player's own message, a team-mate's, an opponent's.
class HearPerceptor : public Perceptor {
  SPARK_CLASS(HearPerceptor, Perceptor)
 public:
  static void describe(Description<HearPerceptor>& d) {
    d.doc(
        "Messages of this cycle: (hear team time direction message); direction in deg relative to the x axis of the "
        "team's frame.");
  }
  void sense(Predicates& out, const Event&) override {
    match_.refresh(*this);
    AgentState* state = match_.state();
    const GameStateAspect* game = match_.game();
    if (!state || !game || !match_.settings()) return;
    write(out, state->own(), *game, true);
    write(out, state->heard(AgentState::kMate), *game, false);
    write(out, state->heard(AgentState::kOpponent), *game, false);
    state->recoverHearing();
  }

 private:
  void write(Predicates& out, AgentState::Message& message, const GameStateAspect& game, bool self) {
    if (!std::exchange(message.pending, false)) return;
    out.open("hear");
    if (match_.settings()->labelMessages) out.add(message.team);
    out.add(game.time());
    if (self)
      out.add("self");
    else
      out.add(message.directionDeg);
    out.add(message.text).close();
  }
  MatchLookup match_;
};

/// `(AgentState (pan_tilt 0 0) (battery 99.20) (temp 23.00))`, in every tenth cycle.
class AgentStatePerceptor : public Perceptor {
  SPARK_CLASS(AgentStatePerceptor, Perceptor)
 public:
  AgentStatePerceptor() { interval_ = 10; }
  static void describe(Description<AgentStatePerceptor>& d) {
    d.doc("The agent's direction of view, battery and temperature.");
  }
  void sense(Predicates& out, const Event&) override {
    match_.refresh(*this);
    const AgentState* s = match_.state();
    if (!s) return;
    out.open("AgentState");
    out.open("pan_tilt")
        .add(static_cast<int>(std::lround(s->pan())))
        .add(static_cast<int>(std::lround(s->tilt())))
        .close();
    out.pair("battery", s->battery());
    out.pair("temp", match_.settings() && match_.settings()->constantTemperature ? kTemperature : s->temperature());
    out.close();
  }

 private:
  static constexpr double kTemperature = 23;  ///< constant of the mainline server [degC]
  MatchLookup match_;
};

/// `(time (now 12.34))`: the time of play.
class GameTimePerceptor : public Perceptor {
  SPARK_CLASS(GameTimePerceptor, Perceptor)
 public:
  static void describe(Description<GameTimePerceptor>& d) { d.doc("The time of play: (time (now s))."); }
  void sense(Predicates& out, const Event&) override {
    match_.refresh(*this);
    if (!match_.game()) return;
    out.open("time").pair("now", match_.game()->time()).close();
  }

 private:
  MatchLookup match_;
};

}  // namespace spark
