#include "self_collision_aspect.h"

#include <fstream>

#include "spark/output_file.h"

namespace spark {

namespace {

/// Name of the part of the robot that a box belongs to: that of the transform above.
const std::string& partName(IRobotBox& box) {
  const auto* part = box.leaf().ancestor<Transform>();
  return part ? part->name() : box.leaf().name();
}

}  // namespace

void SelfCollisionAspect::judgePlay(const Event& event) {
  lookUp();
  const double step = game().advance() > 0 ? game().advance() : event.step;
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    advance(robots_[i], step);
    if (isJudged(i)) judgeRobot(i);
  }
}

void SelfCollisionAspect::reset() {
  lookUp();
  release();
}

void SelfCollisionAspect::release() {
  for (Robot& robot : robots_) {
    for (Joint& j : robot.joints) {
      thaw(j);
      j.sinceFrozen = {};
    }
    robot.sinceSentOff = {};
  }
}

void SelfCollisionAspect::thaw(Joint& joint) {
  if (!joint.frozen || !joint.node) return;
  joint.effector->freeze(false);
  joint.frozen = false;
}

void SelfCollisionAspect::lookUp() {
  if (!tree_.changed(*this)) return;
  // Look up the robots that are new or have changed; take over all others.
  std::vector<Robot> now;
  for (const soccer::Player& p : players()) {
    const auto old =
        std::find_if(robots_.begin(), robots_.end(), [&](const Robot& r) { return r.agent == p.agent->number(); });
    if (old != robots_.end() && old->changedAt == p.changedAt) {
      now.push_back(std::move(*old));
      continue;
    }
    now.push_back(makeRobot(p));
    if (old != robots_.end()) copyTimes(*old, now.back());
  }
  robots_ = std::move(now);
}

SelfCollisionAspect::Robot SelfCollisionAspect::makeRobot(const soccer::Player& player) {
  Robot robot;
  robot.agent = player.agent->number();
  robot.changedAt = player.changedAt;
  std::vector<IFreezable*> effectors;
  player.agent->collect(effectors);
  for (IFreezable* e : effectors) robot.joints.push_back({e, Ref<Leaf>(&e->leaf())});
  std::vector<IRobotBox*> boxes;
  player.agent->collect(boxes);
  for (IRobotBox* box : boxes) {
    Box& b = robot.boxes.emplace_back(Box{box, {}, (box->boxLengths() / 2).cast<float>(), {}});
    // The joints that it names.
    for (std::size_t k = 0; k < effectors.size(); ++k)
      if (const auto& names = box->freezeJointEffectors();
          std::find(names.begin(), names.end(), effectors[k]->leaf().name()) != names.end())
        b.joints.push_back(static_cast<int>(k));
  }
  // All pairs, unless the later box excludes the earlier one.
  for (std::size_t a = 0; a < boxes.size(); ++a)
    for (std::size_t b = a + 1; b < boxes.size(); ++b) {
      if (boxes[b]->ignores(boxes[a]->leaf().name())) continue;
      const float reach = robot.boxes[a].half.norm() + robot.boxes[b].half.norm();
      robot.pairs.push_back({static_cast<int>(a), static_cast<int>(b), kRounding * reach * reach});
    }
  return robot;
}

void SelfCollisionAspect::copyTimes(const Robot& from, Robot& to) {
  to.sinceSentOff = from.sinceSentOff;
  for (std::size_t k = 0; k < std::min(from.joints.size(), to.joints.size()); ++k) {
    to.joints[k].frozen = from.joints[k].frozen;
    to.joints[k].sinceFrozen = from.joints[k].sinceFrozen;
  }
}

void SelfCollisionAspect::advance(Robot& robot, double step) {
  robot.sinceSentOff.advance(step);
  for (Joint& j : robot.joints) {
    j.sinceFrozen.advance(step);
    if (j.frozen && !j.sinceFrozen.isWithin(settings().selfCollisionJointFrozenTime)) thaw(j);
  }
}

