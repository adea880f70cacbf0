#include "spark/jobs.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

// A cycle has a handful of rounds, some of a few dozen microseconds: what a round costs beside its jobs matters. So
//  - an idle thread spins for a next round before it sleeps, where every thread can have a core of its own; a host that
//    waits for input finds its threads asleep;
//  - a round is over when its jobs are done, not when every thread has seen it: a thread that wakes up too late finds
//  it
//    closed and goes back to sleep.

namespace spark {
namespace {

/// About what falling asleep and being woken costs: spinning in vain at most doubles it.
constexpr std::chrono::microseconds kSpin{20};

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

/// Spins until `come()` holds, for kSpin at most.
template <class Condition>
void spinUntil(const Condition& come) {
  const auto end = std::chrono::steady_clock::now() + kSpin;
  do {
    for (int i = 0; i < 16; ++i, pause())
      if (come()) return;
  } while (std::chrono::steady_clock::now() < end);
}

}  // namespace

struct Jobs::Impl {
  std::vector<std::thread> threads;
  std::mutex mutex;
  std::condition_variable start, done;
  const std::function<void(std::size_t)>* job = nullptr;
  std::size_t n = 0;
  std::atomic<std::size_t> next{0};
  std::atomic<std::uint64_t> round{0};
  std::atomic<std::size_t> inside{
      0};  ///< threads that work in this round, the caller's not counted; changed under the mutex
  std::size_t asleep = 0;
  bool open = false, ending = false, patient = false;

  void work() {
    for (std::size_t i = next.fetch_add(1); i < n; i = next.fetch_add(1)) (*job)(i);
  }
  void loop(std::uint64_t seen) {
    while (true) {
      if (patient) spinUntil([&] { return round != seen; });
      std::unique_lock lock(mutex);
      ++asleep;
      start.wait(lock, [&] { return ending || round != seen; });
      --asleep;
      if (ending) return;
      seen = round;
      if (!open) continue;
      ++inside;
      lock.unlock();
      work();
      lock.lock();
      if (--inside == 0) done.notify_one();
    }
  }
  /// True when somebody must be woken.
  bool begin(std::size_t count, const std::function<void(std::size_t)>& what) {
    const std::lock_guard lock(mutex);
    job = &what;
    n = count;
    next = 0;
    open = true;
    ++round;
    return asleep > 0;
  }
  void end() {
    {
      const std::lock_guard lock(mutex);
      open = false;
    }
    if (inside == 0) return;
    if (patient) spinUntil([&] { return inside == 0; });
    std::unique_lock lock(mutex);
    done.wait(lock, [&] { return inside == 0; });
  }
  void stop() {
    {
      const std::lock_guard lock(mutex);
      ending = true;
    }
    start.notify_all();
    for (std::thread& t : threads) t.join();
    threads.clear();
    ending = false;
  }
};

Jobs::Jobs() : impl_(std::make_unique<Impl>()) {}
Jobs::~Jobs() { impl_->stop(); }

void Jobs::setThreads(int count) {
  SPARK_ASSERT(count >= 1);
  impl_->stop();
  count = std::min(count, 64);
  impl_->patient = count <= static_cast<int>(std::thread::hardware_concurrency());
  for (int i = 1; i < count; ++i)
    impl_->threads.emplace_back([this, seen = impl_->round.load()] { impl_->loop(seen); });
}

int Jobs::threads() const { return static_cast<int>(impl_->threads.size()) + 1; }

void Jobs::run(std::size_t n, const std::function<void(std::size_t)>& job) {
  if (impl_->threads.empty() || n < 2) {
    for (std::size_t i = 0; i < n; ++i) job(i);
    return;
  }
  if (impl_->begin(n, job)) impl_->start.notify_all();
  impl_->work();
  impl_->end();
}

}  // namespace spark
