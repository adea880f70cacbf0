#include "pitch.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "spark/prefetch.h"

namespace spark::soccer {

Bounds Player::bounds() const {
  constexpr std::size_t kAhead = 3;            // colliders
  constexpr std::size_t kColliderBytes = 384;  // that bounds() reads of a collider
  Bounds all;
  Vec3 low, high;
  for (std::size_t i = 0; i < colliders.size(); ++i) {
    // The solver has displaced the colliders from the CPU caches, so prefetch the collider three positions ahead.
    if (i + kAhead < colliders.size()) prefetch(colliders[i + kAhead], kColliderBytes);
    colliders[i]->bounds(low, high);
    all.low = all.low.cwiseMin(low);
    all.high = all.high.cwiseMax(high);
  }
  return all;
}

namespace {

// Moves are computed like in the installed base, in single precision and with sums from left to right: the last digit
// of a robot's position decides every later digit of its motion.

Eigen::Matrix3f product(const Eigen::Matrix3f& a, const Eigen::Matrix3f& b) {
  Eigen::Matrix3f out;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      out(row, column) = (a(row, 0) * b(0, column) + a(row, 1) * b(1, column)) + a(row, 2) * b(2, column);
  return out;
}

Vec3f rotated(const Eigen::Matrix3f& a, const Vec3f& v) {
  Vec3f out;
  for (int row = 0; row < 3; ++row) out[row] = (a(row, 0) * v[0] + a(row, 1) * v[1]) + a(row, 2) * v[2];
  return out;
}

void stop(IRigidBody& body) {
  body.setVelocity(Vec3::Zero());
  body.setAngularVelocity(Vec3::Zero());
}

}  // namespace

void Player::moveTo(const Vec3& target) const {
  const Vec3f from = position().cast<float>(), to = target.cast<float>();
  for (IRigidBody* b : bodies) {
    const Vec3f moved = to + (b->state().position.cast<float>() - from);
    b->setPosition(moved.cast<double>());
    stop(*b);
  }
}

void Player::moveTo(const Vec3& target, double yaw) const {
  const float angle = static_cast<float>(yaw), c = std::cos(angle), s = std::sin(angle);
  Eigen::Matrix3f upright;
  upright << c, -s, 0, s, c, 0, 0, 0, 1;
  setPose(target, upright.cast<double>());
}

void Player::rotateTo(const Mat3& orientation) const { setPose(position(), orientation); }

void Player::setPose(const Vec3& target, const Mat3& orientation) const {
  if (!torso) return;
  const engine::BodyState reference = torso->state();
  const Vec3f from = reference.position.cast<float>(), to = target.cast<float>();
  const Eigen::Matrix3f rotation = product(orientation.cast<float>(), reference.rotation.cast<float>().transpose());
  for (IRigidBody* b : bodies) {
    const engine::BodyState old = b->state();
    const Vec3f moved = to + rotated(rotation, old.position.cast<float>() - from);
    b->setPose({moved.cast<double>(), product(rotation, old.rotation.cast<float>()).cast<double>()});
    stop(*b);
  }
}

namespace {
/// The player of an agent. Its state is nullptr if the agent has no robot of a player.
Player makePlayer(AgentAspect& agent) {
  Player p;
  p.agent = &agent;
  p.changedAt = agent.changedAt();
  p.state = Below<AgentState>().find(agent).object;
  if (!p.state) return p;
  agent.collect(p.bodies);
  agent.collect(p.colliders);
  auto* inner = p.state->ancestor<AgentAspect>();
  p.torso = inner ? Below<IRigidBody>().find(*inner).object : nullptr;
  if (!p.torso && !p.bodies.empty()) p.torso = p.bodies.front();
  return p;
}
}  // namespace

void Pitch::refresh(Kernel& kernel) {
  if (!tree_.changed(kernel.root())) return;
  Node& root = kernel.root();
  settings_ = root.find<SoccerSettings>();
  gameControl_ = root.find<IGameControl>();
  simulation_ = root.find<ISimulation>();
  scene_ = root.find<ISceneServer>();
  ball_ = nullptr;
  ballRecorder_ = leftGoal_ = rightGoal_ = nullptr;
  if (Node* field = scene_ ? scene_->activeScene() : nullptr; field && settings_) {
    if (Node* ball = field->find<Node>("Ball")) ball_ = Below<IRigidBody>().find(*ball).object;
    ballRecorder_ = field->find<ICollisionRecorder>(settings_->ballRecorder);
    leftGoal_ = field->find<ICollisionRecorder>(settings_->leftGoalRecorder);
    rightGoal_ = field->find<ICollisionRecorder>(settings_->rightGoalRecorder);
  }
  kernel.updateOrder();
  findPlayers();
}

void Pitch::findPlayers() {
  // Look up the robots that are new or have changed; take over all others.
  std::vector<Player> now;
  if (gameControl_)
    for (AgentAspect* agent : gameControl_->agents()) {
      const std::size_t old = indexOf(agent);
      const bool unchanged = old < players_.size() && players_[old].changedAt == agent->changedAt();
      if (Player p = unchanged ? std::move(players_[old]) : makePlayer(*agent); p.state) now.push_back(std::move(p));
    }
  players_ = std::move(now);

  byAgent_.clear();
  for (const Player& p : players_) byAgent_.emplace_back(p.agent, byAgent_.size());
  std::sort(byAgent_.begin(), byAgent_.end(),
            [](const auto& a, const auto& b) { return std::less<>()(a.first, b.first); });
  order_.reserve(players_.size());  // so that no rule allocates
}

std::size_t Pitch::indexOf(const Leaf* agent) const {
  const auto it = std::lower_bound(byAgent_.begin(), byAgent_.end(), agent,
                                   [](const auto& entry, const Leaf* l) { return std::less<>()(entry.first, l); });
  return it != byAgent_.end() && it->first == agent ? it->second : players_.size();
}

const Player* Pitch::player(Side side, int unum) const {
  if (side == Side::none) return nullptr;
  for (const Player& p : players_)
    if (p.side() == side && p.state->unum() == unum) return &p;
  return nullptr;
}

const Player* Pitch::playerOfAgent(int agentNumber) const {
  for (const Player& p : players_)
    if (p.agent->number() == agentNumber) return &p;
  return nullptr;
}

const Player* Pitch::playerOf(const Leaf* leaf) const {
  for (; leaf; leaf = leaf->parent())
    if (const std::size_t i = indexOf(leaf); i < players_.size()) return &players_[i];
  return nullptr;
}

int Pitch::count(Side side) const {
  int n = 0;
  for (const Player& p : players_) n += p.side() == side;
  return n;
}

void Pitch::placeBall(const Vec3& position) const {
  if (!ball_) return;
  ball_->enable();  // even if it is awake: this restarts its idle time
  ball_->setPosition(position);
  ball_->setVelocity(Vec3::Zero());
  ball_->setAngularVelocity(Vec3::Zero());
}

Area Pitch::penaltyArea(Side side) const {
  const double half = settings_->fieldLength / 2, front = half - settings_->penaltyLength;
  const double width = (settings_->penaltyWidth + (settings_->penaltyWidthBeyondGoal ? settings_->goalWidth : 0)) / 2;
  return side == Side::left ? Area{-half, -width, -front, width} : Area{front, -width, half, width};
}

Area Pitch::opponentHalf(Side side) const {
  constexpr double kUnlimited = 1e6;  // m
  return side == Side::left ? Area{0, -kUnlimited, kUnlimited, kUnlimited}
                            : Area{-kUnlimited, -kUnlimited, 0, kUnlimited};
}

Vec3 Pitch::freeBallPosition(const Vec3& wanted) const {
  Vec3 p = wanted;
  for (Side s : {Side::left, Side::right}) {
    const Area a = penaltyArea(s);
    if (!a.contains(p.x(), p.y())) continue;
    p.x() = s == Side::left ? a.maxX : a.minX;
    p.y() = p.y() < 0 ? a.minY : a.maxY;
  }
  const double edge = settings_->fieldWidth / 2 - settings_->ballRadius;
  p.y() = std::clamp(p.y(), -edge, edge);
  return p;
}

template <class F>
void Pitch::forEachShuffled(Side side, RandomStream& random, F each) const {
  order_.clear();
  for (const Player& p : players_)
    if (p.side() == side && p.torso) order_.push_back(&p);
  random.shuffle(std::span(order_));
  for (const Player* p : order_) each(*p);
}

void Pitch::clearSphere(const Player& player, const Vec3& centre, double radius, double distance) const {
  if (!player.bounds().intersectsSphere(centre, radius)) return;
  const double d = direction(player.side());
  Vec3 target = player.position();
  target.x() = centre.x() - d * distance;
  if (d * target.x() < -settings_->fieldLength / 2) {
    target.x() = player.position().x();
    target.y() = centre.y() + (centre.y() > 0 ? -distance : distance);
  }
  moveSafely(player, target, true);
}

void Pitch::clearSphere(Side side, const Vec3& centre, double radius, double distance, RandomStream& random) const {
  forEachShuffled(side, random, [&](const Player& p) { clearSphere(p, centre, radius, distance); });
}

void Pitch::clearArea(Side side, const Area& area, double distance, RandomStream& random) const {
  forEachShuffled(side, random, [&](const Player& p) {
    if (!area.intersects(p.bounds())) return;
    Vec3 target = p.position();
    target.x() = side == Side::left ? area.minX - distance : area.maxX + distance;
    moveSafely(p, target, true);
  });
}

void Pitch::clearOpponentHalf(Side side, double circle, double distance, RandomStream& random) const {
  forEachShuffled(side, random, [&](const Player& p) {
    const Bounds b = p.bounds();
    if (!opponentHalf(side).intersects(b)) return;
    // The corner of the bounds that is farthest from the centre decides.
    const double maxX = std::max(std::abs(b.low.x()), std::abs(b.high.x())),
                 maxY = std::max(std::abs(b.low.y()), std::abs(b.high.y()));
    if (std::hypot(maxX, maxY) < circle) return;
    Vec3 target = p.position();
    target.x() = -direction(side) * distance;
    moveSafely(p, target, true);
  });
}

void Pitch::clearForKickOff(Side side, RandomStream& random) const {
  const SoccerSettings& s = *settings_;
  clearOpponentHalf(opponent(side), 0, s.freeKickMoveDist, random);
  clearSphere(opponent(side), centre(), s.freeKickDistance, s.freeKickMoveDist, random);
  clearOpponentHalf(side, s.freeKickDistance, s.freeKickMoveDist, random);
}

void Pitch::repel(Side side, const Vec3& centre, double within, double distance, RandomStream& random) const {
  forEachShuffled(side, random, [&](const Player& p) {
    Vec3 offset = p.position() - centre;
    offset.z() = 0;
    const double current = offset.norm();
    if (current >= within) return;
    // A player at the centre itself is moved towards its own end.
    const Vec3 outward = current > 1e-6 ? Vec3(offset / current) : Vec3(-direction(side), 0, 0);
    const Vec3 target = centre + outward * distance;
    moveSafely(p, Vec3(target.x(), target.y(), p.position().z()), false);
  });
}

void Pitch::moveSafely(const Player& player, const Vec3& target, bool avoidBall) const {
  relocate(player, safeReposition_.find(*this, player, target, avoidBall));
}

void Pitch::relocate(const Player& player, const Vec3& target) const {
  player.moveTo(target);
  player.state->setMovedAt(now());
}

void Pitch::moveOffField(const Player& player, double z) const {
  // A column of 0.6 m spacing, number 7 at the centre line, as in the installed base.
  const double x = -direction(player.side()) * 0.6 * (7 - player.state->unum());
  const double y = (settings_->fieldWidth / 2 + 0.5) * (ballPosition().y() < 0 ? 1 : -1);
  moveSafely(player, Vec3(x, y, z), true);
}

}  // namespace spark::soccer
