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

namespace soccer {
/// What an agent asks for by its init action.
struct Application {
  std::string team;
  std::int64_t unum = 0;  ///< 0: the lowest free number
  bool waiting = false;   ///< a player that may hang has the number: applied for again in each cycle
};
}  // namespace soccer

/// The state of a player in the match: team, number, battery, direction of view, messages it heard. A scene node named
/// AgentState below the robot's agent aspect. It is a visible object: agents see it as `P`.
class AgentState : public ObjectState, public IAgentIdentity, public IEchoTarget {
  SPARK_CLASS(AgentState, ObjectState)
 public:
  static constexpr double kFullBattery = 100;  ///< %
  static constexpr double kNeverMoved = -1e6;  ///< s
  /// Hearing of the installed base: for each team a capacity of 2, which grows by 1 in each sense cycle; a message
  /// costs
  /// 2. A player therefore hears one message of each team every two cycles.
  static constexpr int kHearCost = 2, kHearMax = 2, kHearInc = 1;

  /// A message that the player hears in this cycle. It is stored in the act phase and sent in the sense phase.
  struct Message {
    bool pending = false;
    double directionDeg = 0;  ///< to the speaker, relative to the x axis of the hearer's team frame
    std::string team, text;   ///< the speaker's team
  };

  AgentState() { perceptName_ = "P"; }
  static void describe(Description<AgentState>& d) {
    using S = AgentState;
    d.doc("The state of a player in the match.");
    d.implements<IAgentIdentity>();
    d.implements<IEchoTarget>();
    d.property("robotType", &S::robotType_).min(0).doc("Type of a heterogeneous robot.");
    d.property("team", &S::team_).state().readOnly().doc("Name of its team; \"\" before init.");
    d.property("side", &S::sideText).state().doc("left, right or none.");
    d.property("unum", &S::unum_).state().readOnly().doc("Uniform number; 0 before init.");
    d.property("battery", &S::battery_).unit("%").range(0, kFullBattery).state().doc("Energy left.");
    d.property("temperature", &S::temperature_).unit("degC").state().doc("Temperature; only trainers change it.");
    d.property("pan", &S::pan_).unit("deg").state().doc("Direction of view, positive to the left.");
    d.property("tilt", &S::tilt_).unit("deg").state().doc("Direction of view, positive up.");
    d.property("selected", &S::selected).doc("A trainer has selected it: its SelectionMarker is visible.");
    d.on<&S::prepare>(phase::kPrepare);
  }

  /// Side of its team; none before init.
  soccer::Side side() const { return side_; }
  /// Uniform number from 1; 0 before init.
  int unum() const { return unum_; }
  const std::string& team() const override { return team_; }
  int number() const override { return unum_; }
  /// Type of a heterogeneous robot, from 0.
  int robotType() const { return robotType_; }
  /// Sets team and number. Called by game state, which also swaps sides at half time. `announce`: the agent gets both
  /// in its next GS percept.
  void assign(soccer::Side side, int unum, const std::string& team, bool announce) {
    side_ = side;
    unum_ = unum;
    team_ = team;
    announce_ = announce;
  }
  /// True once after an assign() with `announce`.
  bool takeAnnouncement() { return std::exchange(announce_, false); }

  /// Its last application.
  soccer::Application& application() { return application_; }

  /// Energy left [%], 0 to 100.
  double battery() const { return battery_; }
  /// Sets the energy [%], clamped to 0..100.
  void setBattery(double percent) { battery_ = std::clamp(percent, 0.0, kFullBattery); }
  /// Consumes energy [%]. Returns false and consumes nothing when there is not enough.
  bool drain(double percent) { return percent <= battery_ ? (battery_ -= percent, true) : false; }
  /// Temperature [degC].
  double temperature() const { return temperature_; }
  void setTemperature(double celsius) { temperature_ = celsius; }

  /// Simulated time of the last move by the referee [s]; kNeverMoved when there was none.
  double movedAt() const { return movedAt_; }
  void setMovedAt(double time) { movedAt_ = time; }

