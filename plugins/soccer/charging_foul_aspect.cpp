#include "charging_foul_aspect.h"

namespace spark {

namespace {
/// Angle between two vectors [deg]; 0 when one of them is zero.
double angleDeg(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double lengths = a.norm() * b.norm();
  return lengths > 1e-12 ? radToDeg(std::acos(std::clamp(a.dot(b) / lengths, -1.0, 1.0))) : 0;
}
}  // namespace

void ChargingFoulAspect::judgePlay(const Event& event) {
  follow(histories_);
  updateHistories(event.time);

  // Forget harmless contacts that have ended.
  std::erase_if(harmless_, [&](const HarmlessContact& h) {
    return event.time - h.time >= settings().chargingCollisionMinTime - 1e-9;
  });
  if (!contacts() || !settings().useCharging) return;
  for (const Pair& contact : contacts()->pairs())
    if (players()[contact.a].side() == opponent(players()[contact.b].side())) judgePair(contact, event.time);
}

void ChargingFoulAspect::reset() {
  histories_.reset();
  harmless_.clear();
}

void ChargingFoulAspect::updateHistories(double now) {
  for (std::size_t i = 0; i < players().size(); ++i) {
    const soccer::Player& p = players()[i];
    if (!p.torso) continue;
    History& h = histories_[i];
    std::rotate(h.velocities.begin(), h.velocities.end() - 1, h.velocities.end());
    h.velocities[0] = p.torso->state().linearVelocity.head<2>();
    h.known = std::min(h.known + 1, kCycles);
    const bool kicked = ball().touched() && ball().last().agent == p.agent->number();
    if (kicked || (contacts() && contacts()->touchesBall(static_cast<int>(i)))) h.touchedBall = now;
  }
}

void ChargingFoulAspect::judgePair(const Pair& contact, double now) {
  const std::array<std::size_t, 2> player{static_cast<std::size_t>(contact.a), static_cast<std::size_t>(contact.b)};
  if (!isEligible(player[0]) || !isEligible(player[1]) || continuesHarmless(contact, now)) return;
  const std::array<Motion, 2> pair{motion(player[0], player[1]), motion(player[1], player[0])};
  const Vec2 point = contact.point.head<2>();

  std::array<bool, 2> charges = chargesByConduct(pair);
  for (int i : {0, 1}) charges[i] = charges[i] && isFastEnough(pair[i], pair[1 - i], point);

  const bool nearBall = (point - ball().position().head<2>()).norm() < settings().chargingMinCollBallDist;
  const int offender = charges[0] ? 0 : 1;
  if (charges[0] != charges[1] && !nearBall) {
    if (!isImmune(player[offender], now)) return sendOff(player[offender], Foul::charging);
    histories_[player[1 - offender]].wasCharged = now;
  }
  harmless_.push_back({players()[player[0]].agent->number(), players()[player[1]].agent->number(), now});
}

bool ChargingFoulAspect::isEligible(std::size_t player) const {
  const soccer::Player& p = players()[player];
  return isJudged(player) && !isDown(p) && !pitch().movedWithin(p, kMovedTime);
}

bool ChargingFoulAspect::continuesHarmless(const Pair& contact, double now) {
  const int a = players()[contact.a].agent->number(), b = players()[contact.b].agent->number();
  const auto earlier =
      std::find_if(harmless_.begin(), harmless_.end(), [&](const HarmlessContact& h) { return h.a == a && h.b == b; });
  if (earlier == harmless_.end()) return false;
  earlier->time = now;
  return true;
}

ChargingFoulAspect::Motion ChargingFoulAspect::motion(std::size_t player, std::size_t opponent) const {
  Motion m;
  m.player = player;
  m.position = players()[player].position().head<2>();
  m.velocity = histories_[player].velocity();
  m.speed = m.velocity.norm();
  const Vec2 toBall = ball().position().head<2>() - m.position;
  m.ballDistance = toBall.norm();
  m.ballAngle = angleDeg(m.velocity, toBall);
  m.opponentAngle = angleDeg(m.velocity, players()[opponent].position().head<2>() - m.position);
  return m;
}

std::array<bool, 2> ChargingFoulAspect::chargesByConduct(const std::array<Motion, 2>& pair) const {
  const SoccerSettings& s = settings();
  const auto& [a, b] = pair;
  if (std::min(a.ballDistance, b.ballDistance) >= s.chargingMaxBallRulesDist) return {true, true};

  // Near the ball: a player charges when it moves fast, not towards the ball, and rather towards the opponent.
  std::array<bool, 2> charges{};
  for (int i : {0, 1})
    charges[i] = pair[i].ballAngle >= pair[i].opponentAngle && pair[i].ballAngle >= s.chargingMinBallSpeedAngle &&
                 pair[i].speed >= s.chargingMinSpeed;
  if (charges[0] || charges[1] || std::abs(a.ballDistance - b.ballDistance) <= s.chargingMinDeltaDist) return charges;

  // Neither does: the player farther from the ball charges when the angles towards each other differ clearly, or when
  // the other is slow.
  const int farther = a.ballDistance > b.ballDistance ? 0 : 1;
  charges[farther] = std::abs(a.opponentAngle - b.opponentAngle) > s.chargingMinDeltaAng ||
                     pair[1 - farther].speed < s.chargingMinSpeed;
  return charges;
}

bool ChargingFoulAspect::isFastEnough(const Motion& self, const Motion& other, const Vec2& contact) const {
  const Vec2 towards = (contact + other.position) / 2 - self.position;
  const double distance = towards.norm();
  return self.speed >= settings().chargingMinSpeed && distance > 1e-9 &&
         self.velocity.dot(towards) / distance >= settings().chargingMinCollisionSpeed;
}

bool ChargingFoulAspect::isImmune(std::size_t player, double now) const {
  const soccer::Player& p = players()[player];
  const History& h = histories_[player];
  const double immunity = settings().chargingImmunityTime + 1e-9;
  const bool isTaker = settings().keepaway && p.side() == Side::right;  // takers of keep-away never charge
  return isTaker || (isGoalie(player) && inOwnArea(p)) || now - h.touchedBall <= immunity ||
         now - h.wasCharged <= immunity;
}

void ChargingFoulAspect::saveState(StateWriter& out) const {
  histories_.save(out);
  out.write(static_cast<std::int64_t>(harmless_.size()));
  for (const HarmlessContact& h : harmless_) out.write(h.a), out.write(h.b), out.write(h.time);
}

void ChargingFoulAspect::loadState(StateReader& in) {
  histories_.load(in);
  harmless_.resize(static_cast<std::size_t>(in.readInteger()));
  for (HarmlessContact& h : harmless_) {
    h.a = static_cast<int>(in.readInteger());
    h.b = static_cast<int>(in.readInteger());
    h.time = in.readNumber();
  }
}

void ChargingFoulAspect::History::save(StateWriter& out) const {
  for (const Vec2& v : velocities) out.write(v.x()), out.write(v.y());
  out.write(known);
  out.write(touchedBall);
  out.write(wasCharged);
}

void ChargingFoulAspect::History::load(StateReader& in) {
  for (Vec2& v : velocities) {
    v.x() = in.readNumber();
    v.y() = in.readNumber();
  }
  known = static_cast<int>(in.readInteger());
  touchedBall = in.readNumber();
  wasCharged = in.readNumber();
}

}  // namespace spark
