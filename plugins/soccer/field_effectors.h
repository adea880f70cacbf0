#pragma once
/// \file
/// The effectors of all leagues: beam and say.

#include "match_lookup.h"

namespace spark {

/// `(beam x y angle)`: moves the robot to a position in its own half [m, m, deg], in its team's frame (the opponents'
/// goal towards +x). Acts before kick-offs and after goals only.
class BeamEffector : public Effector {
  SPARK_CLASS(BeamEffector, Effector)
 public:
  static void describe(Description<BeamEffector>& d) {
    d.doc("Moves to a position in the own half: (beam x y angle), m and deg; only before kick-offs and after goals.");
    d.property("random", &BeamEffector::random_).state().doc("Its noise.");
    d.on<&BeamEffector::prepare>(phase::kPrepare);
  }
  std::string predicate() const override { return "beam"; }
  std::string act(const Element& action) override {
    NumberArguments read(action);
    double v[3];
    if (!readNumbers(read, v, 3)) return read.remark();
    x_ = static_cast<float>(v[0]), y_ = static_cast<float>(v[1]), angle_ = static_cast<float>(v[2]);
    pending_ = true;
    return read.remark();
  }

 private:
  static constexpr float kMaxCoordinate = 1000;  ///< m
  void prepare(const Event&) {
    if (!std::exchange(pending_, false)) return;
    const soccer::Player* player = match_.player(*this);
    if (!player) return refuse(0, [&] { return match_.whyNoPlayer(); });
    if (!match_.game()->paused())
      return refuse(1, [&] {
        return fmt::format("expected a mode before a kick-off or after a goal, found {}",
                           playModeName(match_.game()->mode()));
      });
    const SoccerSettings& s = *match_.settings();
    remarkOnLimits(s);
    // In single precision, as in the installed base: the exact position decides the last digit of every later percept.
    const auto noise = [&](double width) { return static_cast<float>(width * random_.uniform(-1, 1)); };
    float x = x_ + noise(s.beamNoiseXY), y = y_ + noise(s.beamNoiseXY);
    const float angle = angle_ + noise(s.beamNoiseAngle);

    // The installed base clamps after the noise.
    if (!s.startAnyFieldPosition) x = std::clamp(x, static_cast<float>(-s.fieldLength / 2), 0.0F);
    if (const auto maxY = static_cast<float>(s.fieldWidth / 2); s.beamWithinFieldWidth) y = std::clamp(y, -maxY, maxY);
    // In leagues without these limits, keep the numbers within the range of the engine.
    x = std::clamp(x, -kMaxCoordinate, kMaxCoordinate), y = std::clamp(y, -kMaxCoordinate, kMaxCoordinate);

    // Robots look along their y axis: angle 0 faces the opponents' goal.
    const bool left = player->side() == soccer::Side::left;
    const float yaw = left ? angle - 90 : angle + 90, d = left ? 1 : -1;
    player->moveTo(Vec3(d * x, d * y, s.agentRadius), degToRad(yaw));
  }

  /// Logs a position that is clamped, apart from the noise.
  void remarkOnLimits(const SoccerSettings& s) {
    if (!s.startAnyFieldPosition && (x_ > 0 || x_ < static_cast<float>(-s.fieldLength / 2)))
      refuse(2,
             [&] { return fmt::format("expected x from {} to 0, found {}: it is clamped", -s.fieldLength / 2, x_); });
    const double maxY = s.beamWithinFieldWidth ? s.fieldWidth / 2 : kMaxCoordinate;
    if (std::abs(y_) > static_cast<float>(maxY))
      refuse(3, [&] { return fmt::format("expected y from {} to {}, found {}: it is clamped", -maxY, maxY, y_); });
  }

  MatchLookup match_;
  RandomStream random_{*this, "beam"};
  float x_ = 0, y_ = 0;  ///< m
  float angle_ = 0;      ///< deg
  bool pending_ = false;
};

/// `(say message)`: players within range get the message in the percepts of the same cycle.
class SayEffector : public Effector {
  SPARK_CLASS(SayEffector, Effector)
 public:
  static constexpr double kRange = 50;  ///< of the installed base [m]

  static void describe(Description<SayEffector>& d) {
    d.doc("Says something: (say message), at most Soccer.SayMsgSize printable characters, heard within 50 m.");
  }
  std::string predicate() const override { return "say"; }
  std::string act(const Element& action) override {
    const Element word = action.at(1);
    if (!word) return "expected one word, found none";
    if (!word.isText()) return fmt::format("expected one word, found {}", word.isList() ? "a list" : "a number");
    const std::string_view text = word.text();
    if (text.empty()) return "expected one word, found an empty one";
    for (const unsigned char c : text)
      if (c < 0x21 || c > 0x7e || c == '(' || c == ')')
        return fmt::format("expected printable characters without blanks and brackets, found byte {}", int(c));
    const soccer::Player* speaker = match_.player(*this);
    if (!speaker) return match_.whyNoPlayer();
    if (const auto most = std::size_t(match_.settings()->sayMsgSize); text.size() > most)
      return fmt::format("expected at most {} bytes, found {}: nobody hears it", most, text.size());
    speaker->state->hearSelf(text);
    const Vec3 origin = speaker->position();
    for (const soccer::Player& hearer : match_.game()->pitch().players()) {
      if (&hearer == speaker || hearer.side() == soccer::Side::none) continue;
      const Vec3 offset = (origin - hearer.position()) * direction(hearer.side());
      if (offset.norm() > kRange) continue;
      hearer.state->hear(hearer.side() == speaker->side(), speaker->state->team(),
                         radToDeg(std::atan2(offset.y(), offset.x())), text);
    }
    if (action.at(2)) return fmt::format("expected one word, found {}: only the first is said", action.size() - 1);
    return {};
  }

 private:
  MatchLookup match_;
};

}  // namespace spark
