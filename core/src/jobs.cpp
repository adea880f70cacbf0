#include <condition_variable>
#include <mutex>
#include <thread>

#include "spark/kernel.h"

namespace spark {

struct Jobs::Impl {
  std::vector<std::thread> threads;
  std::mutex mutex;
  std::condition_variable start, done;
  const std::function<void(std::size_t)>* job = nullptr;
  std::size_t n = 0, busy = 0, round = 0;
  std::atomic<std::size_t> next{0};
  bool ending = false;

  void work() {
    for (std::size_t i = next.fetch_add(1); i < n; i = next.fetch_add(1)) (*job)(i);
  }
  void loop() {
    std::size_t seen = 0;
    std::unique_lock lock(mutex);
    while (true) {
      start.wait(lock, [&] { return ending || round != seen; });
      if (ending) return;
      seen = round;
      lock.unlock();
      work();
      lock.lock();
      if (--busy == 0) done.notify_one();
    }
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
  impl_->stop();
  impl_->round = 0;
  for (int i = 1; i < std::min(count, 64); ++i) impl_->threads.emplace_back([this] { impl_->loop(); });
}

int Jobs::threads() const { return static_cast<int>(impl_->threads.size()) + 1; }

void Jobs::run(std::size_t n, const std::function<void(std::size_t)>& job) {
  if (impl_->threads.empty() || n < 2) {
    for (std::size_t i = 0; i < n; ++i) job(i);
    return;
  }
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->job = &job;
    impl_->n = n;
    impl_->next = 0;
    impl_->busy = impl_->threads.size();
    ++impl_->round;
  }
  impl_->start.notify_all();
  impl_->work();
  std::unique_lock lock(impl_->mutex);
  impl_->done.wait(lock, [&] { return impl_->busy == 0; });
}

}  // namespace spark
