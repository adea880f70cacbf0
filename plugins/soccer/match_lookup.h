#pragma once

#include "api/joint_command.h"
#include "ball_state_aspect.h"
#include "soccer_rule_aspect.h"

namespace spark {

/// The parts of the match that an effector, perceptor or monitor item works with, looked up again when the shape of the
/// tree changed. Each of these nodes has an instance of its own. refresh() and the accessors may be called in the sense
/// phase, player() only in the simulation's thread.
class MatchLookup {
 public:
  /// Looks everything up for the node `from`; what is missing becomes nullptr.
  void refresh(const Leaf& from) {
    if (!tree_.changed(from)) return;
    Node& root = from.kernel().root();
    settings_ = root.find<SoccerSettings>();
    Node* control = root.find<Node>(IGameControl::kPath);
    game_ = control ? control->childOf<GameStateAspect>() : nullptr;
    ball_ = control ? control->childOf<BallStateAspect>() : nullptr;
    referee_ = control ? control->childOf<SoccerRuleAspect>() : nullptr;
    state_ = from.ancestor<AgentState>();
    auto* aspect = from.ancestor<AgentAspect>();
    agent_ = aspect ? &aspect->outermost() : nullptr;
    player_ = nullptr;

    // The state may also be in another branch of the robot.
    if (state_ || !agent_) return;
    std::vector<AgentState*> states;
    agent_->collect(states);
    if (!states.empty()) state_ = states.front();
  }
  const SoccerSettings* settings() const { return settings_; }
  GameStateAspect* game() const { return game_; }
  BallStateAspect* ball() const { return ball_; }
  SoccerRuleAspect* referee() const { return referee_; }
  /// State of the agent that `from` belongs to.
  AgentState* state() const { return state_; }
  /// The agent that `from` belongs to (outermost aspect).
  AgentAspect* agent() const { return agent_; }

  /// Refreshes and returns the player that `from` belongs to; nullptr unless there is a match and the player has a body
  /// and a team.
  const soccer::Player* player(const Leaf& from) {
    refresh(from);
    if (!game_) return nullptr;
    const soccer::Pitch& pitch = game_->pitch();
    if (!pitch.ready()) return nullptr;
    if (!player_) player_ = pitch.playerOf(&from);
    return player_ && player_->torso && player_->side() != soccer::Side::none ? player_ : nullptr;
  }
  /// Why player() returned nullptr, for the log.
  const char* whyNoPlayer() const {
    if (!game_ || !settings_)
      return "expected a match, found no SoccerSettings or no GameStateAspect below game control";
    if (!player_ || !player_->state) return "expected a player, found a robot without an AgentState";
    if (player_->side() == soccer::Side::none)
      return "expected a player of a team, found none: it needs (init ...) first";
    return "expected a player with a body, found none";
  }

 private:
  TreeWatch tree_;
  const SoccerSettings* settings_ = nullptr;
  GameStateAspect* game_ = nullptr;
  BallStateAspect* ball_ = nullptr;
  SoccerRuleAspect* referee_ = nullptr;
  AgentState* state_ = nullptr;
  AgentAspect* agent_ = nullptr;
  const soccer::Player* player_ = nullptr;
};

/// Reads the first `count` arguments into `out`. Returns false when one is missing or not finite: the action should
/// then have no effect.
inline bool readNumbers(NumberArguments& read, double* out, int count) {
  for (int i = 0; i < count; ++i)
    if (!read(std::size_t(i), out[i])) return false;
  return true;
}

}  // namespace spark
