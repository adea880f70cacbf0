#pragma once
/// \file
/// Handles of the elements of a model, which stay valid while their indices change.

#include <vector>

#include "api/model.h"

namespace spark::physics {

// Handles of elements. Valid from the create call to the destroy call, while indices in the model change.
enum class BodyHandle : engine::Index { none = engine::kNone };
enum class SpaceHandle : engine::Index { none = engine::kNone };
enum class GeomHandle : engine::Index { none = engine::kNone };
enum class JointHandle : engine::Index { none = engine::kNone };

/// The elements of one kind: which handle belongs to which index. Removed elements stay in the arrays until compact().
template <class Handle>
class Handles {
 public:
  /// The handle of a new last element.
  Handle add() {
    const auto index = static_cast<engine::Index>(handleOf_.size());
    if (free_.empty()) {
      free_.push_back(static_cast<Handle>(indexOf_.size()));
      indexOf_.push_back(engine::kNone);
    }
    const Handle handle = free_.back();
    free_.pop_back();
    indexOf_[static_cast<engine::Index>(handle)] = index;
    handleOf_.push_back(handle);
    return handle;
  }
  /// Frees the handle; its element has none from now on.
  void remove(Handle handle) {
    handleOf_[(*this)[handle]] = Handle::none;
    indexOf_[static_cast<engine::Index>(handle)] = engine::kNone;
    free_.push_back(handle);
    ++removed_;
  }
  /// The index of an element; kNone for Handle::none.
  engine::Index operator[](Handle handle) const {
    return handle == Handle::none ? engine::kNone : indexOf_[static_cast<engine::Index>(handle)];
  }
  Handle handleOf(engine::Index index) const { return handleOf_[index]; }
  bool alive(engine::Index index) const { return handleOf_[index] != Handle::none; }
  /// Number of removed elements that are still in the arrays.
  std::size_t removed() const { return removed_; }
  std::size_t size() const { return handleOf_.size(); }
  /// Removes the elements without a handle from each array. Returns the new index of each old one, kNone for removed
  /// ones; see renumber().
  template <class... Arrays>
  std::vector<engine::Index> compact(Arrays&... arrays) {
    std::vector<engine::Index> now(handleOf_.size(), engine::kNone);
    engine::Index next = 0;
    for (engine::Index i = 0; i < handleOf_.size(); ++i) {
      if (!alive(i)) continue;
      if (i != next) ((arrays[next] = std::move(arrays[i])), ...), handleOf_[next] = handleOf_[i];
      indexOf_[static_cast<engine::Index>(handleOf_[next])] = next;
      now[i] = next++;
    }
    (arrays.resize(next), ...);
    handleOf_.resize(next);
    removed_ = 0;
    return now;
  }

 private:
  std::vector<engine::Index> indexOf_;  ///< by handle
  std::vector<Handle> handleOf_;        ///< by index
  std::vector<Handle> free_;
  std::size_t removed_ = 0;
};

}  // namespace spark::physics
