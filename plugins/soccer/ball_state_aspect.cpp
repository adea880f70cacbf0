#include "ball_state_aspect.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spark {

using soccer::Side;

namespace {
constexpr double kEqual = 1e-4;  ///< differences of distances that do not count [m]

/// True if the ball's collider touches the trigger box of the goal that `side` defends.
bool isInGoalBox(const soccer::Pitch& pitch, Side side) {
  const Ball* ball = pitch.ball()->leaf().ancestor<Ball>();
  const ICollisionRecorder* recorder = pitch.goalRecorder(side);
  return ball && recorder &&
         std::any_of(recorder->colliders().begin(), recorder->colliders().end(),
                     [ball](const Ref<Leaf>& collider) { return collider && collider->ancestor<Ball>() == ball; });
}
}  // namespace

void BallStateAspect::describe(Description<BallStateAspect>& d) {
  using B = BallStateAspect;
  d.doc("The state of the ball in this cycle: touches, out, goals.");
  d.property("lastTeam", &B::lastTeam).doc("Side that touched the ball last: left, right or none.");
  d.property("lastUnum", &B::lastUnum).doc("Number of the player that touched the ball last; 0: none yet.");
  d.property("onField", &B::onField).doc("The ball is on the field.");
  d.property("lastValid", &B::lastValid).unit("m").doc("The ball's last position on the field.");
}

void BallStateAspect::rule(const Event& event) {
  endActions();
  GameStateAspect* game = game_.get();
  if (!game) return;
  soccer::Pitch& pitch = game->pitch();
  if (!pitch.ready() || !pitch.ball()) return;
  followBall(pitch, event.step);
  // Teams keep their touches when they swap sides at half time.
  if (std::exchange(swapsSeen_, game->sideSwaps()) != game->sideSwaps()) last_.side = soccer::opponent(last_.side);
  findTouch(pitch, event.step);
  findGoal(pitch);

  // The recorders collect the contacts of the next physics phase.
  if (auto* r = pitch.ballRecorder()) r->clear();
  for (Side side : {Side::left, Side::right})
    if (auto* r = pitch.goalRecorder(side)) r->clear();
}

void BallStateAspect::rest(const Event&) {
  endActions();
  kickers_.clear();
  touched_ = false;
  touchedBy_.fill(false);
  inGoal_ = Side::none;
  GameStateAspect* game = game_.get();
  if (game && game->pitch().ready())
    if (auto* r = game->pitch().ballRecorder()) r->clear();
}

void BallStateAspect::followBall(const soccer::Pitch& pitch, double step) {
  // The limits of the installed base: the ball's radius and 1 mm beyond the lines.
  const SoccerSettings& s = pitch.settings();
  const double slack = s.ballRadius + 0.001;
  maxX_ = s.fieldLength / 2 + slack, maxY_ = s.fieldWidth / 2 + slack;

  // Where the path of this cycle begins: where the ball was, or, if something placed it since, where it comes from by
  // its velocity. One that was placed off the field may have crossed a line one second ago, as in the installed base.
  constexpr double kTopSpeed = 50;  // no ball moves faster by itself than its velocity says and this [m/s]
  const Vec3 before = std::exchange(position_, pitch.ballPosition()), v = pitch.ball()->state().linearVelocity;
  const bool jumped = (position_ - before).norm() > (kTopSpeed + v.norm()) * step;
  Vec3 start = jumped ? Vec3(position_ - v * step) : before;
  if (jumped && !isOnField(start)) start = position_ - v;
  onField_ = isOnField(position_);
  placed_ = jumped && !isOnField(start);
  from_ = isOnField(start) ? start : lastValid_;
  if (onField_) lastValid_ = position_;
}

namespace {
/// Where on the way from `from` to `to` a coordinate grows beyond `limit`, as a fraction of the way; infinite: it does
/// not. Both coordinates are towards the line.
double crossing(double from, double to, double limit) {
  if (to < limit) return HUGE_VAL;
  return from < limit ? (limit - from) / (to - from) : 0;
}
}  // namespace

BallStateAspect::Line BallStateAspect::crossedLine() const {
  const double x = std::copysign(1, position_.x()), y = std::copysign(1, position_.y());
  return crossing(x * from_.x(), x * position_.x(), maxX_) <= crossing(y * from_.y(), y * position_.y(), maxY_)
             ? Line::goal
             : Line::touch;
}

bool BallStateAspect::mayAct(soccer::IBallAction::Kind kind) {
  if (!std::exchange(isDecided_, true)) acting_ = decideActions();
  return !acting_ || *acting_ == kind;
}

std::optional<soccer::IBallAction::Kind> BallStateAspect::decideActions() {
  using Kind = soccer::IBallAction::Kind;
  GameStateAspect* game = game_.get();
  if (!game || !game->pitch().ball()) return {};
  const Vec3 ball = game->pitch().ballPosition();
  // The distances of those that would act, the nearest so far, and how many are as near.
  bool kicks = false, catches = false;
  double nearest = HUGE_VAL;
  const auto distanceOf = [&](const Announced& a) {
    const soccer::Player* player = a.effector ? a.action->reaches() : nullptr;
    return player ? (player->position() - ball).norm() : HUGE_VAL;
  };
  for (const Announced& a : actions_) {
    const double distance = distanceOf(a);
    if (distance == HUGE_VAL) continue;
    (a.action->kind() == Kind::kick ? kicks : catches) = true;
    nearest = std::min(nearest, distance);
  }
  if (!kicks || !catches) return {};
  const auto isNearest = [&](const Announced& a) { return distanceOf(a) <= nearest + kEqual; };
  const auto equals = static_cast<std::uint64_t>(std::count_if(actions_.begin(), actions_.end(), isNearest));
  std::uint64_t chosen = equals > 1 ? game->random().below(equals) : 0;
  for (const Announced& a : actions_)
    if (isNearest(a) && chosen-- == 0) return a.action->kind();
  return {};
}

