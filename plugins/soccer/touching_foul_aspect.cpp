#include "touching_foul_aspect.h"

namespace spark {

void TouchingFoulAspect::judgePlay(const Event& event) {
  follow(members_);
  if (!contacts()) return;
  const int count = static_cast<int>(players().size());
  for (int first = 0; first < count; ++first) {
    if (contacts()->group(first) != first) continue;
    group_.clear();
    for (int i = first; i < count; ++i)
      if (contacts()->group(i) == first) group_.push_back(i);
    note(first, event.cycle);
    if (static_cast<int>(group_.size()) > settings().maxTouchGroupSize) judgeGroup();
  }
}

/// Who joined now: all but the greatest part that was a group before.
void TouchingFoulAspect::note(int first, std::int64_t cycle) {
  if (group_.size() == 1) {
    members_[first] = {};
    return;
  }
  std::int64_t core = 0;
  std::ptrdiff_t size = 0;
  for (int i : group_) {
    const std::int64_t name = members_[i].group;
    const auto same = std::count_if(group_.begin(), group_.end(), [&](int k) { return members_[k].group == name; });
    if (name != 0 && same > size) core = name, size = same;
  }
  for (int i : group_)
    if (core == 0 || members_[i].group != core) members_[i].joined = cycle;
  // numbers of agents outlive indices
  for (int i : group_) members_[i].group = players()[first].agent->number();
}

void TouchingFoulAspect::judgeGroup() {
  std::int64_t latest = -1;
  for (int i : group_)
    if (isJudged(i)) latest = std::max(latest, members_[i].joined);
  const int last = draw([&](int i) { return members_[i].joined == latest; });
  if (last < 0) return;
  const Side side = players()[last].side();
  const auto mates = std::count_if(group_.begin(), group_.end(), [&](int i) { return players()[i].side() == side; });
  const bool ownFault = 2 * mates >= static_cast<std::ptrdiff_t>(group_.size());
  if (ownFault && !isGoalie(last)) return punish(last);
  const Side guilty = ownFault ? side : opponent(side);
  int player = draw([&](int i) { return players()[i].side() == guilty && !isGoalie(i); });
  if (player < 0) player = draw([&](int i) { return players()[i].side() == guilty; });
  if (player >= 0) punish(player);
}

/// One of the group, -1: nobody is like that.
template <class F>
int TouchingFoulAspect::draw(F wanted) {
  candidates_.clear();
  for (int i : group_)
    if (isJudged(i) && wanted(i)) candidates_.push_back(i);
  if (candidates_.empty()) return -1;
  return candidates_.size() == 1 ? candidates_.front() : candidates_[random_.below(candidates_.size())];
}

void TouchingFoulAspect::punish(int player) {
  if (settings().touchingFoulBeamPenalty) return sendOff(player, Foul::touching);
  Vec3 mean = Vec3::Zero();
  for (int i : group_) mean += players()[i].position();
  mean /= static_cast<double>(group_.size());
  const Vec3 here = players()[player].position();
  Vec3 away = here - mean;
  away.z() = 0;
  const double far = away.norm();
  const Vec3 outward = far > 1e-6 ? Vec3(away / far) : Vec3(-direction(players()[player].side()), 0, 0);
  penalties().moveAside(pitch(), player, Foul::touching, here + outward * settings().agentRadius);
}

}  // namespace spark
