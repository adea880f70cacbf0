#include "viewer.h"

namespace spark::web {

void Viewer::send(Message message) {
  if (closing_) return;
  queuedBytes_ += message.bytes->size();
  if (queuedBytes_ > kMaxQueuedBytes) return close("too much waits for you to read it");
  queuedFrames_ += message.isPicture();
  queuedPast_ += message.isPast();
  queue_.push_back(std::move(message));
  if (queue_.size() > 1) return;  // sent() continues with it
  sendingSince_ = Clock::now();
  transmit(queue_.front());
}

void Viewer::sent() {
  queuedBytes_ -= queue_.front().bytes->size();
  queuedFrames_ -= queue_.front().isPicture();
  queuedPast_ -= queue_.front().isPast();
  queue_.pop_front();
  if (closing_) return;
  if (!queue_.empty()) {
    sendingSince_ = Clock::now();
    transmit(queue_.front());
  }
  resume();
}

void Viewer::close(std::string_view reason) {
  if (closing_) return;
  closing_ = true;
  disconnect(reason);
}

}  // namespace spark::web
