#include "ball_state_aspect.h"

namespace spark {

using soccer::Side;

void BallStateAspect::describe(Description<BallStateAspect>& d) {
  using B = BallStateAspect;
  d.doc("What happened to the ball in this cycle: touches, out, goals.");
  d.property("lastTeam", &B::lastTeam).doc("Side that touched the ball last: left, right or none.");
  d.property("lastUnum", &B::lastUnum).doc("Number of the player who touched the ball last, 0: nobody.");
  d.property("onField", &B::onField).doc("The ball is on the field.");
  d.property("lastValid", &B::lastValid).unit("m").doc("Where the ball was last on the field.");
}

void BallStateAspect::rule(const Event&) {
  GameStateAspect* game = beside(game_, version_);
  if (!game) return;
  soccer::Pitch& pitch = game->pitch();
  if (!pitch.ready() || !pitch.ball()) return;
  const SoccerSettings& s = pitch.settings();
  position_ = pitch.ballPosition();
  findTouch(*game);
  const double slack = s.ballRadius + 0.001;
  onField_ = std::abs(position_.x()) < s.fieldLength / 2 + slack && std::abs(position_.y()) < s.fieldWidth / 2 + slack;
  if (onField_) lastValid_ = position_;
  findGoal(pitch);
  if (auto* r = pitch.ballRecorder()) r->clear();
  for (Side side : {Side::left, Side::right})
    if (auto* r = pitch.goalRecorder(side)) r->clear();
}

void BallStateAspect::findTouch(GameStateAspect& game) {
  const soccer::Pitch& pitch = game.pitch();
  const soccer::Player* toucher = kicker_ ? pitch.playerOfAgent(kicker_) : nullptr;
  kicker_ = 0;
  if (auto* recorder = pitch.ballRecorder())
    for (const Ref<Leaf>& collider : recorder->colliders()) {
      if (toucher) break;
      toucher = pitch.playerOf(collider.get());
    }
  touched_ = toucher && toucher->side() != Side::none;
  if (!touched_) return;
  fresh_ = toucher->agent->number() != last_.agent || game.time() - last_.time >= kContactGap;
  last_ = {toucher->agent->number(), toucher->side(), toucher->state->unum(), game.time()};
}

void BallStateAspect::findGoal(const soccer::Pitch& pitch) {
  const SoccerSettings& s = pitch.settings();
  inGoal_ = Side::none;
  const Ball* ball = pitch.ball()->leaf().ancestor<Ball>();
  for (Side side : {Side::left, Side::right})
    if (auto* recorder = pitch.goalRecorder(side))
      for (const Ref<Leaf>& collider : recorder->colliders())
        if (ball && collider && collider->ancestor<Ball>() == ball) inGoal_ = side;
  if (inGoal_ != Side::none) return;
  // a ball too fast for the goal box: was it inside one second ago, and did it pass between the posts?
  const double line = s.fieldLength / 2 + s.ballRadius, x = position_.x();
  const Vec3 v = pitch.ball()->state().linearVelocity;
  if (std::abs(x) <= line || std::abs(x - v.x()) > line || x * v.x() <= 0) return;
  const double ago = (std::abs(x) - line) / std::abs(v.x());
  if (std::abs(position_.y() - v.y() * ago) < s.goalWidth / 2 && position_.z() - v.z() * ago < s.goalHeight)
    inGoal_ = x < 0 ? Side::left : Side::right;
}

void BallStateAspect::saveState(StateWriter& out) const {
  out.write(kicker_);
  out.write(last_.agent);
  out.write(static_cast<int>(last_.side));
  out.write(last_.unum);
  out.write(last_.time);
  for (bool b : {touched_, fresh_, onField_}) out.write(b);
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
  for (bool* b : {&touched_, &fresh_, &onField_}) *b = in.readBool();
  inGoal_ = static_cast<Side>(in.readInteger());
  for (Vec3* v : {&position_, &lastValid_})
    for (int i = 0; i < 3; ++i) (*v)[i] = in.readNumber();
}

}  // namespace spark