void BallStateAspect::addRival(const soccer::Player* player) {
  if (!player || player->side() == Side::none || rivals_.size() == rivals_.capacity() ||
      std::find(rivals_.begin(), rivals_.end(), player) != rivals_.end())
    return;
  rivals_.push_back(player);
  touchedBy_[player->side() == Side::right] = true;
}

void BallStateAspect::findTouch(soccer::Pitch& pitch, double step) {
  // A kick precedes contacts.
  touchedBy_.fill(false);
  rivals_.clear();
  for (const int agent : kickers_) addRival(pitch.playerOfAgent(agent));
  kickers_.clear();
  const std::size_t kicks = rivals_.size();
  if (auto* recorder = pitch.ballRecorder())
    for (const Ref<Leaf>& collider : recorder->colliders()) addRival(pitch.playerOf(collider.get()));
  if (kicks > 0) rivals_.resize(kicks);

  const soccer::Player* toucher = decideTouch(pitch, step);
  touched_ = toucher != nullptr;
  if (!touched_) return;
  newTouch_ = toucher->agent->number() != last_.agent || pitch.now() - last_.time >= kContactGap;
  last_ = {toucher->agent->number(), toucher->side(), toucher->state->unum(), pitch.now()};
}

const soccer::Player* BallStateAspect::decideTouch(soccer::Pitch& pitch, double step) {
  if (rivals_.size() <= 1) return rivals_.empty() ? nullptr : rivals_.front();
  // The distances before the step, which has pushed the ball away from the nearest.
  const auto before = [step](const IRigidBody& b) {
    return Vec3(b.state().position - b.state().linearVelocity * step);
  };
  const Vec3 ball = before(*pitch.ball());
  const auto distance = [&](const soccer::Player* p) {
    double nearest = HUGE_VAL;
    for (const IRigidBody* b : p->bodies) nearest = std::min(nearest, (before(*b) - ball).norm());
    return nearest;
  };
  double nearest = HUGE_VAL;
  for (const soccer::Player* p : rivals_) nearest = std::min(nearest, distance(p));
  std::erase_if(rivals_, [&](const soccer::Player* p) { return distance(p) > nearest + kEqual; });
  if (rivals_.size() == 1) return rivals_.front();

  // Equally near: the touch of a player that has not let go since its last one continues, otherwise a draw decides.
  for (const soccer::Player* p : rivals_)
    if (p->agent->number() == last_.agent && pitch.now() - last_.time < kContactGap) return p;
  return rivals_[game_->random().below(rivals_.size())];
}

void BallStateAspect::findGoal(const soccer::Pitch& pitch) {
  // The whole ball is behind the goal line.
  inGoal_ = Side::none;
  const SoccerSettings& s = pitch.settings();
  const double line = s.fieldLength / 2 + s.ballRadius, x = std::abs(position_.x());
  if (x <= line) return;
  const Side side = position_.x() < 0 ? Side::left : Side::right;

  // It was placed in the goal, or crossed the line between the posts and below the bar.
  const auto isInGoal = [&] {
    if (placed_) return isInGoalBox(pitch, side);
    const double way = crossing(std::copysign(1, position_.x()) * from_.x(), x, line);
    const Vec3 at = from_ + (position_ - from_) * way;
    return std::abs(at.y()) < s.goalWidth / 2 && at.z() < s.goalHeight;
  };
  if (isInGoal()) inGoal_ = side;
}

void BallStateAspect::saveState(StateWriter& out) const {
  out.write(static_cast<int>(kickers_.size()));  // 0 between cycles
  out.write(last_.agent);
  out.write(static_cast<int>(last_.side));
  out.write(last_.unum);
  out.write(last_.time);
  for (bool b : {touched_, newTouch_, onField_, touchedBy_[0], touchedBy_[1]}) out.write(b);
  out.write(swapsSeen_);
  out.write(static_cast<int>(inGoal_));
  for (const Vec3* v : {&position_, &lastValid_})
    for (int i = 0; i < 3; ++i) out.write((*v)[i]);
}

void BallStateAspect::loadState(StateReader& in) {
  in.readInteger();
  kickers_.clear();
  endActions();
  last_.agent = static_cast<int>(in.readInteger());
  last_.side = static_cast<Side>(in.readInteger());
  last_.unum = static_cast<int>(in.readInteger());
  last_.time = in.readNumber();
  for (bool* b : {&touched_, &newTouch_, &onField_, &touchedBy_[0], &touchedBy_[1]}) *b = in.readBool();
  swapsSeen_ = in.readInteger();
  inGoal_ = static_cast<Side>(in.readInteger());
  for (Vec3* v : {&position_, &lastValid_})
    for (int i = 0; i < 3; ++i) (*v)[i] = in.readNumber();
}

}  // namespace spark
