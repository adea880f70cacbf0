#include "warm_start.h"

namespace spark::articulated {

void ContactWarmStart::match(std::span<const engine::Contact> contacts) {
  // How many contacts may have disappeared between two that remain. It bounds the time of the search for new ones.
  constexpr std::size_t kMaxGap = 12;
  std::swap(current_, last_);
  current_.resize(contacts.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    current_[i] = {contacts[i].geomA, contacts[i].geomB, {}, kNone};
    for (std::size_t k = next; k < std::min(next + kMaxGap, last_.size()); ++k) {
      if (last_[k].a != current_[i].a || last_[k].b != current_[i].b) continue;
      current_[i].match = toIndex(k);
      next = k + 1;
      break;
    }
  }
}

const ContactWarmStart::States* ContactWarmStart::last(Index i) const {
  const Index match = current_[i].match;
  return match == kNone ? nullptr : &last_[match].states;
}

}  // namespace spark::articulated
