#include "snapshot_cache.h"

namespace spark::log_player {

void SnapshotCache::clear() {
  sparse_.clear();
  dense_.clear();
  spacing_ = kInitialSpacing;
  denseSpacing_ = 0;
}

void SnapshotCache::beginSeek(std::size_t length) {
  denseSpacing_ = length > kMaxDense ? (length + kMaxDense - 1) / kMaxDense : 0;
  if (denseSpacing_ > 0) dense_.clear();  // after a short seek those of the last long one stay useful
}

void SnapshotCache::onRecord(std::size_t i, std::size_t sinceFull, const RecordedScene& scene) {
  if (sinceFull == 0) return;
  if (denseSpacing_ > 0 && i % denseSpacing_ == 0 && dense_.size() <= kMaxDense) dense_.emplace(i, scene.snapshot());
  if (sinceFull < spacing_ || i % spacing_ != 0 || sparse_.count(i) != 0) return;
  sparse_.emplace(i, scene.snapshot());
  if (sparse_.size() <= kMaxSparse) return;
  // The set is full: double the spacing, which removes every other snapshot.
  spacing_ *= 2;
  std::erase_if(sparse_, [this](const auto& s) { return s.first % spacing_ != 0; });
}

const RecordedScene::Snapshot* SnapshotCache::findLast(std::size_t first, std::size_t last, std::size_t& record) const {
  const RecordedScene::Snapshot* found = nullptr;
  for (const Map* map : {&sparse_, &dense_}) {
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
