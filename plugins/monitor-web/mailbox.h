#pragma once
/// \file
/// A lock-free mailbox: many threads put messages in, one thread takes all of them out.

#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

namespace spark::web {

/// A stack of heap-allocated messages with an atomic top pointer. Neither side blocks: a put and a takeAll are one
/// atomic exchange each, and put() retries only while other threads put at the same moment.
template <class T>
class Mailbox {
 public:
  Mailbox() = default;
  Mailbox(const Mailbox&) = delete;
  Mailbox& operator=(const Mailbox&) = delete;
  ~Mailbox() { takeAll(); }

  /// Adds a message. Any thread; allocates.
  void put(T value) {
    auto* message = new Message{std::move(value), top_.load(std::memory_order_relaxed)};
    while (!top_.compare_exchange_weak(message->below, message, std::memory_order_release, std::memory_order_relaxed)) {
    }
  }
  /// True if there is no message at this moment. Any thread; costs one load.
  bool empty() const { return !top_.load(std::memory_order_relaxed); }
  /// Removes and returns all messages, oldest first. Consumer thread only.
  std::vector<T> takeAll() {
    std::vector<T> out;
    for (Message* message = top_.exchange(nullptr, std::memory_order_acquire); message;) {
      out.push_back(std::move(message->value));
      delete std::exchange(message, message->below);
    }
    std::reverse(out.begin(), out.end());
    return out;
  }

 private:
  struct Message {
    T value;
    Message* below;  ///< put before this one
  };
  std::atomic<Message*> top_{nullptr};
};

}  // namespace spark::web
