#include "viewer.h"

namespace spark::web {

void Viewer::send(Message message) {
  if (closing_) return;
  waiting_ += message.bytes->size();
  if (waiting_ > kMostWaiting) return close("too much waits for you to read it");
  large_ += message.kind != Message::Kind::text;
  queue_.push_back(std::move(message));
  if (queue_.size() > 1) return;
  leavingSince_ = Clock::now();
  transmit(queue_.front());
}

void Viewer::sent() {
  waiting_ -= queue_.front().bytes->size();
  large_ -= queue_.front().kind != Message::Kind::text;
  queue_.pop_front();
  if (closing_) return;
  if (!queue_.empty()) {
    leavingSince_ = Clock::now();
    transmit(queue_.front());
  }
  resume();
}

void Viewer::close(std::string_view reason) {
  if (closing_) return;
  closing_ = true;
  hangUp(reason);
}

}  // namespace spark::web
