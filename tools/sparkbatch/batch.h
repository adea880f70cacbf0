#pragma once
/// \file
/// A batch from its options to its table: the leader hands out runs, to its own threads and to helpers, and writes what
/// comes back.

#include <atomic>
#include <deque>
#include <memory>
#include <string>

#include "cluster.h"
#include "options.h"
#include "progress.h"
#include "sweep.h"
#include "table.h"
#include "usage.h"
#include "workers.h"

namespace sparkbatch {

/// What a signal asks for: at first nothing new is begun, then what runs is abandoned.
enum class Wish { goOn, finish, abandon };

/// The process that leads. Without mpirun the only one.
class Leader {
 public:
  /// Checks the options against the first run's config and opens the table. Throws spark::Error.
  Leader(const Options& options, Cluster& cluster);
  /// Runs what has no row yet; returns the exit code. `wish` may change meanwhile.
  int run(const std::atomic<Wish>& wish);
  /// One JSON object: what was done and what it took.
  std::string summary() const;

 private:
  std::int64_t next(Wish wish);
  void begin(Wish wish);
  void answer(Wish wish);
  void add(Row row);

  const Options& options_;
  Cluster& cluster_;
  Sweep sweep_;
  Table table_;
  std::int64_t number_ = 0, there_;  ///< the last run that was looked at; rows that were there before
  Progress progress_;
  Workers workers_;
  Usage usage_;
  int helpers_;  ///< that are not done
};

/// Sends all helpers away when there is nothing to lead.
void dismiss(Cluster& cluster);

/// Any other process: asks the leader for runs and sends it their rows, until there are no more.
void help(const Options& options, Cluster& cluster);

}  // namespace sparkbatch
