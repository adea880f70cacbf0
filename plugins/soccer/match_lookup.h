#pragma once

#include "api/joint_command.h"
#include "ball_state_aspect.h"
#include "soccer_rule_aspect.h"

namespace spark {

/// What an effector or perceptor needs of the match, found again when the shape of the tree changed. One object each;
/// refresh() and the pointers are safe in the sense phase, player() is for the simulation's thread.
class MatchLookup {
 public:
  /// What is missing is nullptr.
  void refresh(const Leaf& from) {
    if (!tree_.changed(from)) return;
    Node& root = from.kernel().root();
    settings_ = root.find<SoccerSettings>();
    Node* control = root.find<Node>("/sys/server/gamecontrol");
    game_ = control ? control->childOf<GameStateAspect>() : nullptr;
    ball_ = control ? control->childOf<BallStateAspect>() : nullptr;
    referee_ = control ? control->childOf<SoccerRuleAspect>() : nullptr;
    state_ = from.ancestor<AgentState>();
    auto* aspect = from.ancestor<AgentAspect>();
    agent_ = aspect ? &aspect->outermost() : nullptr;
    player_ = nullptr;
    if (state_ || !agent_) return;
    std::vector<AgentState*> states;
    agent_->collect(states);
    if (!states.empty()) state_ = states.front();
  }
  const SoccerSettings* settings() const { return settings_; }
  GameStateAspect* game() const { return game_; }
  BallStateAspect* ball() const { return ball_; }
  SoccerRuleAspect* referee() const { return referee_; }
  /// Of the agent that `from` belongs to.
  AgentState* state() const { return state_; }
  AgentAspect* agent() const { return agent_; }

  /// Refreshes, and gives the player that `from` belongs to; nullptr unless there are a match, a body and a team.
  const soccer::Player* player(const Leaf& from) {
    refresh(from);
    if (!game_) return nullptr;
    const soccer::Pitch& pitch = game_->pitch();
    if (!pitch.ready()) return nullptr;
    if (!player_) player_ = pitch.playerOf(&from);
    return player_ && player_->torso && player_->side() != soccer::Side::none ? player_ : nullptr;
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

/// The first `count` arguments. False when one is missing: the action is then to have no effect.
inline bool readNumbers(NumberArguments& read, double* out, int count) {
  for (int i = 0; i < count; ++i)
    if (!read(static_cast<std::size_t>(i), out[i])) return false;
  return true;
}

}  // namespace spark
