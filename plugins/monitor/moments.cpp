#include "moments.h"

namespace spark::log_player {

void Moments::clear() {
  spread_.clear();
  close_.clear();
  spacing_ = kFirstSpacing;
  closeSpacing_ = 0;
}

void Moments::beginWay(std::size_t length) {
  closeSpacing_ = length > kMostClose ? (length + kMostClose - 1) / kMostClose : 0;
  if (closeSpacing_ > 0) close_.clear();  // a short way keeps those of the long one before
}

void Moments::passed(std::size_t i, std::size_t behindFull, const RecordedScene& scene) {
  if (behindFull == 0) return;
  if (closeSpacing_ > 0 && i % closeSpacing_ == 0 && close_.size() <= kMostClose) close_.emplace(i, scene.moment());
  if (behindFull < spacing_ || i % spacing_ != 0 || spread_.count(i) != 0) return;
  spread_.emplace(i, scene.moment());
  if (spread_.size() <= kMostSpread) return;
  spacing_ *= 2;
  std::erase_if(spread_, [this](const auto& m) { return m.first % spacing_ != 0; });
}

const RecordedScene::Moment* Moments::before(std::size_t first, std::size_t last, std::size_t& record) const {
  const RecordedScene::Moment* found = nullptr;
  for (const Map* map : {&spread_, &close_}) {
    auto at = map->upper_bound(last);
    if (at == map->begin()) continue;
    --at;
    if (at->first < first || (found && at->first <= record)) continue;
    record = at->first;
    found = at->second.get();
  }
  return found;
}

}  // namespace spark::log_player
