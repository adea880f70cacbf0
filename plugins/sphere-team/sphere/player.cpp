#include "player.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace spark {

// The decision of a player, for every message:
//
//     no team yet           -> (init ...)
//     before a kick-off     -> (beam ...) to its position in the formation
//     number 1              -> stays between ball and goal; catches and clears near balls
//     nearest to the ball   -> goes behind the ball, as seen from the target, and kicks
//     otherwise             -> its position in the formation, which moves with the ball; never offside
//
// Positions come from vision alone: the four corner flags give the size of the field and the own position. Angles are
// relative to the axes of the team's frame.

namespace {

constexpr double kReach = 0.35;        ///< distance between the centres of player and ball at which a kick works [m]
constexpr double kTopSpeed = 9.5;      ///< m/s
constexpr double kPowerPerSpeed = 10;  ///< drive power for a steady speed of 1 m/s
constexpr double kSpeedPerKick = 1.7;  ///< speed of the ball per kick power [m/s]
constexpr double kInertia = 0.17;      ///< time constant of the speed [s]
constexpr double kLatency = 0.04;      ///< from sensing to acting [s]
constexpr double kShotSpeed = 38;      ///< m/s
constexpr double kKeeperSpeed = 3.5;   ///< along the goal line [m/s]
constexpr double kShotRange = 28;      ///< on a field of 104 m [m]
constexpr double kTakerRest = 3;       ///< time for which the taker of a restart leaves the ball to others [s]

/// Positions at kick-offs as fractions of half the field, by number.
struct Place {
  double x, y;
};
constexpr std::array<Place, 12> kFormation{{{0, 0},
                                            {-0.98, 0},
                                            {-0.72, 0.5},
                                            {-0.78, 0.17},
                                            {-0.78, -0.17},
                                            {-0.72, -0.5},
                                            {-0.42, 0.42},
                                            {-0.46, 0},
                                            {-0.42, -0.42},
                                            {-0.12, 0.32},
                                            {-0.24, 0.02},
                                            {-0.12, -0.32}}};

}  // namespace

double SpherePlayer::Point::length() const { return std::hypot(x, y); }
SpherePlayer::Point SpherePlayer::Point::unit() const {
  const double l = length();
  return l > 1e-9 ? Point{x / l, y / l} : Point{1, 0};
}

SpherePlayer::SpherePlayer(std::string team, int unum) : team_(std::move(team)), unum_(std::clamp(unum, 1, 11)) {
  others_.reserve(32);
}

void SpherePlayer::start(Predicates& actions) { actions.open("scene").add(scene_).close(); }

void SpherePlayer::think(const Predicates& percepts, Predicates& actions) {
  read(percepts);
  if (side_.empty()) return join(actions);
  if (playMode_ == "BeforeKickOff" || playMode_.starts_with("Goal_")) return takePlaces(actions);
  placed_ = false;
  if (!seesField_ || !seesBall_) return;
  if (playMode_ == "GameOver") return runTo(self_, 0, actions);
  play(actions);
}

// ---- percepts ----

void SpherePlayer::read(const Predicates& percepts) {
  const double before = now_;
  for (const Element e : percepts) {
    if (e.head() == "time") {
      if (const Element now = e.named("now")) now_ = now.at(1).number();
      velocity_ = driven_ + (velocity_ - driven_) * std::exp(-std::clamp(now_ - before, 0.0, 1.0) / kInertia);
    } else if (e.head() == "GS") {
      readGameState(e);
    } else if (e.head() == "See") {
      readVision(e);
    }
  }
}

void SpherePlayer::readGameState(const Element& gs) {
  for (const Element e : gs) {
    if (!e.isList()) continue;
    const std::string_view key = e.head();
    if (key == "team")
      side_ = e.at(1).text();
    else if (key == "unum")
      unum_ = static_cast<int>(e.at(1).integer());
    else if (key == "sl")
      left_ = static_cast<int>(e.at(1).integer());
    else if (key == "sr")
      right_ = static_cast<int>(e.at(1).integer());
    else if (key == "pm" && e.at(1).text() != playMode_) {
      const std::string before = std::exchange(playMode_, std::string(e.at(1).text()));
      modeSince_ = now_;
      noteRestart(before);
    }
  }
}

