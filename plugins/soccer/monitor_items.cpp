#include "monitor_items.h"

#include "pass_mode_rule.h"

namespace spark {

using soccer::Side;

void GameStateItem::writeField(Environment& env, const SoccerSettings& s) const {
  const std::pair<const char*, double> values[] = {{"FieldLength", s.fieldLength},
                                                   {"FieldWidth", s.fieldWidth},
                                                   {"FieldHeight", s.fieldHeight},
                                                   {"GoalWidth", s.goalWidth},
                                                   {"GoalDepth", s.goalDepth},
                                                   {"GoalHeight", s.goalHeight},
                                                   {"BorderSize", s.borderSize},
                                                   {"FreeKickDistance", s.freeKickDistance},
                                                   {"WaitBeforeKickOff", s.waitBeforeKickOff},
                                                   {"AgentRadius", s.agentRadius},
                                                   {"BallRadius", s.ballRadius},
                                                   {"BallMass", s.ballMass},
                                                   {"RuleGoalPauseTime", s.ruleGoalPauseTime},
                                                   {"RuleKickInPauseTime", s.ruleKickInPauseTime},
                                                   {"RuleHalfTime", s.ruleHalfTime},
                                                   {"PassModeMinOppBallDist", s.passModeMinOppBallDist},
                                                   {"PassModeDuration", s.passModeDuration}};
  for (const auto& [name, value] : values) env.put(EnvPolicy::full, name, value);
  Predicates& modes = env.open(EnvPolicy::full, "play_modes");
  for (const char* name : soccer::kPlayModeNames) modes.add(name);
  modes.close();
}

void GameStateItem::contribute(Environment& env) {
  match_.refresh(*this);
  const GameStateAspect* game = match_.game();
  if (!game || !match_.settings()) return;
  writeField(env, *match_.settings());
  env.put(EnvPolicy::always, "time", game->time());
  if (!game->teamName(Side::left).empty())
    env.put(EnvPolicy::change, "team_left", std::string_view(game->teamName(Side::left)));
  if (!game->teamName(Side::right).empty())
    env.put(EnvPolicy::change, "team_right", std::string_view(game->teamName(Side::right)));
  env.put(EnvPolicy::change, "half", game->half());
  env.put(EnvPolicy::change, "score_left", game->score(Side::left));
  env.put(EnvPolicy::change, "score_right", game->score(Side::right));
  env.put(EnvPolicy::change, "play_mode", static_cast<int>(game->mode()));
  writeScoreWaits(env, *game);
  if (!areas_) return;
  env.put(EnvPolicy::full, "PenaltyAreaLength", match_.settings()->penaltyLength);
  env.put(EnvPolicy::full, "PenaltyAreaWidth", match_.settings()->penaltyWidth + match_.settings()->goalWidth);
}

/// Writes the time until goals of a team count again after its pass mode [s].
void GameStateItem::writeScoreWaits(Environment& env, const GameStateAspect& game) {
  const PassModeRule* pass = match_.referee() ? match_.referee()->passMode() : nullptr;
  if (!pass || game.mode() != soccer::PlayMode::playOn) return;
  if (const double left = pass->scoreWait(Side::left); left > 0)
    env.put(EnvPolicy::always, "pass_mode_score_wait_left", left);
  if (const double right = pass->scoreWait(Side::right); right > 0)
    env.put(EnvPolicy::always, "pass_mode_score_wait_right", right);
}

void SoccerRuleItem::contribute(Environment& env) {
  match_.refresh(*this);
  if (!match_.referee()) return;
  for (const SoccerRuleAspect::Foul& f : match_.referee()->fouls()) {
    if (f.index <= lastIndex_) continue;
    lastIndex_ = f.index;
    env.open(EnvPolicy::once, "foul").add(f.index).add(f.type).add(static_cast<int>(f.side)).add(f.unum).close();
  }
}

}  // namespace spark
