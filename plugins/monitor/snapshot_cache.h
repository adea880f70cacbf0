#pragma once
/// \file
/// Snapshots of a recorded scene, for seeking in a log.

#include <cstddef>
#include <map>
#include <memory>

#include "recorded_scene.h"

namespace spark::log_player {

/// Keeps snapshots from which playing can continue, since a seek backwards would otherwise replay everything from the
/// last full record. There are two sets, both of limited size: one covers all records that were ever played, the other
/// the records of the last seek more densely. A step back in a log of a million records replays some dozens of them.
class SnapshotCache {
 public:
  static constexpr std::size_t kInitialSpacing = 32;  ///< records between two snapshots
  static constexpr std::size_t kMaxSparse = 256;      ///< number of snapshots over all records
  static constexpr std::size_t kMaxDense = 64;        ///< number of snapshots of the last seek

  /// Removes all snapshots.
  void clear();
  /// A seek over `length` records begins.
  void beginSeek(std::size_t length);
  /// Record `i` was applied to `scene`; keeps a snapshot if one is due. `sinceFull`: number of records since the last
  /// full one; 0 for a full record itself, which needs no snapshot.
  void onRecord(std::size_t i, std::size_t sinceFull, const RecordedScene& scene);
  /// The last snapshot of the records [first, last], or nullptr; sets `record` to its record. Valid until the next
  /// change of the cache.
  const RecordedScene::Snapshot* findLast(std::size_t first, std::size_t last, std::size_t& record) const;

 private:
  using Map = std::map<std::size_t, std::shared_ptr<const RecordedScene::Snapshot>>;  ///< by record
  Map sparse_, dense_;
  std::size_t spacing_ = kInitialSpacing;  ///< of the sparse set; doubles when the set is full
  std::size_t denseSpacing_ = 0;           ///< of the dense set; 0: none are kept
};

}  // namespace spark::log_player
