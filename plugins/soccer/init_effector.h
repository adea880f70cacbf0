#pragma once

#include "init_action.h"
#include "match_lookup.h"
#include "team_material.h"

namespace spark {

/// `(init (unum 7)(teamname A))`: takes the agent into a team and puts it at the team's next start position. Refused
/// quietly for the agent, with one line in the log: without a team it then falls down in the middle of the field, as it
/// always did (protocol section 1.6).
class InitEffector : public Effector {
  SPARK_CLASS(InitEffector, Effector)
 public:
  static void describe(Description<InitEffector>& d) {
    d.doc("Takes the agent into a team: (init (unum n)(teamname t)); unum 0 or none is the lowest free number.");
    d.on<&InitEffector::prepare>(phase::kPrepare);
  }
  std::string predicate() const override { return std::string(soccer::kInit); }
  std::string act(const Element& action) override {
    const IJoinPolicy::Name name = soccer::readInit(action);
    unum_ = name.number;
    team_ = name.team;
    pending_ = true;
    return {};
  }

 protected:
  /// Dresses the robot in its team's colours.
  virtual void dress(AgentAspect&, soccer::Side, int) {}

 private:
  void prepare(const Event&) {
    if (!std::exchange(pending_, false)) return;
    match_.refresh(*this);
    GameStateAspect* game = match_.game();
    AgentState* state = match_.state();
    AgentAspect* agent = match_.agent();
    if (!game || !state || !agent || !game->pitch().ready()) {
      if (mayTell())
        kernel().log().warning(
            "{}: init refused: it needs an AgentState in the robot and soccer's rules below game control", path());
      return;
    }
    const bool first = state->side() == soccer::Side::none;
    if (const std::string problem = refusal(*game, *state); !problem.empty()) {
      if (mayTell() && game->mayTell()) kernel().log().warning("{}: init refused: {}", agent->path(), problem);
    } else {
      if (mayTell() && game->mayTell())
        kernel().log().info("{}: plays for '{}' ({}) with number {}", agent->path(), team_,
                            soccer::sideName(state->side()), state->unum());
      dress(*agent, state->side(), state->unum());
      if (auto* scene = game->pitch().scene()) scene->markModified();
    }
    // init again is no way to jump about during play
    if (first || game->paused()) place(*game, state->side());
  }

  /// Takes the agent into the team; returns "" or why it cannot be.
  std::string refusal(GameStateAspect& game, AgentState& state) const {
    if (state.side() != soccer::Side::none && state.team() == team_ && (unum_ == 0 || unum_ == state.unum()))
      return "it plays already";
    return game.join(state, team_, unum_);
  }

  void place(GameStateAspect& game, soccer::Side side) {
    const soccer::Player* player = game.pitch().playerOf(this);
    if (!player) return;
    if (side == soccer::Side::none) return player->moveTo(Vec3(0, 0, kRefusedHeight), 0);
    player->moveTo(game.nextStart(side), degToRad(side == soccer::Side::left ? -90 : 90));
  }

  /// An agent that sends init in every cycle does not fill the log.
  bool mayTell() {
    if (lines_ == kMostLines) return false;
    if (++lines_ == kMostLines)
      kernel().log().warning("{}: it sends init again and again; what becomes of it is told no more", path());
    return true;
  }

  static constexpr int kMostLines = 20;
  static constexpr double kRefusedHeight = 10;  ///< m
  MatchLookup match_;
  int lines_ = 0;
  std::int64_t unum_ = 0;
  std::string team_;
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
  void dress(AgentAspect& agent, soccer::Side side, int unum) override {
    const std::string material = (side == soccer::Side::left ? "matLeft" : "matRight") + std::to_string(unum);
    std::vector<IVisual*> visuals;
    agent.collect(visuals);
    for (IVisual* v : visuals)
      if (isJersey(v->leaf()) && !v->materials().empty()) v->setMaterialName(0, material);
  }

 private:
  /// The visual or a node above it, up to the agent, has the name of a part that wears the jersey.
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
  void dress(AgentAspect& agent, soccer::Side side, int unum) override { soccer::paintTeam(agent, side, unum); }
};

}  // namespace spark
