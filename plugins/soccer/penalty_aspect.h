#pragma once

#include "foul.h"
#include "player_records.h"
#include "soccer_rule_aspect.h"

namespace spark {

/// Carries out what fouls bring, and tells monitors. The last of the soccer aspects: fouls before it call players in
/// the same cycle.
///
///     sendOff:    called -> held in the air for FoulHoldTime, rising (a foul record in each cycle)
///                        -> beside the field -> free
///     moveAside:  called -> moved (one foul record) -> free
///
/// While the match pauses everybody is free.
class PenaltyAspect : public SoccerControlAspect {
  SPARK_CLASS(PenaltyAspect, SoccerControlAspect)
 public:
  static constexpr double kHoldHeight = 1.0;  ///< m
  static constexpr double kHoldRise = 0.01;   ///< m per cycle of the hold

  static void describe(Description<PenaltyAspect>& d) {
    d.doc("Carries out the penalties of fouls. After all other soccer aspects.");
    d.property("fouls", &PenaltyAspect::count_).readOnly().doc("Number of fouls called since the start.");
  }
  void rule(const Event& event) override;
  /// Switched off, everybody is free.
  void rest(const Event&) override { records_.reset(); }

  /// To be called by fouls before they judge.
  void follow(const soccer::Pitch& pitch) { records_.follow(pitch, *this); }
  /// The player (an index) has no penalty to serve: only then he may be called.
  bool isFree(std::size_t player) const { return records_[player].sentence == Sentence::none; }
  /// He is held, and then placed outside.
  void sendOff(const soccer::Pitch& pitch, std::size_t player, soccer::Foul foul) {
    call(pitch, player, foul, Sentence::off, Vec3::Zero());
  }
  /// He is moved to a safe place near `target` [m], at once.
  void moveAside(const soccer::Pitch& pitch, std::size_t player, soccer::Foul foul, const Vec3& target) {
    call(pitch, player, foul, Sentence::aside, target);
  }
  /// A foul that monitors are told of, and no more.
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
  enum class Sentence { none, off, aside };
  struct Record {
    Sentence sentence = Sentence::none;
    soccer::Foul foul = soccer::Foul::incapable;
    int held = 0;  ///< cycles
    Vec3 target = Vec3::Zero();
    void save(StateWriter& out) const;
    void load(StateReader& in);
  };
  void call(const soccer::Pitch& pitch, std::size_t player, soccer::Foul foul, Sentence sentence, const Vec3& target);
  void serve(const soccer::Pitch& pitch, const soccer::Player& player, Record& record, double step);

  soccer::PlayerRecords<Record> records_;
  std::int64_t count_ = 0;
};

}  // namespace spark
