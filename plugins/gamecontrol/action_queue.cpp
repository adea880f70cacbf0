#include "gamecontrol/action_queue.h"

namespace spark::gamecontrol {

bool ActionQueue::reserve(std::size_t bytes, std::size_t maxBytes) {
  bytes_ += bytes;
  return bytes_ <= maxBytes && tokens() <= kMaxTokens;
}

Predicates& ActionQueue::beginMessage() {
  message_.clear();
  return message_;
}

void ActionQueue::endMessage(bool keepMessage) {
  if (pending_.empty() && !holdingBack_ && !keepMessage)
    std::swap(pending_, message_);
  else
    append(message_);
}

void ActionQueue::append(const Predicates& actions) {
  for (const Element e : actions)
    if (e.isList()) (holdingBack_ && e.head() != first_ ? deferred_ : pending_).append(e);
}

void ActionQueue::dropPending() {
  pending_.clear();
  bytes_ = 0;
}

void ActionQueue::depart(std::int64_t due) {
  bytes_ = 0;
  if (!pending_.empty()) std::swap(underWay_.add(due), pending_);
}

void ActionQueue::holdBack(std::string_view first) {
  holdingBack_ = true;
  first_ = first;
  message_.clear();
  std::swap(message_, pending_);
  append(message_);
}

void ActionQueue::releaseHeldBack() {
  skipNext_ = true;
  holdingBack_ = false;
  std::swap(pending_, deferred_);
  for (const Element e : deferred_) pending_.append(e);
  deferred_.clear();
}

void ActionQueue::save(StateWriter& out) const {
  savePredicates(pending_, out);
  savePredicates(deferred_, out);
}

void ActionQueue::load(StateReader& in) {
  loadPredicates(in, pending_);
  loadPredicates(in, deferred_);
}

void ActionQueue::saveHold(StateWriter& out) const {
  out.write(skipNext_);
  out.write(holdingBack_);
  out.write(first_);
}

void ActionQueue::loadHold(StateReader& in) {
  skipNext_ = in.readBool();
  holdingBack_ = in.readBool();
  first_ = in.readString();
}

}  // namespace spark::gamecontrol