/// The player nearest to the ball when an own restart becomes PlayOn has taken it, and must not touch the ball again
/// before another player.
void SpherePlayer::noteRestart(const std::string& before) {
  if (playMode_ != "PlayOn") return;
  const std::string now = std::exchange(playMode_, before);
  const bool wasOurs = ours("");
  playMode_ = now;
  if (!wasOurs || !seesBall_) return;
  taker_ = unum_;
  double nearest = toBall_.length();
  for (const Other& o : others_)
    if (const double d = (o.place - ball_).length(); o.mate && d < nearest) nearest = d, taker_ = o.unum;
  takerUntil_ = now_ + kTakerRest;
}

void SpherePlayer::readVision(const Element& see) {
  readField(see);
  if (!seesField_) return;
  others_.clear();
  for (const Element e : see) {
    const Element pol = e.isList() ? e.named("pol") : Element();
    if (!pol) continue;
    const double d = pol.at(1).number(), h = pol.at(2).number() * (std::numbers::pi / 180),
                 v = pol.at(3).number() * (std::numbers::pi / 180);
    const Point way{d * std::cos(v) * std::cos(h), d * std::cos(v) * std::sin(h)};
    if (e.head() == "B") {
      // From the relative position, which is accurate for near balls, and the own velocity.
      const double dt = now_ - ballTime_;
      if (seesBall_ && dt > 0) ballVelocity_ = ballVelocity_ * 0.4 + (velocity_ + (way - toBall_) * (1 / dt)) * 0.6;
      if (ballVelocity_.length() > 45) ballVelocity_ = {};
      ball_ = self_ + way, toBall_ = way, ballTime_ = now_, seesBall_ = true;
    } else if (e.head() == "P") {
      const Element team = e.named("team"), id = e.named("id");
      if (team && id)
        others_.push_back({team.at(1).text() == team_, static_cast<int>(id.at(1).integer()), self_ + way});
    }
  }
}

/// The mean of the corner flags is the centre of the field, their spread its size. The left ones are on the side that
/// the left team defends, which is ahead for the right team: servers may not announce that teams have changed sides.
void SpherePlayer::readField(const Element& see) {
  std::array<Point, 4> corner, post;
  int corners = 0, posts = 0;
  double left = 0;
  for (const Element e : see) {
    const Element pol = e.isList() ? e.named("pol") : Element();
    const std::string_view name = e.head();
    if (!pol || name.size() != 3 || (name[0] != 'F' && name[0] != 'G')) continue;
    const double d = pol.at(1).number(), h = pol.at(2).number() * (std::numbers::pi / 180),
                 v = pol.at(3).number() * (std::numbers::pi / 180);
    const Point way{d * std::cos(v) * std::cos(h), d * std::cos(v) * std::sin(h)};
    if (name[0] == 'F' && corners < 4) left += name[2] == 'L' ? way.x : -way.x, corner[corners++] = way;
    if (name[0] == 'G' && posts < 4) post[posts++] = way;
  }
  if (corners < 4) return;
  if (!side_.empty()) side_ = left < 0 ? "left" : "right";
  Point mean;
  for (const Point& c : corner) mean = mean + c * 0.25;
  double length = 0, width = 0, goal = 0;
  for (const Point& c : corner) length += std::abs(c.x - mean.x) / 4, width += std::abs(c.y - mean.y) / 4;
  for (int i = 0; i < posts; ++i) goal += std::abs(post[i].y - mean.y) / posts;
  // Flags are far away: smooth the position by the own velocity, unless it has jumped.
  const Point seen = Point{} - mean, expected = self_ + velocity_ * (now_ - fieldTime_);
  self_ = seesField_ && (seen - expected).length() < 1 ? expected + (seen - expected) * 0.3 : seen;
  fieldTime_ = now_;
  halfLength_ = length, halfWidth_ = width;
  if (posts == 4) goalHalfWidth_ = goal;
  seesField_ = true;
}

