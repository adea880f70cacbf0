#include "gamecontrol/transit_queue.h"

#include <algorithm>

#include "gamecontrol/action_queue.h"

namespace spark::gamecontrol {

Predicates& TransitQueue::add(std::int64_t due) {
  if (size_ > 0) due = std::max(due, lastDue());
  if (size_ == ring_.size()) {
    std::rotate(ring_.begin(), ring_.begin() + static_cast<std::ptrdiff_t>(first_), ring_.end());
    first_ = 0;
    ring_.emplace_back();
  }
  Entry& entry = ring_[indexOf(size_++)];
  entry.due = due;
  entry.message.clear();
  return entry.message;
}

void TransitQueue::pop() {
  first_ = indexOf(1);
  --size_;
}

std::size_t TransitQueue::tokens() const {
  std::size_t n = 0;
  for (std::size_t i = 0; i < size_; ++i) n += ring_[indexOf(i)].message.size();
  return n;
}

void TransitQueue::save(StateWriter& out, std::size_t count) const {
  for (std::size_t i = 0; i < count; ++i) {
    const Entry& entry = ring_[indexOf(i)];
    out.write(entry.due);
    savePredicates(entry.message, out);
  }
}

void TransitQueue::load(StateReader& in, std::size_t count) {
  for (; count > 0; --count) {
    const std::int64_t due = in.readInteger();
    loadPredicates(in, add(due));
  }
}

}  // namespace spark::gamecontrol
