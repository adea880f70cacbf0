#pragma once
/// \file
/// The environment of monitor messages: keys and order are those of the installed base.

#include "api/monitor.h"
#include "match_lookup.h"

namespace spark {

/// Writes field, time, teams, half, score and play mode. A child of the monitor server.
class GameStateItem : public Node, public IMonitorItem {
  SPARK_CLASS(GameStateItem, Node)
 public:
  static void describe(Description<GameStateItem>& d) {
    d.doc("Sends field, time, teams, half, score and play mode to monitors.");
    d.property("areas", &GameStateItem::areas_)
        .doc("Sends the size of the penalty areas, too: newer monitors draw the lines of any field with it.");
    d.implements<IMonitorItem>();
  }
  void contribute(Environment& env) override;

 private:
  void writeField(Environment& env, const SoccerSettings& s) const;
  void writeScoreWaits(Environment& env, const GameStateAspect& game);
  MatchLookup match_;
  bool areas_ = false;
};

/// Writes fouls. A child of the monitor server, after GameStateItem.
class SoccerRuleItem : public Node, public IMonitorItem {
  SPARK_CLASS(SoccerRuleItem, Node)
 public:
  static void describe(Description<SoccerRuleItem>& d) {
    d.doc("Sends each foul to monitors once: (foul index type team unum).");
    d.implements<IMonitorItem>();
  }
  void contribute(Environment& env) override;

 private:
  MatchLookup match_;
  std::int64_t lastIndex_ = 0;  ///< of the last foul sent
};

}  // namespace spark