/// True for a restart of the given kind ("": any) of the own team.
bool SpherePlayer::ours(std::string_view kind) const {
  std::string_view mode = playMode_;
  const bool left = mode.ends_with("_left") || mode.ends_with("_Left"),
             right = mode.ends_with("_right") || mode.ends_with("_Right");
  if ((!left && !right) || (left ? "left" : "right") != side_) return false;
  return !mode.starts_with("offside") && (kind.empty() || mode.starts_with(kind));
}

/// True for a restart of the opponents.
bool SpherePlayer::theirs() const { return playMode_ != "PlayOn" && !ours(""); }

/// x beyond which a team-mate ahead of the ball would be offside.
double SpherePlayer::offsideLine() const {
  double last = -1e9, second = -1e9;
  for (const Other& o : others_) {
    if (o.mate) continue;
    if (o.place.x > last)
      second = std::exchange(last, o.place.x);
    else
      second = std::max(second, o.place.x);
  }
  return std::max({0.0, ball_.x, second});
}

// ---- actions ----

void SpherePlayer::join(Predicates& actions) {
  if (joinedAt_ >= 0 && now_ < joinedAt_ + 1) return;
  joinedAt_ = now_;
  actions.open("init").pair("unum", unum_).pair("teamname", std::string_view(team_)).close();
}

void SpherePlayer::takePlaces(Predicates& actions) {
  runTo(self_, 0, actions);
  if (!seesField_ || std::exchange(placed_, true)) return;
  const Place p = kFormation[static_cast<std::size_t>(unum_)];
  actions.open("beam").add(p.x * halfLength_).add(p.y * halfWidth_).add(0.0).close();
}

SpherePlayer::Point SpherePlayer::formation() const {
  const Place home = kFormation[static_cast<std::size_t>(unum_)];
  Point p{home.x * halfLength_, home.y * halfWidth_};
  // The team moves with the ball, forwards more than defenders.
  const double follow = unum_ >= 9 ? 0.95 : unum_ >= 6 ? 0.6 : 0.45;
  p.x += follow * ball_.x + (unum_ >= 9 ? 8 : 0) * halfLength_ / 52;
  p.y = 0.7 * p.y + 0.3 * ball_.y;
  p.x = std::min(p.x, offsideLine() - 1);
  p.x = std::clamp(p.x, -0.9 * halfLength_, 0.9 * halfLength_);
  if (theirs()) {
    const Point away = p - ball_;
    const double clear = 11.0 * halfLength_ / 52;
    if (away.length() < clear) p = ball_ + away.unit() * clear;
    if (playMode_.starts_with("KickOff")) p.x = std::min(p.x, -0.5);
  }
  return p;
}

/// True for the player of the team nearest to the future position of the ball. The goalie counts only at goal kicks,
/// and the taker of a restart is excluded for a while.
bool SpherePlayer::goesToBall() const {
  const Point soon = ballSoon(0.3);
  const auto cost = [&](int unum, Point place) {
    if (unum == taker_ && now_ < takerUntil_) return 1e6 + unum;
    if (unum == 1 && !ours("goal_kick")) return 1e5;
    if (unum == 1) return -1.0;
    // A player ahead of the ball has to run around it.
    return (place - soon).length() + (place.x > soon.x ? 1.0 : 0.0);
  };
  const double mine = cost(unum_, self_);
  for (const Other& o : others_)
    if (o.mate && (cost(o.unum, o.place) < mine - (o.unum < unum_ ? 0 : 1e-9))) return false;
  return true;
}

void SpherePlayer::play(Predicates& actions) {
  if (unum_ == 1 && !ours("goal_kick")) return keepGoal(actions);
  const bool inPlay = std::abs(ball_.x) < halfLength_ + 0.3 && std::abs(ball_.y) < halfWidth_ + 0.3;
  if (!theirs() && inPlay && goesToBall()) return attack(actions);
  runTo(unum_ == 1 ? Point{1 - halfLength_, 0} : formation(), kTopSpeed, actions);
}

