#pragma once
/// \file
/// Detects hangs of the simulation.

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "spark/describe.h"
#include "spark/kernel.h"
#include "watchdog.h"

namespace sparkhost {

/// A thread that checks four times a second whether the simulation thread makes progress. If one call of a node's code
/// takes longer than `after`, it logs once in which call, and again when the simulation continues. A call that goes on
/// for `giveUp` after the host was asked to end is ended with the process. Its cost in the step is one counter.
class HangWatch : public spark::Node {
  SPARK_CLASS(HangWatch, spark::Node)
 public:
  static constexpr const char* kPath = "/sys/host/watchdog";
  static void describe(spark::Description<HangWatch>& d);
  /// Creates one in the kernel's tree that watches the calling thread.
  static void install(spark::Kernel& kernel);
  ~HangWatch() override;

 protected:
  void onUnlink() override;

 private:
  using Clock = std::chrono::steady_clock;
  double after() const { return after_; }
  double giveUp() const { return giveUp_; }
  void setGiveUp(double seconds) { giveUp_ = seconds; }
  void setAfter(double seconds) { after_ = seconds; }
  void start();
  void stop();
  void watch();
  void check();
  void reportHang();
  void reportEnd();
  /// Ends the process if it was asked to end, and a call that hangs keeps it from that.
  void giveUpLate();

  std::atomic<double> after_ = 2, giveUp_ = 10;
  std::optional<Watchdog> watchdog_;
  std::thread thread_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool ending_ = false;
  // Used by its thread, and after stop() by the simulation thread.
  Clock::time_point lastProgress_{};
  double stuck_ = 0;           ///< s without progress, as counted by check()
  double stuckAtEnd_ = 0;      ///< the part of it since a request to stop [s]
  bool reported_ = false;      ///< the hang was logged
  bool stopReported_ = false;  ///< the hang was logged again after a request to stop
};

}  // namespace sparkhost
