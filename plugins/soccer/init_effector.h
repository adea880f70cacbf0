#pragma once

#include "match_lookup.h"
#include "team_material.h"

namespace spark {

/// `(init (unum 7)(teamname A))`: takes the agent into a team. Refused quietly for the agent, with one line in the log: it then stays
/// where it is, without a team.
class InitEffector : public Effector {
  SPARK_CLASS(InitEffector, Effector)
 public:
  static void describe(Description<InitEffector>& d) {
    d.doc("Takes the agent into a team: (init (unum n)(teamname t)); unum 0 or none is the lowest free number.");
    d.on<&InitEffector::prepare>(phase::kPrepare);
  }
  std::string predicate() const override { return "init"; }
  std::string act(const Element& action) override {
    const Element unum = action.named("unum"), team = action.named("teamname");
    unum_ = unum ? unum.at(1).integer() : 0;
    team_ = team ? team.at(1).text() : std::string_view();
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
      if (mayTell()) kernel().log().warning("{}: init refused: it needs an AgentState in the robot and soccer's rules below game control", path());
      return;
    }
    if (state->side() != soccer::Side::none && state->team() == team_ && (unum_ == 0 || unum_ == state->unum())) return;  // plays already
    if (const std::string problem = game->join(*state, team_, unum_); !problem.empty()) {
      if (mayTell()) kernel().log().warning("{}: init refused: {}", agent->path(), problem);
      return;
    }
    if (mayTell()) kernel().log().info("{}: plays for '{}' ({}) with number {}", agent->path(), team_, soccer::sideName(state->side()), state->unum());
    dress(*agent, state->side(), state->unum());
    if (auto* scene = game->pitch().scene()) scene->markModified();
    if (const soccer::Player* player = match_.player(*this))
      player->moveTo(game->nextStart(state->side()), degToRad(state->side() == soccer::Side::left ? -90 : 90));
  }

  /// An agent that sends init in every cycle does not fill the log.
  bool mayTell() {
    if (lines_ == kMostLines) return false;
    if (++lines_ == kMostLines) kernel().log().warning("{}: it sends init again and again; what becomes of it is told no more", path());
    return true;
  }

  static constexpr int kMostLines = 20;
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
