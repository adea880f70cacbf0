#include "ball_state_aspect.h"

namespace spark {

using soccer::Side;

void BallStateAspect::describe(Description<BallStateAspect>& d) {
  using B = BallStateAspect;
  d.doc("The state of the ball in this cycle: touches, out, goals.");
  d.property("lastTeam", &B::lastTeam).doc("Side that touched the ball last: left, right or none.");
  d.property("lastUnum", &B::lastUnum).doc("Number of the player that touched the ball last; 0: none yet.");
  d.property("onField", &B::onField).doc("The ball is on the field.");
  d.property("lastValid", &B::lastValid).unit("m").doc("The ball's last position on the field.");
}

void BallStateAspect::rule(const Event&) {
  GameStateAspect* game = game_.get();
  if (!game) return;
  soccer::Pitch& pitch = game->pitch();
  if (!pitch.ready() || !pitch.ball()) return;
  const SoccerSettings& s = pitch.settings();
  position_ = pitch.ballPosition();
  // Teams keep their touches when they swap sides at half time.
  if (std::exchange(swapsSeen_, game->sideSwaps()) != game->sideSwaps()) last_.side = soccer::opponent(last_.side);
  findTouch(pitch);

  // The limits of the installed base: the ball's radius and 1 mm beyond the lines.
  const double slack = s.ballRadius + 0.001;
  onField_ = std::abs(position_.x()) < s.fieldLength / 2 + slack && std::abs(position_.y()) < s.fieldWidth / 2 + slack;
  if (onField_) lastValid_ = position_;
  findGoal(pitch);

  // The recorders collect the contacts of the next physics phase.
  if (auto* r = pitch.ballRecorder()) r->clear();
  for (Side side : {Side::left, Side::right})
    if (auto* r = pitch.goalRecorder(side)) r->clear();
}

void BallStateAspect::rest(const Event&) {
  kicker_ = 0;
  touched_ = false;
  touchedBy_.fill(false);
  inGoal_ = Side::none;
  GameStateAspect* game = game_.get();
  if (game && game->pitch().ready())
    if (auto* r = game->pitch().ballRecorder()) r->clear();
}

void BallStateAspect::addContact(const soccer::Player* player, const soccer::Player*& first) {
  if (!player || player->side() == Side::none) return;
  if (!first) first = player;
  touchedBy_[player->side() == Side::right] = true;
}

void BallStateAspect::findTouch(const soccer::Pitch& pitch) {
  // Of several players that touch the ball in a cycle the first counts; a kick precedes contacts.
  const soccer::Player* toucher = nullptr;
  touchedBy_.fill(false);
  if (kicker_ != 0) addContact(pitch.playerOfAgent(std::exchange(kicker_, 0)), toucher);
  if (auto* recorder = pitch.ballRecorder())
    for (const Ref<Leaf>& collider : recorder->colliders()) addContact(pitch.playerOf(collider.get()), toucher);
  touched_ = toucher != nullptr;
  if (!touched_) return;
  newTouch_ = toucher->agent->number() != last_.agent || pitch.now() - last_.time >= kContactGap;
  last_ = {toucher->agent->number(), toucher->side(), toucher->state->unum(), pitch.now()};
}

void BallStateAspect::findGoal(const soccer::Pitch& pitch) {
  // The ball's collider touches the trigger box of a goal.
  inGoal_ = Side::none;
  const Ball* ball = pitch.ball()->leaf().ancestor<Ball>();
  for (Side side : {Side::left, Side::right})
    if (auto* recorder = pitch.goalRecorder(side))
      for (const Ref<Leaf>& collider : recorder->colliders())
        if (ball && collider && collider->ancestor<Ball>() == ball) inGoal_ = side;
  if (inGoal_ != Side::none) return;

  // A fast ball can pass through the box within one step. As in the installed base: it is behind the goal line, was in
  // front of it one second ago by its velocity, and crossed the line between the posts.
  const SoccerSettings& s = pitch.settings();
  const double line = s.fieldLength / 2 + s.ballRadius, x = position_.x();
  const Vec3 v = pitch.ball()->state().linearVelocity;
  if (std::abs(x) <= line || std::abs(x - v.x()) > line || x * v.x() <= 0) return;
  const double sinceCrossing = (std::abs(x) - line) / std::abs(v.x());
  if (std::abs(position_.y() - v.y() * sinceCrossing) < s.goalWidth / 2 &&
      position_.z() - v.z() * sinceCrossing < s.goalHeight)
    inGoal_ = x < 0 ? Side::left : Side::right;
}

void BallStateAspect::saveState(StateWriter& out) const {
  out.write(kicker_);
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
  kicker_ = static_cast<int>(in.readInteger());
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
