#include "hang_watch.h"

#include <signal.h>
#include <unistd.h>

#include <csignal>

namespace sparkhost {

using namespace spark;

namespace {
constexpr std::chrono::milliseconds kInterval{250};
constexpr double kIntervalSeconds = 0.25;
}  // namespace

void HangWatch::describe(Description<HangWatch>& d) {
  d.doc("Logs in which call the simulation hangs, and when it continues.");
  d.property("after", &HangWatch::after, &HangWatch::setAfter)
      .unit("s")
      .range(0, 1e6)
      .doc("Wall time in one call of a node's code that counts as a hang; 0: none does.");
  d.property("giveUp", &HangWatch::giveUp, &HangWatch::setGiveUp)
      .unit("s")
      .range(0, 1e6)
      .doc(
          "Wall time for which such a call may go on after the host was asked to end; then the process ends. 0: for "
          "ever.");
}

void HangWatch::install(Kernel& kernel) {
  kernel.registerClass<HangWatch>();
  kernel.create<HangWatch>("HangWatch", kPath).start();
}

HangWatch::~HangWatch() { stop(); }

/// Logs the end of a hang. The host may end between two checks; the call that hung has returned then.
void HangWatch::onUnlink() {
  stop();
  if (reported_) reportEnd();
}

void HangWatch::start() {
  watchdog_.emplace();
  lastProgress_ = Clock::now();
  thread_ = std::thread([this] { watch(); });
}

void HangWatch::stop() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
  watchdog_.reset();
}

void HangWatch::reportEnd() {
  kernel().log().warning("The simulation goes on after {:.1f} s.",
                         std::chrono::duration<double>(Clock::now() - lastProgress_).count());
  reported_ = stopReported_ = false;
}

void HangWatch::watch() {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, kInterval, [this] { return ending_; })) check();
}

/// Counts checks instead of time, because a host that was suspended, or got no processor time, does not hang.
void HangWatch::check() {
  if (watchdog_->gotOn()) {
    if (reported_) reportEnd();
    lastProgress_ = Clock::now();
    stuck_ = stuckAtEnd_ = 0;
    return;
  }
  stuck_ += kIntervalSeconds;
  const double after = after_;
  if (after > 0 && stuck_ >= after) reportHang();
  giveUpLate();
}

void HangWatch::giveUpLate() {
  const double limit = giveUp_;
  if (limit <= 0 || !kernel().stopRequested()) return;
  stuckAtEnd_ += kIntervalSeconds;
  if (stuckAtEnd_ < limit) return;
  kernel().log().error(
      "It was asked to end {:.1f} s ago and still stands still: it ends without the end of this cycle.", stuckAtEnd_);
  // As a second signal does.
  std::signal(SIGTERM, SIG_DFL);
  ::kill(::getpid(), SIGTERM);
}

/// Logs a hang once, and once more when a stop is requested meanwhile.
void HangWatch::reportHang() {
  const bool stopping = kernel().stopRequested();
  if (reported_ && (stopReported_ || !stopping)) return;
  const char* words = watchdog_->words();
  kernel().log().warning("The simulation stands still: for {:.1f} s it has been {}.{}",
                         std::chrono::duration<double>(Clock::now() - lastProgress_).count(),
                         *words ? words : "in a call that does not answer",
                         stopping ? " It was asked to end; a second signal ends it at once." : "");
  reported_ = true;
  stopReported_ = stopping;
}

}  // namespace sparkhost