  /// Direction of view [deg], positive to the left.
  double pan() const { return pan_; }
  /// Direction of view [deg], positive up.
  double tilt() const { return tilt_; }
  void setView(double panDeg, double tiltDeg) { pan_ = panDeg, tilt_ = tiltDeg; }

  /// True while a trainer has selected the player.
  bool selected() const { return selected_; }
  void select(bool on) { selected_ = on, showMarker(); }

  /// Stores the echo of the player's own message. The last message of a cycle replaces earlier ones.
  void hearSelf(std::string_view text) { own_.pending = true, own_.text = text, own_.team = team_; }
  /// Stores a message of another player. For team-mates and opponents each, only the first message of a cycle counts,
  /// and only while there is hearing capacity.
  void hear(bool mate, const std::string& team, double directionDeg, std::string_view text) {
    const std::size_t channel = mate ? kMate : kOpponent;
    if (heard_[channel].pending || capacity_[channel] < kHearCost) return;
    capacity_[channel] -= kHearCost;
    heard_[channel].pending = true;
    heard_[channel].directionDeg = directionDeg;
    heard_[channel].team = team;
    heard_[channel].text = text;
  }
  /// Channels of heard().
  static constexpr std::size_t kMate = 0, kOpponent = 1;
  /// The echo of the player's own message.
  Message& own() { return own_; }
  /// The message of a team-mate or an opponent.
  Message& heard(std::size_t channel) { return heard_[channel]; }
  /// Restores hearing capacity. Called once in each sense cycle.
  void recoverHearing() {
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
    out.aside(application_.waiting ? fmt::format("{} {}", application_.unum, application_.team) : std::string());
    for (int c : capacity_) out.write(c);
    for (const Message* m : {&own_, &heard_[kMate], &heard_[kOpponent]}) {
      out.write(m->pending);
      out.write(m->directionDeg);
      out.write(std::string_view(m->team));
      out.write(std::string_view(m->text));
    }
  }
  void loadState(StateReader& in) override {
    side_ = static_cast<soccer::Side>(in.readInteger());
    unum_ = static_cast<int>(in.readInteger());
    team_ = in.readString();
    announce_ = in.readBool();
    selected_ = in.readBool();
    movedAt_ = in.readNumber();
    const std::string waiting = in.readString();
    const std::size_t blank = waiting.find(' ');
    application_ = {};
    if (blank != waiting.npos) application_ = {waiting.substr(blank + 1), std::stoll(waiting), true};
    for (int& c : capacity_) c = static_cast<int>(in.readInteger());
    for (Message* m : {&own_, &heard_[kMate], &heard_[kOpponent]}) {
      m->pending = in.readBool();
      m->directionDeg = in.readNumber();
      m->team = in.readString();
      m->text = in.readString();
    }
  }

 private:
  std::string sideText() const { return soccer::sideName(side_); }
  /// Updates the marker when the robot's nodes have changed: scene files load it visible.
  void prepare(const Event&) {
    if (std::exchange(shownAt_, changedAt()) != changedAt()) showMarker();
  }
  /// Shows or hides the visuals named SelectionMarker below this node.
  void showMarker() {
    std::vector<IVisual*> visuals;
    collect(visuals);
    for (IVisual* v : visuals)
      if (v->leaf().name() == "SelectionMarker" && v->visible() != selected_) v->setVisible(selected_);
  }

  soccer::Side side_ = soccer::Side::none;
  int unum_ = 0, robotType_ = 0;
  std::string team_;
  soccer::Application application_;
  bool announce_ = false, selected_ = false;
  double movedAt_ = kNeverMoved;
  double battery_ = kFullBattery, temperature_ = 20, pan_ = 0, tilt_ = 0;
  std::array<int, 2> capacity_{kHearMax, kHearMax};  ///< for messages of team-mates and of opponents
  Message own_;
  std::array<Message, 2> heard_;
  std::uint64_t shownAt_ = 0;  ///< changedAt() when the marker was last updated
};

}  // namespace spark
