#pragma once

#include <cstddef>
#include <map>
#include <memory>

#include "recorded_scene.h"

namespace spark::log_player {

/// Moments of a recorded game from which a player can go on, so that a step back does not begin at a full record far
/// away. Some are spread over all that was ever seen, others lie close together on the last way, each at most so many:
/// a step back through a million records takes some dozens of them.
class Moments {
 public:
  static constexpr std::size_t kFirstSpacing = 32, kMostSpread = 256, kMostClose = 64;

  void clear();
  /// A way of `length` records begins.
  void beginWay(std::size_t length);
  /// Record `i` was taken, so many behind its full one.
  void passed(std::size_t i, std::size_t behindFull, const RecordedScene& scene);
  /// The last one in [first, last], and its record; nullptr when there is none.
  const RecordedScene::Moment* before(std::size_t first, std::size_t last, std::size_t& record) const;

 private:
  using Map = std::map<std::size_t, std::shared_ptr<const RecordedScene::Moment>>;
  Map spread_, close_;
  std::size_t spacing_ = kFirstSpacing, closeSpacing_ = 0;
};

}  // namespace spark::log_player