void SelfCollisionAspect::judgeRobot(std::size_t player) {
  const SoccerSettings& s = settings();
  Robot& robot = robots_[player];
  for (Box& b : robot.boxes) b.current = soccer::SingleBox(b.box->pose(), b.half);
  bool foul = false;  // report one foul, however many pairs overlap
  for (const Pair& pair : robot.pairs) {
    if (!overlap(robot, pair)) continue;
    const Box &a = robot.boxes[pair.a], &b = robot.boxes[pair.b];
    if (s.selfCollisionBeamPenalty) {
      if (robot.sinceSentOff.isWithin(s.selfCollisionBeamCooldownTime)) return;
      robot.sinceSentOff.start();
      record(players()[player], a, b);
      if (s.foulOnSelfCollisions) sendOff(player, Foul::selfCollision);
      return;
    }
    const bool frozeA = freeze(robot, a), frozeB = freeze(robot, b);
    if (!frozeA && !frozeB) continue;
    record(players()[player], a, b);
    foul = true;
  }
  if (foul && s.foulOnSelfCollisions) penalties().report(players()[player], Foul::selfCollision);
}

bool SelfCollisionAspect::overlap(const Robot& robot, const Pair& pair) const {
  const soccer::SingleBox &a = robot.boxes[pair.a].current, &b = robot.boxes[pair.b].current;
  if ((a.centre - b.centre).squaredNorm() > pair.reachSquared) return false;
  return soccer::overlapBeyond(static_cast<float>(settings().selfCollisionsTolerance), a, b);
}

bool SelfCollisionAspect::freeze(Robot& robot, const Box& box) {
  const SoccerSettings& s = settings();
  const double immunity = s.selfCollisionJointFrozenTime + s.selfCollisionJointThawTime;
  bool any = false;
  for (int k : box.joints) {
    Joint& joint = robot.joints[k];
    if (joint.sinceFrozen.isWithin(immunity)) continue;
    joint.sinceFrozen.start();
    joint.frozen = s.foulOnSelfCollisions;
    if (joint.frozen) joint.effector->freeze(true);
    any = true;
  }
  return any;
}

void SelfCollisionAspect::record(const soccer::Player& player, const Box& a, const Box& b) {
  const SoccerSettings& s = settings();
  if (!s.printSelfCollisions && !s.writeSelfCollisionsToFile) return;
  const std::string line = fmt::format("{} {}: {} and {}", soccer::sideName(player.side()), player.state->unum(),
                                       partName(*a.box), partName(*b.box));
  if (s.printSelfCollisions) kernel().log().info("soccer: self-collision, {}", line);
  if (s.writeSelfCollisionsToFile && outputs::permitted(s.selfCollisionRecordFilename) && !outputs::isTrial())
    std::ofstream(s.selfCollisionRecordFilename, std::ios::app) << fmt::format("{:.2f} {}\n", game().time(), line);
}

void SelfCollisionAspect::saveState(StateWriter& out) const {
  out.write(static_cast<std::int64_t>(robots_.size()));
  for (const Robot& r : robots_) {
    out.write(r.agent);
    out.write(r.sinceSentOff.elapsed);
    out.write(static_cast<std::int64_t>(r.joints.size()));
    for (const Joint& j : r.joints) out.write(j.frozen), out.write(j.sinceFrozen.elapsed);
  }
}

void SelfCollisionAspect::loadState(StateReader& in) {
  robots_.clear();
  for (std::int64_t n = in.readInteger(); n > 0; --n) {
    Robot& r = robots_.emplace_back();
    r.agent = static_cast<int>(in.readInteger());
    r.sinceSentOff.elapsed = in.readNumber();
    for (std::int64_t k = in.readInteger(); k > 0; --k) {
      Joint& j = r.joints.emplace_back(Joint{nullptr, {}});
      j.frozen = in.readBool();
      j.sinceFrozen.elapsed = in.readNumber();
    }
  }
  tree_.lookAgain();
}

}  // namespace spark
