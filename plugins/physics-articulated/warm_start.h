#pragma once
/// \file
/// Row states of the last step, with which the search for the states of this step begins. They shorten the search and
/// do not change its result (see pivoting.h).

#include "rows.h"

namespace spark::articulated {

/// States of the motors and stops of a joint, by axis. A state counts only while the axis is at the same stop.
struct JointWarmStart {
  std::array<RowState, 3> state{RowState::holds, RowState::holds, RowState::holds};
  std::array<RowState, 3> frictionless = state;  ///< see Row::frictionless
  std::array<Stop, 3> stop{Stop::none, Stop::none, Stop::none};
};

/// States of the rows of all contacts of a world.
class ContactWarmStart {
 public:
  struct States {
    std::array<RowState, kMaxContactRows> rows{};
    RowState frictionless = RowState::holds;  ///< of the normal row, see Row::frictionless
  };
  /// Begins a step: the states written so far become the last step's. Contacts are matched with the last step's by
  /// their geoms; contacts of both steps are in the same order, with some added and some removed.
  void match(std::span<const engine::Contact> contacts);
  /// The last step's states of contact `i` of this step; nullptr if it is new.
  const States* last(Index i) const;
  /// This step's states of contact `i`, to be written.
  States& current(Index i) { return current_[i].states; }

 private:
  struct Entry {
    engine::Index a = engine::kNone, b = engine::kNone;
    States states{};
    Index match = kNone;  ///< in last_
  };
  std::vector<Entry> current_, last_;
};

}  // namespace spark::articulated
