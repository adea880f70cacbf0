#pragma once

#include "init_action.h"
#include "match_lookup.h"
#include "team_material.h"

namespace spark {

/// `(init (unum 7)(teamname A))`: adds the agent to a team and moves it to the team's next start position. The agent
/// gets no reply when it is refused, only the log says so; as in the installed base, a robot without a team then drops
/// from 10 m onto the middle of the field.
class InitEffector : public Effector {
  SPARK_CLASS(InitEffector, Effector)
 public:
  static void describe(Description<InitEffector>& d) {
    d.doc("Adds the agent to a team: (init (unum n)(teamname t)); unum 0 or none: the lowest free number.");
    d.on<&InitEffector::prepare>(phase::kPrepare);
  }
  std::string predicate() const override { return std::string(soccer::kInit); }
  std::string act(const Element& action) override {
    const IJoinPolicy::Name name = soccer::readInit(action);
    wanted_ = {std::string(name.team), name.number, false};
    pending_ = true;
    return soccer::remarkOnInit(action);
  }

 protected:
  /// Sets the materials of the robot to those of its team and number.
  virtual void setMaterials(AgentAspect&, soccer::Side, int) {}

 private:
  void prepare(const Event&) {
    match_.refresh(*this);
    AgentState* state = match_.state();
    const bool again = !std::exchange(pending_, false);
    if (again && (!state || !state->application().waiting)) return;
    GameStateAspect* game = match_.game();
    AgentAspect* agent = match_.agent();
    if (!game || !state || !agent || !game->pitch().ready()) {
      return refuse(
          0, [] { return "init refused: expected an AgentState in the robot and soccer's rules below game control"; });
    }
    const soccer::Side before = state->side();
    if (!again) state->application() = wanted_;
    const soccer::Application& wanted = state->application();
    if (const std::string problem = join(*game, *state); !problem.empty()) {
      // An agent may repeat it in every cycle.
      if (std::exchange(lastProblem_, problem) != problem && mayLog() && game->mayLogJoin())
        kernel().log().warning("agent {}: init refused: {}", agent->number(), problem);
    } else {
      if (mayLog() && game->mayLogJoin())
        kernel().log().info("agent {}: plays for '{}' ({}) with number {}", agent->number(), wanted.team,
                            soccer::sideName(state->side()), state->unum());
      lastProblem_.clear();
      setMaterials(*agent, state->side(), state->unum());
      if (auto* scene = game->pitch().scene()) scene->markModified();
    }
    // A repeated init moves the robot only while beams are allowed, too; waiting for a number does not move it.
    const bool joined = before == soccer::Side::none && state->side() != before;
    if (again ? joined : before == soccer::Side::none || game->paused()) place(*game, state->side());
  }

  /// Adds the agent to the team that its application names; returns "" or the reason why not.
  static std::string join(GameStateAspect& game, AgentState& state) {
    soccer::Application& wanted = state.application();
    const bool plays = state.side() != soccer::Side::none && state.team() == wanted.team;
    if (!plays || (wanted.unum != 0 && wanted.unum != state.unum())) return game.join(state, wanted);
    wanted.waiting = false;
    return "it plays already";
  }

  void place(GameStateAspect& game, soccer::Side side) {
    const soccer::Player* player = game.pitch().playerOf(this);
    if (!player) return;
    if (side == soccer::Side::none) return player->moveTo(Vec3(0, 0, kRefusedHeight), 0);
    player->moveTo(game.nextStartPosition(side), degToRad(side == soccer::Side::left ? -90 : 90));
  }

  /// True while the agent has log lines left, so that an agent that repeats init does not fill the log.
  bool mayLog() {
    if (lines_ == kMaxLines) return false;
    if (++lines_ == kMaxLines)
      kernel().log().warning("agent {}: it sends init again and again; the results are no longer logged",
                             match_.agent()->number());
    return true;
  }

  static constexpr int kMaxLines = 20;
  static constexpr double kRefusedHeight = 10;  ///< of a robot without a team [m]
  MatchLookup match_;
  int lines_ = 0;
  soccer::Application wanted_;  ///< of the last action
  std::string lastProblem_;
  bool pending_ = false;
};

/// Init for robots made of single-material parts: their material gets the team's side and the number.
class SingleMatInitEffector : public InitEffector {
  SPARK_CLASS(SingleMatInitEffector, InitEffector)
 public:
  static void describe(Description<SingleMatInitEffector>& d) {
    d.doc("Init; gives certain parts the material matLeft<unum> or matRight<unum>.");
  }

 protected:
  void setMaterials(AgentAspect& agent, soccer::Side side, int unum) override {
    const std::string material = fmt::format("{}{}", side == soccer::Side::left ? "matLeft" : "matRight", unum);
    std::vector<IVisual*> visuals;
    agent.collect(visuals);
    for (IVisual* v : visuals)
      if (isJersey(v->leaf()) && !v->materials().empty()) v->setMaterialName(0, material);
  }

 private:
  /// True when the visual or a node above it, below the agent, has the name of a part with the team's colour.
  static bool isJersey(const Leaf& visual) {
    for (const Leaf* l = &visual; l && !l->as<AgentAspect>(); l = l->parent())
      for (const char* part : {"body", "leftshoulder", "rightshoulder", "leftshank", "rightshank", "lowerTorso"})
        if (l->name() == part) return true;
    return false;
  }
};

/// Init for robots with meshes: matTeam and matNum are replaced in place.
class StaticMeshInitEffector : public InitEffector {
  SPARK_CLASS(StaticMeshInitEffector, InitEffector)
 public:
  static void describe(Description<StaticMeshInitEffector>& d) {
    d.doc("Init; matTeam becomes matLeft or matRight, matNum becomes matNum<unum>.");
  }

 protected:
  void setMaterials(AgentAspect& agent, soccer::Side side, int unum) override {
    soccer::setTeamMaterials(agent, side, unum);
  }
};

}  // namespace spark
