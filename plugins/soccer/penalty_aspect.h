#pragma once

#include "foul.h"
#include "player_records.h"
#include "soccer_rule_aspect.h"

namespace spark {

/// Carries out penalties and reports fouls to monitors. The last of the soccer aspects: penalties start in the cycle in
/// which the foul is called. As in the installed base:
///
///     sendOff:    foul called -> lifted and held for FoulHoldTime (a foul record in each cycle)
///                             -> moved beside the field -> free
///     moveAside:  foul called -> moved (one foul record) -> free
///
/// A pause of the match ends all penalties.
class PenaltyAspect : public SoccerControlAspect {
  SPARK_CLASS(PenaltyAspect, SoccerControlAspect)
 public:
  // In the n-th cycle of the hold the torso is at z = kHoldHeight + n * kHoldRise.
  static constexpr double kHoldHeight = 1.0;  ///< m
  static constexpr double kHoldRise = 0.01;   ///< m

  static void describe(Description<PenaltyAspect>& d) {
    d.doc("Carries out the penalties of fouls. Must be after all other soccer aspects.");
    d.property("fouls", &PenaltyAspect::count_).readOnly().doc("Number of fouls called since the start.");
  }
  void rule(const Event& event) override;
  /// Disabled: no player serves a penalty.
  void rest(const Event&) override { records_.reset(); }

  /// Matches the records to the players of this cycle. Fouls call it before they judge.
  void follow(const soccer::Pitch& pitch) { records_.follow(pitch, *this); }
  /// True when the player (an index) serves no penalty. Fouls of other players are ignored.
  bool isFree(std::size_t player) const { return records_[player].penalty == Penalty::none; }
  /// Calls a foul: the player is held and then moved beside the field.
  void sendOff(const soccer::Pitch& pitch, std::size_t player, soccer::Foul foul) {
    call(pitch, player, foul, Penalty::sendOff, Vec3::Zero());
  }
  /// Calls a foul: the player is moved to a safe position near `target` [m] in this cycle.
  void moveAside(const soccer::Pitch& pitch, std::size_t player, soccer::Foul foul, const Vec3& target) {
    call(pitch, player, foul, Penalty::moveAside, target);
  }
  /// Reports a foul without a penalty to monitors.
  void report(const soccer::Player& player, soccer::Foul foul);

 protected:
  void saveState(StateWriter& out) const override {
    out.write(Value(count_));
    records_.save(out);
  }
  void loadState(StateReader& in) override {
    count_ = in.readValue().toInteger();
    records_.load(in);
  }

 private:
  enum class Penalty { none, sendOff, moveAside };
  struct Record {
    Penalty penalty = Penalty::none;
    soccer::Foul foul = soccer::Foul::incapable;
    int cyclesHeld = 0;
    Vec3 target = Vec3::Zero();  ///< of moveAside [m]
    void save(StateWriter& out) const;
    void load(StateReader& in);
  };
  void call(const soccer::Pitch& pitch, std::size_t player, soccer::Foul foul, Penalty penalty, const Vec3& target);
  /// Carries out one cycle of a penalty.
  void serve(const soccer::Pitch& pitch, const soccer::Player& player, Record& record, double step);

  soccer::PlayerRecords<Record> records_;
  std::int64_t count_ = 0;  ///< fouls called
};

}  // namespace spark
