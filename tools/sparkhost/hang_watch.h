#pragma once
/// \file
/// Says what a run hangs in.

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "spark/describe.h"
#include "spark/kernel.h"
#include "watchdog.h"

namespace sparkhost {

/// A thread that looks four times a second whether the simulation's thread gets on. Where one call of a node's code
/// takes longer than `after`, the log says once in which; and again when it goes on. Nothing of it is in the step's way
/// but the counter that the step counts up.
class HangWatch : public spark::Node {
  SPARK_CLASS(HangWatch, spark::Node)
 public:
  static constexpr const char* kPath = "/sys/host/watchdog";
  static void describe(spark::Description<HangWatch>& d);
  /// Makes one in the kernel's tree, which watches the calling thread.
  static void install(spark::Kernel& kernel);
  ~HangWatch() override;

 protected:
  void onUnlink() override;

 private:
  using Clock = std::chrono::steady_clock;
  double after() const { return after_; }
  void setAfter(double seconds) { after_ = seconds; }
  void start();
  void stop();
  void watch();
  void look();
  void tell();
  void tellGoesOn();

  std::atomic<double> after_ = 2;
  std::optional<Watchdog> dog_;
  std::thread thread_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool ending_ = false;
  // Of its thread alone, and of who ended that.
  Clock::time_point last_{};  ///< when it got on
  double stuck_ = 0;          ///< s that it was seen not to
  bool told_ = false, toldEnd_ = false;
};

}  // namespace sparkhost
