#include "workers.h"

namespace sparkbatch {

Workers::Workers(int threads, Work work) : work_(std::move(work)) {
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { loop(); });
}

Workers::~Workers() {
  abandon();
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  started_.notify_all();
  for (std::thread& t : threads_) t.join();
}

int Workers::idle() const { return static_cast<int>(threads_.size()) - running_; }

void Workers::start(Run run) {
  auto job = std::make_shared<Job>();
  job->run = std::move(run);
  ++running_;
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(job);
    active_.push_back(std::move(job));
  }
  started_.notify_one();
}

std::vector<Workers::Result> Workers::collect(std::chrono::milliseconds timeout) {
  std::vector<Result> out;
  std::unique_lock lock(mutex_);
  finished_.wait_for(lock, timeout, [this] { return !results_.empty(); });
  out.swap(results_);
  running_ -= static_cast<int>(out.size());
  return out;
}

void Workers::abandon() {
  const std::lock_guard lock(mutex_);
  for (const auto& job : active_) job->control.abandon();
}

double Workers::time() const {
  const std::lock_guard lock(mutex_);
  double sum = 0;
  for (const auto& job : active_) sum += job->control.time();
  return sum;
}

void Workers::loop() {
  std::unique_lock lock(mutex_);
  while (true) {
    started_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
    if (ending_) return;
    const std::shared_ptr<Job> job = waiting_.front();
    waiting_.pop_front();
    lock.unlock();
    Row row = work_(job->run, job->control);
    lock.lock();
    std::erase(active_, job);
    if (job->control.abandoned())
      results_.emplace_back(std::nullopt);
    else
      results_.emplace_back(std::move(row));
    finished_.notify_one();
  }
}

}  // namespace sparkbatch
