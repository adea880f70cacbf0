#include "touching_foul_aspect.h"

namespace spark {

void TouchingFoulAspect::judgePlay(const Event& event) {
  follow(members_);
  if (!contacts()) return;
  const int count = static_cast<int>(players().size());
  // A group is identified by its first player.
  for (int first = 0; first < count; ++first) {
    if (contacts()->group(first) != first) continue;
    group_.clear();
    for (int i = first; i < count; ++i)
      if (contacts()->group(i) == first) group_.push_back(i);
    updateMembers(first, event.cycle);
    if (static_cast<int>(group_.size()) > settings().maxTouchGroupSize) judgeGroup();
  }
}

void TouchingFoulAspect::updateMembers(int first, std::int64_t cycle) {
  if (group_.size() == 1) {
    members_[first] = {};
    return;
  }
  // The largest subset that was one group in the last cycle is the core; all others have joined now.
  std::int64_t core = 0;
  std::ptrdiff_t size = 0;
  for (int i : group_) {
    const std::int64_t id = members_[i].group;
    const auto same = std::count_if(group_.begin(), group_.end(), [&](int k) { return members_[k].group == id; });
    if (id != 0 && same > size) core = id, size = same;
  }
  for (int i : group_)
    if (core == 0 || members_[i].group != core) members_[i].joined = cycle;
  // The number of an agent stays the same when indices change.
  for (int i : group_) members_[i].group = players()[first].agent->number();
}

void TouchingFoulAspect::judgeGroup() {
  std::int64_t latest = -1;
  for (int i : group_)
    if (isJudged(i)) latest = std::max(latest, members_[i].joined);
  const int last = choose([&](int i) { return members_[i].joined == latest; });
  if (last < 0) return;
  const Side side = players()[last].side();
  const auto mates = std::count_if(group_.begin(), group_.end(), [&](int i) { return players()[i].side() == side; });
  // Check whether the offender's team has at least half of the group.
  const bool ownFault = 2 * mates >= static_cast<std::ptrdiff_t>(group_.size());
  if (ownFault && !isGoalie(last)) return penalise(last);
  const Side offenders = ownFault ? side : opponent(side);
  int player = choose([&](int i) { return players()[i].side() == offenders && !isGoalie(i); });
  if (player < 0) player = choose([&](int i) { return players()[i].side() == offenders; });
  if (player >= 0) penalise(player);
}

template <class F>
int TouchingFoulAspect::choose(F accepts) {
  candidates_.clear();
  for (int i : group_)
    if (isJudged(i) && accepts(i)) candidates_.push_back(i);
  if (candidates_.empty()) return -1;
  return candidates_.size() == 1 ? candidates_.front() : candidates_[random_.below(candidates_.size())];
}

void TouchingFoulAspect::penalise(int player) {
  if (settings().touchingFoulBeamPenalty) return sendOff(player, Foul::touching);
  // Move it away from the middle of the group.
  Vec3 mean = Vec3::Zero();
  for (int i : group_) mean += players()[i].position();
  mean /= static_cast<double>(group_.size());
  const Vec3 position = players()[player].position();
  Vec3 offset = position - mean;
  offset.z() = 0;
  const double distance = offset.norm();
  const Vec3 outward = distance > 1e-6 ? Vec3(offset / distance) : Vec3(-direction(players()[player].side()), 0, 0);
  penalties().moveAside(pitch(), player, Foul::touching, position + outward * settings().agentRadius);
}

}  // namespace spark
