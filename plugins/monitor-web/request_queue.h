#pragma once
/// \file
/// Executes viewers' requests in the simulation thread, between cycles, within a time budget.

#include <chrono>
#include <deque>
#include <memory>
#include <vector>

#include "api/control.h"
#include "api/drawing.h"
#include "exchange.h"
#include "spark/kernel.h"
#include "status_report.h"

namespace spark::web {

/// The budget grows with wall time, by `Settings::share` of it. Each request, each poll of a watched property and each
/// drawings message is charged with the time that it took; while the budget is not positive, the next one waits. The
/// referee's commands and the status report are cheap and not charged. Files are only looked for, unless they are in an
/// archive: another thread reads them.
class RequestQueue {
 public:
  struct Settings {
    double share = 0.02;            ///< fraction of wall time, 0..1
    bool everybodyInspects = true;  ///< false: only referees may inspect the tree
    bool refereeChanges = true;     ///< referees may set properties and call methods
  };
  /// `kernel` and `exchange` must outlive it.
  RequestQueue(Kernel& kernel, Exchange& exchange);

  /// Takes new requests from the exchange and executes requests, watches and subscriptions as far as the budget allows.
  /// `spectators`: number of viewers, for the status report. Simulation thread, between two cycles.
  void process(const Settings& settings, int spectators);

 private:
  using Clock = std::chrono::steady_clock;
  struct WatchedProperty {
    std::uint64_t viewer;
    std::int64_t id;  ///< of the request that started the watch
    control::Watch watch;
    Clock::time_point due;  ///< when to poll it again
  };
  struct DrawingSubscriber {
    std::uint64_t viewer;
    std::uint64_t version;  ///< IDrawings::version() that was sent last; 0: none
  };
  void receive(SimulationRequest request, int spectators);
  std::string executeControl(const SimulationRequest& request, const Settings& settings);
  FoundFile findFile(const std::string& resource) const;
  std::string executeCommand(const SimulationRequest& request);
  void startWatch(const SimulationRequest& request, control::Watch watch);
  void endWatch(std::uint64_t viewer, std::int64_t id);
  bool mayWatchMore(std::uint64_t viewer) const;
  void pollWatches(Clock::time_point now);
  void sendDrawings(Clock::time_point now);
  void sendDrawingsSince(const IDrawings& drawings, std::uint64_t since);
  void send(SimulationReply::Kind kind, std::uint64_t viewer, std::string text);
  void refillBudget(Clock::time_point now, double share);
  /// Calls `f` and charges the time that it took.
  template <class F>
  void charge(F f);

  Kernel& kernel_;
  Exchange& exchange_;
  StatusReport report_;
  std::deque<SimulationRequest> requests_;  ///< control requests and files that wait for budget
  std::vector<std::unique_ptr<WatchedProperty>> watches_;
  std::size_t nextWatch_ = 0;  ///< index of the watch to poll next
  std::vector<DrawingSubscriber> subscribers_;
  Clock::time_point drawingsDue_{}, refilledAt_{};
  double budget_ = 0;            ///< s; negative after work that took longer than the budget
  bool repliesPending_ = false;  ///< replies are in the exchange for which the I/O thread was not woken yet
};

}  // namespace spark::web
