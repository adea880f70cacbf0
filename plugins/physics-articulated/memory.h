#pragma once
/// \file
/// What bounded rows were found in, for the next step's search to begin with. It makes the search short and has no say
/// in what is found.

#include "rows.h"

namespace spark::articulated {

/// Motors and stops of a joint.
struct JointMemory {
  std::array<State, 3> state{State::holds, State::holds, State::holds};
  std::array<std::int8_t, 3> stop{0, 0, 0};
};

/// Rows of contacts, which come in the same order in every step, with some added and some gone.
class ContactMemory {
 public:
  using States = std::array<State, kContactRows>;
  /// Finds which contacts were there in the step before.
  void match(std::span<const engine::Contact> contacts);
  /// nullptr: it is new.
  const States* before(int contact) const;
  States& now(int contact) { return now_[static_cast<std::size_t>(contact)].states; }

 private:
  struct Entry {
    engine::Geom a = engine::Geom::none, b = engine::Geom::none;
    States states{};
    int match = -1;
  };
  std::vector<Entry> now_, before_;
};

}  // namespace spark::articulated