void SpherePlayer::keepGoal(Predicates& actions) {
  const Point goal{-halfLength_, 0};
  const bool inArea =
      ball_.x < -halfLength_ + 16 * halfLength_ / 52 && std::abs(ball_.y) < goalHalfWidth_ + 16 * halfWidth_ / 34;
  if (inArea && playMode_ == "PlayOn") {
    if (toBall_.length() < 0.9 && now_ > caughtAt_ + 2) {
      caughtAt_ = now_;
      actions.open("catch").close();
      return;
    }
    if (now_ < caughtAt_ + 2 || (toBall_.length() < 5 && ballVelocity_.length() < 6))
      return kickTowards({0, self_.y > 0 ? halfWidth_ : -halfWidth_}, 28, 25, actions);
  }
  // On the line from the goal to the ball, or where a shot will cross.
  Point post = goal + (ball_ - goal).unit() * 1.5;
  if (ballVelocity_.x < -4) {
    const double t = (post.x - ball_.x) / ballVelocity_.x;
    if (t > 0 && t < 3) post.y = ball_.y + ballVelocity_.y * t;
  }
  post.y = std::clamp(post.y, -goalHalfWidth_, goalHalfWidth_);
  runTo(post, kKeeperSpeed, actions);
}

/// How free of opponents the path of a ball is, 0..1.
double SpherePlayer::wayIsFree(Point from, Point to) const {
  const Point way = to - from;
  const double length = way.length();
  double free = 1;
  for (const Other& o : others_) {
    if (o.mate) continue;
    const double along = std::clamp((o.place - from).dot(way.unit()), 0.0, length);
    const double beside = (from + way.unit() * along - o.place).length();
    // The farther the ball has to roll, the more time the opponent has.
    free = std::min(free, beside / (1 + 0.25 * along));
  }
  return std::clamp(free, 0.0, 1.0);
}

/// Chooses between shooting, passing and dribbling. An option is worth less the farther it has to turn around the ball.
void SpherePlayer::attack(Predicates& actions) {
  const double scale = halfLength_ / 52, keeper = keeperY();
  Kick best{{halfLength_, 0.5 * ball_.y}, 10, 0, 0};
  double bestWorth = -1e9;
  const auto offer = [&](Kick kick, double worth) {
    const Point wanted = kickWay(kick.target, kick.speed);
    worth -= std::acos(std::clamp(wanted.dot(toBall_.unit()), -1.0, 1.0));
    if (worth > bestWorth) bestWorth = worth, best = kick;
  };
  offer(best, 1.5 * wayIsFree(ball_, ball_ + (best.target - ball_).unit() * 12));
  const Point corner{halfLength_ + 1, (keeper > 0 ? -0.8 : 0.8) * goalHalfWidth_};
  // The larger the angle of the goal, the better the shot.
  const double ahead = std::max(0.1, halfLength_ - ball_.x);
  const double looks = std::atan2(goalHalfWidth_ - ball_.y, ahead) - std::atan2(-goalHalfWidth_ - ball_.y, ahead);
  if (ahead < kShotRange * scale) offer({corner, kShotSpeed, 0, 0}, 16 * looks - 0.5);
  // The direction of an immediate kick, without a turn.
  const Point now = (toBall_ + (ballVelocity_ - velocity_) * (now_ - ballTime_ + kLatency)).unit();
  const Point flies = now * kShotSpeed + ballVelocity_;
  const double hits = flies.x > 4 ? ball_.y + flies.y / flies.x * ahead : 1e9;
  if (ahead < kShotRange * scale && std::abs(hits) < 0.9 * goalHalfWidth_)
    offer({ball_ + flies * ahead, kShotSpeed, 0, 0}, 16 * looks);
  const Point goal{halfLength_ - ball_.x, -0.7 * ball_.y};
  const double off = std::acos(std::clamp(now.dot(goal.unit()), -1.0, 1.0));
  if (off < 0.6) offer({ball_ + now * 10, 9, 0, 0}, 1.5 * wayIsFree(ball_, ball_ + now * 10) - 1.5 * off);
  if (ball_.x < -0.5 * halfLength_)
    offer({{0.1 * halfLength_, ball_.y > 0 ? halfWidth_ : -halfWidth_}, 20, 20, 0}, 1.2);
  for (const Other& o : others_) {
    if (!o.mate || o.unum == 1) continue;
    const Point lead = o.place + Point{2.5, 0};
    const double distance = (lead - ball_).length();
    if (distance < 6 || distance > 35 * scale || o.place.x > offsideLine() ||
        lead.x < std::min(ball_.x - 4, 0.5 * halfLength_))
      continue;
    offer({lead, 6 + 0.4 * distance, 0, o.unum},
          std::min((lead.x - ball_.x) / (6 * scale), 3.0) + 2 * wayIsFree(ball_, lead) - 1.5);
  }
  if (ours("goal_kick")) best = {{0, ball_.y > 0 ? halfWidth_ * 0.6 : -halfWidth_ * 0.6}, 28, 20, 0};
  kickTowards(best.target, best.speed, best.elevationDeg, actions);
}

