#include "charging_foul_aspect.h"

namespace spark {

namespace {
/// Degrees between two directions; 0 when one of them is none.
double angleDeg(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double lengths = a.norm() * b.norm();
  return lengths > 1e-12 ? radToDeg(std::acos(std::clamp(a.dot(b) / lengths, -1.0, 1.0))) : 0;
}
}  // namespace

void ChargingFoulAspect::judgePlay(const Event& event) {
  follow(runners_);
  observe(event.time);
  std::erase_if(harmless_,
                [&](const Harmless& h) { return event.time - h.time >= settings().chargingCollisionMinTime - 1e-9; });
  if (!contacts() || !settings().useCharging) return;
  for (const Meeting& m : contacts()->meetings())
    if (players()[m.a].side() == opponent(players()[m.b].side())) judgeMeeting(m, event.time);
}

void ChargingFoulAspect::reset() {
  runners_.reset();
  harmless_.clear();
}

void ChargingFoulAspect::observe(double now) {
  for (std::size_t i = 0; i < players().size(); ++i) {
    const soccer::Player& p = players()[i];
    if (!p.torso) continue;
    Runner& r = runners_[i];
    std::rotate(r.velocities.begin(), r.velocities.end() - 1, r.velocities.end());
    r.velocities[0] = p.torso->state().linearVelocity.head<2>();
    r.known = std::min(r.known + 1, kCycles);
    const bool kicked = ball().touched() && ball().last().agent == p.agent->number();
    if (kicked || (contacts() && contacts()->atBall(static_cast<int>(i)))) r.touchedBall = now;
  }
}

void ChargingFoulAspect::judgeMeeting(const Meeting& meeting, double now) {
  const std::array<std::size_t, 2> who{static_cast<std::size_t>(meeting.a), static_cast<std::size_t>(meeting.b)};
  if (!mayCharge(who[0]) || !mayCharge(who[1]) || wentOn(meeting, now)) return;
  const std::array<Party, 2> pair{party(who[0], who[1]), party(who[1], who[0])};
  const Vec2 contact = meeting.point.head<2>();
  std::array<bool, 2> charges = conduct(pair);
  for (int i : {0, 1}) charges[i] = charges[i] && runsInto(pair[i], pair[1 - i], contact);
  const bool atBall = (contact - ball().position().head<2>()).norm() < settings().chargingMinCollBallDist;
  const int guilty = charges[0] ? 0 : 1;
  if (charges[0] != charges[1] && !atBall) {
    if (!isImmune(who[guilty], now)) return sendOff(who[guilty], Foul::charging);
    runners_[who[1 - guilty]].wasPushed = now;
  }
  harmless_.push_back({players()[who[0]].agent->number(), players()[who[1]].agent->number(), now});
}

bool ChargingFoulAspect::mayCharge(std::size_t player) const {
  const soccer::Player& p = players()[player];
  return isJudged(player) && !isDown(p) && !pitch().movedWithin(p, kMovedTime);
}

/// The contact goes on after a harmless one, and so is harmless itself.
bool ChargingFoulAspect::wentOn(const Meeting& meeting, double now) {
  const int a = players()[meeting.a].agent->number(), b = players()[meeting.b].agent->number();
  const auto before =
      std::find_if(harmless_.begin(), harmless_.end(), [&](const Harmless& h) { return h.a == a && h.b == b; });
  if (before == harmless_.end()) return false;
  before->time = now;
  return true;
}

ChargingFoulAspect::Party ChargingFoulAspect::party(std::size_t player, std::size_t opponent) const {
  Party p;
  p.player = player;
  p.position = players()[player].position().head<2>();
  p.velocity = runners_[player].velocity();
  p.speed = p.velocity.norm();
  const Vec2 toBall = ball().position().head<2>() - p.position;
  p.ballDistance = toBall.norm();
  p.ballAngle = angleDeg(p.velocity, toBall);
  p.opponentAngle = angleDeg(p.velocity, players()[opponent].position().head<2>() - p.position);
  return p;
}

std::array<bool, 2> ChargingFoulAspect::conduct(const std::array<Party, 2>& pair) const {
  const SoccerSettings& s = settings();
  const auto& [a, b] = pair;
  if (std::min(a.ballDistance, b.ballDistance) >= s.chargingMaxBallRulesDist) return {true, true};
  std::array<bool, 2> charges{};
  for (int i : {0, 1})
    charges[i] = pair[i].ballAngle >= pair[i].opponentAngle && pair[i].ballAngle >= s.chargingMinBallSpeedAngle &&
                 pair[i].speed >= s.chargingMinSpeed;
  if (charges[0] || charges[1] || std::abs(a.ballDistance - b.ballDistance) <= s.chargingMinDeltaDist) return charges;
  const int farther = a.ballDistance > b.ballDistance ? 0 : 1;
  charges[farther] = std::abs(a.opponentAngle - b.opponentAngle) > s.chargingMinDeltaAng ||
                     pair[1 - farther].speed < s.chargingMinSpeed;
  return charges;
}

/// Fast, and fast towards the point midway between the contact and the opponent.
bool ChargingFoulAspect::runsInto(const Party& self, const Party& other, const Vec2& contact) const {
  const Vec2 towards = (contact + other.position) / 2 - self.position;
  const double far = towards.norm();
  return self.speed >= settings().chargingMinSpeed && far > 1e-9 &&
         self.velocity.dot(towards) / far >= settings().chargingMinCollisionSpeed;
}

bool ChargingFoulAspect::isImmune(std::size_t player, double now) const {
  const soccer::Player& p = players()[player];
  const Runner& r = runners_[player];
  const double time = settings().chargingImmunityTime + 1e-9;
  const bool taker = settings().keepaway && p.side() == Side::right;
  return taker || (isGoalie(player) && inOwnArea(p)) || now - r.touchedBall <= time || now - r.wasPushed <= time;
}

void ChargingFoulAspect::saveState(StateWriter& out) const {
  runners_.save(out);
  out.write(static_cast<std::int64_t>(harmless_.size()));
  for (const Harmless& h : harmless_) out.write(h.a), out.write(h.b), out.write(h.time);
}

void ChargingFoulAspect::loadState(StateReader& in) {
  runners_.load(in);
  harmless_.resize(static_cast<std::size_t>(in.readInteger()));
  for (Harmless& h : harmless_) {
    h.a = static_cast<int>(in.readInteger());
    h.b = static_cast<int>(in.readInteger());
    h.time = in.readNumber();
  }
}

void ChargingFoulAspect::Runner::save(StateWriter& out) const {
  for (const Vec2& v : velocities) out.write(v.x()), out.write(v.y());
  out.write(known);
  out.write(touchedBall);
  out.write(wasPushed);
}

void ChargingFoulAspect::Runner::load(StateReader& in) {
  for (Vec2& v : velocities) {
    v.x() = in.readNumber();
    v.y() = in.readNumber();
  }
  known = static_cast<int>(in.readInteger());
  touchedBall = in.readNumber();
  wasPushed = in.readNumber();
}

}  // namespace spark
