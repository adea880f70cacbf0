#pragma once
/// \file
/// Answers viewers' questions in the simulation's thread, between cycles, within a budget.

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

/// All viewers together get a share of wall time: each request and each look at a watched property is paid for with the
/// time it took, and when the account is empty the next one waits. Commands of the referee and what costs next to
/// nothing are not weighed.
class Desk {
 public:
  struct Settings {
    double share = 0.02;            ///< of wall time
    bool everybodyInspects = true;  ///< false: only the referee asks about the tree
    bool refereeChanges = true;     ///< the referee may set properties and call methods
  };
  /// Both must outlive it.
  Desk(Kernel& kernel, Exchange& exchange);

  /// Does what is to be done now. `spectators`: how many watch, for the status.
  void work(const Settings& settings, int spectators);

 private:
  using Clock = std::chrono::steady_clock;
  struct Watched {
    std::uint64_t viewer;
    std::int64_t id;
    control::Watch watch;
    Clock::time_point due;
  };
  void receive(Question question, int spectators);
  std::string answer(const Question& question, const Settings& settings);
  std::string command(const Question& question);
  void startWatch(const Question& question, control::Watch watch);
  void lookAtWatches(Clock::time_point now);
  void tellDrawings(Clock::time_point now);
  void tellArtists(const IDrawings& drawings, std::uint64_t since);
  void tell(Answer::Kind kind, std::uint64_t viewer, std::string text);
  void refill(Clock::time_point now, double share);
  /// Does something and pays for it.
  template <class F>
  void paid(F f);

  Kernel& kernel_;
  Exchange& exchange_;
  StatusReport report_;
  std::deque<Question> requests_;
  std::vector<std::unique_ptr<Watched>> watches_;
  std::size_t nextWatch_ = 0;
  struct Artist {
    std::uint64_t viewer, version;
  };
  std::vector<Artist> artists_;  ///< viewers that want drawings, and what they were told last
  Clock::time_point drawingsDue_{}, refilledAt_{};
  double account_ = 0;  ///< s
  bool told_ = false;   ///< an answer is to be rung for
};

}  // namespace spark::web