/// Direction of the impulse that sends the moving ball to the target.
SpherePlayer::Point SpherePlayer::kickWay(Point target, double speed) const {
  return ((target - ball_).unit() * speed - ballVelocity_).unit();
}

/// y of the opponents' goalie; 0 if it is not seen [m].
double SpherePlayer::keeperY() const {
  for (const Other& o : others_)
    if (!o.mate && o.unum == 1) return o.place.y;
  return 0;
}

/// Runs behind the ball, as seen from the target, and kicks when it is in line.
void SpherePlayer::kickTowards(Point target, double speed, double elevationDeg, Predicates& actions) {
  const Point wanted = kickWay(target, speed), side{-wanted.y, wanted.x};
  const Point rel = toBall_ + (ballVelocity_ - velocity_) * (now_ - ballTime_ + kLatency);
  const double distance = rel.length(), along = rel.dot(wanted), across = rel.dot(side),
               aim = std::atan2(std::abs(across), along);
  // With an opponent at the ball any kick forwards is better than none; at a restart there is time to be accurate.
  const bool play = playMode_ == "PlayOn";
  const bool pressed = play && std::any_of(others_.begin(), others_.end(), [this](const Other& o) {
                         return !o.mate && (o.place - ball_).length() < 1.5;
                       });
  const double tolerance = pressed ? (rel.unit().x > 0.2 ? 1.2 : 0.6)
                           : play  ? 0.15
                                   : 0.12 + 0.05 * std::max(0.0, now_ - modeSince_ - 3);
  const bool backwards = play && ball_.x < 0.3 * halfLength_ && rel.unit().x < -0.3;
  if (distance < kReach + 0.25 && aim < tolerance && !backwards)
    actions.open("kick")
        .add(elevationDeg)
        .add(std::clamp(std::min(speed, aim < 0.15 ? speed : 12) / kSpeedPerKick, 1.0, 100.0))
        .close();
  // The point to meet the ball; from the wrong side go around it without touching it.
  Point spot = self_ + rel + ballVelocity_ * std::min(0.1 + distance / kTopSpeed, 1.5);
  double pace = 1.5 + 5 * std::max(0.0, distance - kReach) + std::max(0.0, ballVelocity_.dot(rel.unit()));
  if (aim >= tolerance) {
    if (along < 0.2 && std::abs(across) < 1)
      spot = spot - wanted * 0.8 - side * ((across > 0 ? 1 : -1) * 0.8);
    else
      spot = spot - wanted * std::min(1.0, 0.5 + 0.3 * std::abs(across));
  } else if (!play) {
    pace = std::min(pace, 2.5);
  }
  runTo(spot, std::min(kTopSpeed, pace), actions);
}

void SpherePlayer::runTo(Point target, double speed, Predicates& actions) {
  target.x = std::clamp(target.x, -halfLength_ - 0.3, halfLength_ + 0.3);
  target.y = std::clamp(target.y, -halfWidth_ - 1, halfWidth_ + 1);
  // From behind a goal go around it.
  if (std::abs(self_.x) > halfLength_ + 0.5 && std::abs(self_.y) < goalHalfWidth_ + 0.8)
    target = {self_.x, (self_.y < 0 ? -1 : 1) * (goalHalfWidth_ + 1.5)};
  const Point way = target - self_;
  const double v = std::min(speed, 5 * way.length());
  driven_ = way.unit() * v;
  const Point power = driven_ * kPowerPerSpeed;
  actions.open("drive").add(power.x).add(power.y).add(0.0).close();
}

}  // namespace spark
