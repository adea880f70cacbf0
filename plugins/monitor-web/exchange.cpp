#include "exchange.h"

#include <fmt/format.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "spark/error.h"

namespace spark::web {

Exchange::Exchange() : wakeupFd_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (wakeupFd_ < 0) throw Error(fmt::format("cannot make an eventfd: {}", std::strerror(errno)));
}

Exchange::~Exchange() { close(wakeupFd_); }

void Exchange::filled() {
  if (!urgent.load(std::memory_order_relaxed) && !wanted.load(std::memory_order_relaxed)->complete()) return;
  ready.store(wanted.exchange(nullptr, std::memory_order_acquire), std::memory_order_release);
  wake();
}

void Exchange::wake() {
  const std::uint64_t one = 1;
  // The write fails only if the counter is full, and then the descriptor is readable already.
  [[maybe_unused]] const auto written = write(wakeupFd_, &one, sizeof one);
}

}  // namespace spark::web
