#pragma once

#include <algorithm>
#include <vector>

#include "pitch.h"

namespace spark::soccer {

/// A record for each player of the pitch, by the player's index there. A player keeps its record until its agent
/// leaves; new players get T(). T has save(StateWriter&) const and load(StateReader&).
template <class T>
class PlayerRecords {
 public:
  /// Matches the records to the players. Call it in each cycle before the records are used. Costs one comparison unless
  /// the shape of the tree changed.
  void follow(const Pitch& pitch, const Leaf& anyNode) {
    if (!tree_.changed(anyNode)) return;
    std::vector<int> numbers;
    std::vector<T> records;
    for (const Player& p : pitch.players()) {
      numbers.push_back(p.agent->number());
      const auto known = std::lower_bound(numbers_.begin(), numbers_.end(), numbers.back());
      const bool isKnown = known != numbers_.end() && *known == numbers.back();
      records.push_back(isKnown ? std::move(records_[known - numbers_.begin()]) : T());
    }
    numbers_ = std::move(numbers);
    records_ = std::move(records);
  }
  /// Sets all records to T().
  void reset() {
    for (T& r : records_) r = T();
  }
  std::size_t size() const { return records_.size(); }
  T& operator[](std::size_t player) { return records_[player]; }
  const T& operator[](std::size_t player) const { return records_[player]; }
  auto begin() { return records_.begin(); }
  auto end() { return records_.end(); }

  void save(StateWriter& out) const {
    out.write(static_cast<std::int64_t>(numbers_.size()));
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      out.write(numbers_[i]);
      records_[i].save(out);
    }
  }
  void load(StateReader& in) {
    const auto count = static_cast<std::size_t>(in.readInteger());
    numbers_.assign(count, 0);
    records_.assign(count, T());
    for (std::size_t i = 0; i < count; ++i) {
      numbers_[i] = static_cast<int>(in.readInteger());
      records_[i].load(in);
    }
    tree_.lookAgain();
  }

 private:
  TreeWatch tree_;
  std::vector<int> numbers_;  ///< of the agents, ascending, like players
  std::vector<T> records_;
};

}  // namespace spark::soccer
