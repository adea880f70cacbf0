#include "memory.h"

namespace spark::articulated {

void ContactMemory::match(std::span<const engine::Contact> contacts) {
  // How many contacts may have gone between two that stayed.
  constexpr std::size_t kGap = 12;
  std::swap(now_, before_);
  now_.resize(contacts.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    now_[i] = {contacts[i].geomA, contacts[i].geomB, {}, -1};
    for (std::size_t k = next; k < std::min(next + kGap, before_.size()); ++k) {
      if (before_[k].a != now_[i].a || before_[k].b != now_[i].b) continue;
      now_[i].match = static_cast<int>(k);
      next = k + 1;
      break;
    }
  }
}

const ContactMemory::States* ContactMemory::before(int contact) const {
  const int match = now_[static_cast<std::size_t>(contact)].match;
  return match < 0 ? nullptr : &before_[static_cast<std::size_t>(match)].states;
}

}  // namespace spark::articulated
