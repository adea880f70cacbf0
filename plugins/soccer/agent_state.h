#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "api/match.h"
#include "api/phases.h"
#include "field_nodes.h"
#include "play_mode.h"
#include "spark/state.h"

namespace spark {

/// What the match knows of a player: team, number, battery, where it looks, what it heard. Must be named AgentState and
/// stand below the robot's agent aspect. Visible itself: agents see it as `P`.
class AgentState : public ObjectState, public IAgentIdentity, public IEchoTarget {
  SPARK_CLASS(AgentState, ObjectState)
 public:
  static constexpr double kFullBattery = 100;                      ///< %
  static constexpr double kNeverMoved = -1e6;                      ///< s
  static constexpr int kHearCost = 2, kHearMax = 2, kHearInc = 1;  ///< protocol section 3.8

  /// A message on its way from the act phase to the sense phase of the same cycle.
  struct Heard {
    bool waiting = false;
    double directionDeg = 0;  ///< to the speaker, from the team's own x axis
    std::string team, text;
  };

  AgentState() { perceptName_ = "P"; }
  static void describe(Description<AgentState>& d) {
    using S = AgentState;
    d.doc("What the match knows of a player.");
    d.implements<IAgentIdentity>();
    d.implements<IEchoTarget>();
    d.property("robotType", &S::robotType_).min(0).doc("Type of a heterogeneous robot.");
    d.property("team", &S::team_).state().readOnly().doc("Name of its team, \"\" before it was initialised.");
    d.property("side", &S::sideText).state().doc("left, right or none.");
    d.property("unum", &S::unum_).state().readOnly().doc("Uniform number, 0 before it was initialised.");
    d.property("battery", &S::battery_).unit("%").range(0, kFullBattery).state().doc("Energy left.");
    d.property("temperature", &S::temperature_).unit("degC").state().doc("Temperature; nothing changes it by itself.");
    d.property("pan", &S::pan_).unit("deg").state().doc("Where it looks, to the left.");
    d.property("tilt", &S::tilt_).unit("deg").state().doc("Where it looks, up.");
    d.property("selected", &S::selected).doc("A trainer has selected it: its SelectionMarker is visible.");
    d.on<&S::prepare>(phase::kPrepare);
  }

  soccer::Side side() const { return side_; }
  int unum() const { return unum_; }
  const std::string& team() const override { return team_; }
  int number() const override { return unum_; }
  int robotType() const { return robotType_; }
  /// Game state gives (and at half time swaps) sides; `announce`: the agent is told with its next GS.
  void assign(soccer::Side side, int unum, const std::string& team, bool announce) {
    side_ = side;
    unum_ = unum;
    team_ = team;
    announce_ = announce;
  }
  /// True once after assign() announced.
  bool takeAnnouncement() { return std::exchange(announce_, false); }

  double battery() const { return battery_; }
  void setBattery(double percent) { battery_ = std::clamp(percent, 0.0, kFullBattery); }
  /// Takes energy; false (and nothing is taken) when there is not enough.
  bool drain(double percent) { return percent <= battery_ ? (battery_ -= percent, true) : false; }
  double temperature() const { return temperature_; }
  void setTemperature(double celsius) { temperature_ = celsius; }

  /// s of the simulated clock when the referee moved the player last; before the start when he never did.
  double movedAt() const { return movedAt_; }
  void setMovedAt(double time) { movedAt_ = time; }

  double pan() const { return pan_; }
  double tilt() const { return tilt_; }
  void look(double panDeg, double tiltDeg) { pan_ = panDeg, tilt_ = tiltDeg; }

  bool selected() const { return selected_; }
  void select(bool on) { selected_ = on, showMarker(); }

  /// Its own message: the last of a cycle counts.
  void hearSelf(std::string_view text) { own_.waiting = true, own_.text = text, own_.team = team_; }
  /// Somebody else's: the first of a cycle counts, if the ear has recovered.
  void hear(bool mate, const std::string& team, double directionDeg, std::string_view text) {
    const std::size_t ear = mate ? 0 : 1;
    if (heard_[ear].waiting || capacity_[ear] < kHearCost) return;
    capacity_[ear] -= kHearCost;
    heard_[ear].waiting = true;
    heard_[ear].directionDeg = directionDeg;
    heard_[ear].team = team;
    heard_[ear].text = text;
  }
  Heard& own() { return own_; }
  /// 0: the team-mate's message, 1: the opponent's.
  Heard& heard(std::size_t ear) { return heard_[ear]; }
  /// Once per sense cycle.
  void recoverEars() {
    for (int& c : capacity_) c = std::min(c + kHearInc, kHearMax);
  }

 protected:
  void saveState(StateWriter& out) const override {
    out.write(static_cast<int>(side_));
    out.write(unum_);
    out.write(std::string_view(team_));
    out.write(announce_);
    out.write(selected_);
    out.write(movedAt_);
    for (int c : capacity_) out.write(c);
    for (const Heard* h : {&own_, &heard_[0], &heard_[1]}) {
      out.write(h->waiting);
      out.write(h->directionDeg);
      out.write(std::string_view(h->team));
      out.write(std::string_view(h->text));
    }
  }
  void loadState(StateReader& in) override {
    side_ = static_cast<soccer::Side>(in.readInteger());
    unum_ = static_cast<int>(in.readInteger());
    team_ = in.readString();
    announce_ = in.readBool();
    selected_ = in.readBool();
    movedAt_ = in.readNumber();
    for (int& c : capacity_) c = static_cast<int>(in.readInteger());
    for (Heard* h : {&own_, &heard_[0], &heard_[1]}) {
      h->waiting = in.readBool();
      h->directionDeg = in.readNumber();
      h->team = in.readString();
      h->text = in.readString();
    }
  }

 private:
  std::string sideText() const { return soccer::sideName(side_); }
  /// Robots come with a visible marker.
  void prepare(const Event&) {
    if (std::exchange(shownAt_, changedAt()) != changedAt()) showMarker();
  }
  /// Shows or hides the visual named SelectionMarker below, where there is one.
  void showMarker() {
    std::vector<IVisual*> visuals;
    collect(visuals);
    for (IVisual* v : visuals)
      if (v->leaf().name() == "SelectionMarker" && v->visible() != selected_) v->setVisible(selected_);
  }

  soccer::Side side_ = soccer::Side::none;
  int unum_ = 0, robotType_ = 0;
  std::string team_;
  bool announce_ = false, selected_ = false;
  double movedAt_ = kNeverMoved;
  double battery_ = kFullBattery, temperature_ = 20, pan_ = 0, tilt_ = 0;
  std::array<int, 2> capacity_{kHearMax, kHearMax};
  Heard own_;
  std::array<Heard, 2> heard_;
  std::uint64_t shownAt_ = 0;
};

}  // namespace spark
