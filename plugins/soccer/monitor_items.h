#pragma once
/// \file
/// What monitors are told of a match (protocol section 4.3).

#include "api/monitor.h"
#include "match_lookup.h"

namespace spark {

/// Field, time, teams, half, score, play mode. Below the monitor server.
class GameStateItem : public Node, public IMonitorItem {
  SPARK_CLASS(GameStateItem, Node)
 public:
  static void describe(Description<GameStateItem>& d) {
    d.doc("Tells monitors field, time, teams, half, score and play mode.");
    d.property("areas", &GameStateItem::areas_)
        .doc("Tells the size of the penalty areas, too: newer monitors draw the lines of any field with it.");
    d.implements<IMonitorItem>();
  }
  void contribute(Environment& env) override;

 private:
  void field(Environment& env, const SoccerSettings& s) const;
  void scoreWaits(Environment& env, const GameStateAspect& game);
  MatchLookup match_;
  bool areas_ = false;
};

/// Fouls. Below the monitor server, after GameStateItem.
class SoccerRuleItem : public Node, public IMonitorItem {
  SPARK_CLASS(SoccerRuleItem, Node)
 public:
  static void describe(Description<SoccerRuleItem>& d) {
    d.doc("Tells monitors of fouls, each once: (foul index type team unum).");
    d.implements<IMonitorItem>();
  }
  void contribute(Environment& env) override;

 private:
  MatchLookup match_;
  std::int64_t told_ = 0;
};

}  // namespace spark
