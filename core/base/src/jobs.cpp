#include "spark/jobs.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

// One call of run() is a round. A simulation cycle has a handful of rounds, and some take only a few dozen
// microseconds, so the overhead of a round matters. Therefore:
//  - an idle worker spins for a moment before it sleeps, so that a round that follows soon finds it awake. It does so
//    only if each thread can have a core of its own;
//  - a round ends when its jobs are done, not when every worker has seen it. A worker that wakes up too late finds the
//    round closed and goes back to sleep.
//
// The caller works too. Workers claim indices from an atomic counter; the mutex guards everything else.

namespace spark {
namespace {

/// How long a thread spins before it sleeps: about the cost of sleeping and waking, so that spinning without success at
/// most doubles that cost.
constexpr std::chrono::microseconds kSpin{20};

/// Hints to the processor that this is a spin loop.
void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

/// Spins until `condition()` is true, but no longer than kSpin.
template <class Condition>
void spinUntil(const Condition& condition) {
  constexpr int kTestsPerClock = 16;  // reading the clock costs more than a test
  const auto end = std::chrono::steady_clock::now() + kSpin;
  do {
    for (int i = 0; i < kTestsPerClock; ++i, pause())
      if (condition()) return;
  } while (std::chrono::steady_clock::now() < end);
}

}  // namespace

struct Jobs::Impl {
  std::vector<std::thread> threads;  ///< the workers
  std::mutex mutex;
  std::condition_variable start;                          ///< a round has begun, or the pool ends
  std::condition_variable done;                           ///< no worker works in the round any more
  const std::function<void(std::size_t)>* job = nullptr;  ///< of this round
  std::size_t n = 0;                                      ///< jobs of this round
  std::atomic<std::size_t> next{0};                       ///< the next index to claim
  std::atomic<std::uint64_t> round{0};                    ///< rounds begun so far; written under the mutex
  std::atomic<std::size_t> working{0};                    ///< workers in this round; written under the mutex
  std::size_t asleep = 0;                                 ///< workers that wait for `start`
  bool open = false;                                      ///< workers may still join the round
  bool ending = false;                                    ///< workers must return
  bool spins = false;                                     ///< threads spin before they sleep

  /// Claims and runs jobs until none is left.
  void work() {
    for (std::size_t i = next.fetch_add(1); i < n; i = next.fetch_add(1)) (*job)(i);
  }
  /// The loop of a worker. `seen`: the last round that it need not join.
  void loop(std::uint64_t seen) {
    while (true) {
      if (spins) spinUntil([&] { return round != seen; });
      std::unique_lock lock(mutex);
      ++asleep;
      start.wait(lock, [&] { return ending || round != seen; });
      --asleep;
      if (ending) return;
      seen = round;
      if (!open) continue;
      ++working;
      lock.unlock();
      work();
      lock.lock();
      if (--working == 0) done.notify_one();
    }
  }
  /// Opens a round. Returns true if workers sleep and must be notified.
  bool begin(std::size_t count, const std::function<void(std::size_t)>& what) {
    const std::lock_guard lock(mutex);
    job = &what;
    n = count;
    next = 0;
    open = true;
    ++round;
    return asleep > 0;
  }
  /// Closes the round and waits for the workers in it.
  void end() {
    {
      const std::lock_guard lock(mutex);
      open = false;
    }
    if (working == 0) return;
    if (spins) spinUntil([&] { return working == 0; });
    std::unique_lock lock(mutex);
    done.wait(lock, [&] { return working == 0; });
  }
  /// Ends and joins all workers.
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
  impl_->stop();
  constexpr int kMaxThreads = 64;
  count = std::min(count, kMaxThreads);
  impl_->spins = count <= static_cast<int>(std::thread::hardware_concurrency());
  for (int i = 1; i < count; ++i)
    impl_->threads.emplace_back([this, seen = impl_->round.load()] { impl_->loop(seen); });
}

int Jobs::threads() const { return static_cast<int>(impl_->threads.size()) + 1; }

void Jobs::run(std::size_t n, const std::function<void(std::size_t)>& job) {
  // Without workers, or with a single job, no round is needed.
  if (impl_->threads.empty() || n < 2) {
    for (std::size_t i = 0; i < n; ++i) job(i);
    return;
  }
  if (impl_->begin(n, job)) impl_->start.notify_all();
  impl_->work();
  impl_->end();
}

}  // namespace spark
