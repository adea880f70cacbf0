#pragma once
/// \file
/// A mailbox between threads: many put, one takes everything.

#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

namespace spark::web {

/// Nobody waits for anybody: putting and taking are one exchange of a pointer each.
template <class T>
class Mailbox {
 public:
  Mailbox() = default;
  Mailbox(const Mailbox&) = delete;
  Mailbox& operator=(const Mailbox&) = delete;
  ~Mailbox() { takeAll(); }

  /// Any thread.
  void put(T value) {
    auto* letter = new Letter{std::move(value), top_.load(std::memory_order_relaxed)};
    while (!top_.compare_exchange_weak(letter->below, letter, std::memory_order_release, std::memory_order_relaxed)) {
    }
  }
  /// Any thread; may be outdated at once. Costs one load.
  bool empty() const { return !top_.load(std::memory_order_relaxed); }
  /// The one taker: all letters, the oldest first.
  std::vector<T> takeAll() {
    std::vector<T> out;
    for (Letter* letter = top_.exchange(nullptr, std::memory_order_acquire); letter;) {
      out.push_back(std::move(letter->value));
      delete std::exchange(letter, letter->below);
    }
    std::reverse(out.begin(), out.end());
    return out;
  }

 private:
  struct Letter {
    T value;
    Letter* below;
  };
  std::atomic<Letter*> top_{nullptr};
};

}  // namespace spark::web
