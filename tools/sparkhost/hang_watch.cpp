#include "hang_watch.h"

namespace sparkhost {

using namespace spark;

namespace {
constexpr std::chrono::milliseconds kLook{250};
constexpr double kLookSeconds = 0.25;
}  // namespace

void HangWatch::describe(Description<HangWatch>& d) {
  d.doc("Says in the log what the simulation hangs in, and when it goes on.");
  d.property("after", &HangWatch::after, &HangWatch::setAfter)
      .unit("s")
      .range(0, 1e6)
      .doc("Wall time in one call of a node's code that counts as hanging; 0: nothing is said.");
}

void HangWatch::install(Kernel& kernel) {
  kernel.registerClass<HangWatch>();
  kernel.create<HangWatch>("HangWatch", kPath).start();
}

HangWatch::~HangWatch() { stop(); }

/// The host ends between two looks: what hung has returned.
void HangWatch::onUnlink() {
  stop();
  if (told_) tellGoesOn();
}

void HangWatch::start() {
  dog_.emplace();
  last_ = Clock::now();
  thread_ = std::thread([this] { watch(); });
}

void HangWatch::stop() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
  dog_.reset();
}

void HangWatch::tellGoesOn() {
  kernel().log().warning("The simulation goes on after {:.1f} s.",
                         std::chrono::duration<double>(Clock::now() - last_).count());
  told_ = toldEnd_ = false;
}

void HangWatch::watch() {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, kLook, [this] { return ending_; })) look();
}

/// Counts looks, not time: a host that was suspended, or has no processor, does not hang.
void HangWatch::look() {
  if (dog_->gotOn()) {
    if (told_) tellGoesOn();
    last_ = Clock::now();
    stuck_ = 0;
    return;
  }
  stuck_ += kLookSeconds;
  const double after = after_;
  if (after > 0 && stuck_ >= after) tell();
}

void HangWatch::tell() {
  const bool ends = kernel().stopRequested();
  if (told_ && (toldEnd_ || !ends)) return;
  const char* words = dog_->words();
  kernel().log().warning("The simulation stands still: for {:.1f} s it has been {}.{}",
                         std::chrono::duration<double>(Clock::now() - last_).count(),
                         *words ? words : "in a call that does not answer",
                         ends ? " It was asked to end; a second signal ends it at once." : "");
  told_ = true;
  toldEnd_ = ends;
}

}  // namespace sparkhost
