#include "self_collision_aspect.h"

#include <fstream>

namespace spark {

namespace {

/// How a part is called: after the transform that carries it.
const std::string& partName(IRobotBox& box) {
  const auto* part = box.leaf().ancestor<Transform>();
  return part ? part->name() : box.leaf().name();
}

/// A trainer may have set the clock of play back: then it is long ago.
bool isWithin(double seconds, double since, double now) { return now >= since && now - since < seconds; }

}  // namespace

void SelfCollisionAspect::judgePlay(const Event&) {
  lookUp();
  const double now = game().time();
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    thaw(robots_[i], now);
    if (isJudged(i)) judgeRobot(i, now);
  }
}

void SelfCollisionAspect::reset() {
  lookUp();
  for (Robot& robot : robots_) {
    for (Joint& j : robot.joints) {
      if (j.frozen) j.effector->freeze(false);
      j.frozen = false;
      j.since = kLongAgo;
    }
    robot.sentOff = kLongAgo;
  }
}

void SelfCollisionAspect::lookUp() {
  if (!tree_.changed(*this)) return;
  std::vector<Robot> now;
  for (const soccer::Player& p : players()) {
    const auto before =
        std::find_if(robots_.begin(), robots_.end(), [&](const Robot& r) { return r.agent == p.agent->number(); });
    if (before != robots_.end() && before->changedAt == p.changedAt) {
      now.push_back(std::move(*before));
      continue;
    }
    now.push_back(dissect(p));
    if (before != robots_.end()) keepClocks(*before, now.back());
  }
  robots_ = std::move(now);
}

SelfCollisionAspect::Robot SelfCollisionAspect::dissect(const soccer::Player& player) const {
  Robot robot;
  robot.agent = player.agent->number();
  robot.changedAt = player.changedAt;
  std::vector<IFreezable*> effectors;
  player.agent->collect(effectors);
  for (IFreezable* e : effectors) robot.joints.push_back({e});
  std::vector<IRobotBox*> boxes;
  player.agent->collect(boxes);
  for (IRobotBox* box : boxes) {
    Box& b = robot.boxes.emplace_back(Box{box, {}, (box->boxLengths() / 2).cast<float>(), {}});
    for (std::size_t k = 0; k < effectors.size(); ++k)
      if (const auto& names = box->freezeJointEffectors();
          std::find(names.begin(), names.end(), effectors[k]->leaf().name()) != names.end())
        b.limb.push_back(static_cast<int>(k));
  }
  for (std::size_t a = 0; a < boxes.size(); ++a)
    for (std::size_t b = a + 1; b < boxes.size(); ++b) {
      if (boxes[b]->ignores(boxes[a]->leaf().name())) continue;
      const float reach = robot.boxes[a].half.norm() + robot.boxes[b].half.norm();
      robot.pairs.push_back({static_cast<int>(a), static_cast<int>(b), kRounding * reach * reach});
    }
  return robot;
}

/// What is added to a robot comes after its older joints.
void SelfCollisionAspect::keepClocks(const Robot& from, Robot& to) {
  to.sentOff = from.sentOff;
  for (std::size_t k = 0; k < std::min(from.joints.size(), to.joints.size()); ++k) {
    to.joints[k].frozen = from.joints[k].frozen;
    to.joints[k].since = from.joints[k].since;
  }
}

void SelfCollisionAspect::thaw(Robot& robot, double now) {
  for (Joint& j : robot.joints) {
    if (!j.frozen || isWithin(settings().selfCollisionJointFrozenTime, j.since, now)) continue;
    j.effector->freeze(false);
    j.frozen = false;
  }
}

void SelfCollisionAspect::judgeRobot(std::size_t player, double now) {
  const SoccerSettings& s = settings();
  Robot& robot = robots_[player];
  for (Box& b : robot.boxes) b.now = soccer::SingleBox(b.box->pose(), b.half);
  bool foul = false;
  for (const Pair& pair : robot.pairs) {
    if (!overlap(robot, pair)) continue;
    const Box &a = robot.boxes[pair.a], &b = robot.boxes[pair.b];
    if (s.selfCollisionBeamPenalty) {
      if (isWithin(s.selfCollisionBeamCooldownTime, robot.sentOff, now)) return;
      robot.sentOff = now;
      tell(players()[player], a, b, now);
      if (s.foulOnSelfCollisions) sendOff(player, Foul::selfCollision);
      return;
    }
    const bool frozeA = freeze(robot, a, now), frozeB = freeze(robot, b, now);
    if (!frozeA && !frozeB) continue;
    tell(players()[player], a, b, now);
    foul = true;
  }
  if (foul && s.foulOnSelfCollisions) penalties().report(players()[player], Foul::selfCollision);
}

bool SelfCollisionAspect::overlap(const Robot& robot, const Pair& pair) const {
  const soccer::SingleBox &a = robot.boxes[pair.a].now, &b = robot.boxes[pair.b].now;
  if ((a.centre - b.centre).squaredNorm() > pair.reachSquared) return false;
  return soccer::overlapBeyond(static_cast<float>(settings().selfCollisionsTolerance), a, b);
}

/// True when a joint of the limb was neither frozen nor spared. Without FoulOnSelfCollisions only its clock starts.
bool SelfCollisionAspect::freeze(Robot& robot, const Box& box, double now) {
  const SoccerSettings& s = settings();
  const double spared = s.selfCollisionJointFrozenTime + s.selfCollisionJointThawTime;
  bool any = false;
  for (int k : box.limb) {
    Joint& joint = robot.joints[k];
    if (isWithin(spared, joint.since, now)) continue;
    joint.since = now;
    joint.frozen = s.foulOnSelfCollisions;
    if (joint.frozen) joint.effector->freeze(true);
    any = true;
  }
  return any;
}

void SelfCollisionAspect::tell(const soccer::Player& player, const Box& a, const Box& b, double now) {
  const SoccerSettings& s = settings();
  if (!s.printSelfCollisions && !s.writeSelfCollisionsToFile) return;
  const std::string line = fmt::format("{} {}: {} and {}", soccer::sideName(player.side()), player.state->unum(),
                                       partName(*a.box), partName(*b.box));
  if (s.printSelfCollisions) kernel().log().info("soccer: self-collision, {}", line);
  if (s.writeSelfCollisionsToFile)
    std::ofstream(s.selfCollisionRecordFilename, std::ios::app) << fmt::format("{:.2f} {}\n", now, line);
}

void SelfCollisionAspect::saveState(StateWriter& out) const {
  out.write(static_cast<std::int64_t>(robots_.size()));
  for (const Robot& r : robots_) {
    out.write(r.agent);
    out.write(r.sentOff);
    out.write(static_cast<std::int64_t>(r.joints.size()));
    for (const Joint& j : r.joints) out.write(j.frozen), out.write(j.since);
  }
}

void SelfCollisionAspect::loadState(StateReader& in) {
  robots_.clear();
  for (std::int64_t n = in.readInteger(); n > 0; --n) {
    Robot& r = robots_.emplace_back();
    r.agent = static_cast<int>(in.readInteger());
    r.sentOff = in.readNumber();
    for (std::int64_t k = in.readInteger(); k > 0; --k) {
      Joint& j = r.joints.emplace_back(Joint{nullptr});
      j.frozen = in.readBool();
      j.since = in.readNumber();
    }
  }
  tree_.lookAgain();
}

}  // namespace spark
