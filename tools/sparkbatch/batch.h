#pragma once
/// \file
/// The execution of a batch: the leader assigns runs to its own threads and to helper processes, and writes the results
/// into the table.

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

/// How signals stop a batch: `finish` starts no further runs, `abandon` also ends the current ones.
enum class StopMode { none, finish, abandon };

/// The leading process; without mpirun the only one.
class Leader {
 public:
  /// Opens the table; for a new table first builds the world of the first run as a check. Throws spark::Error.
  /// `options` and `cluster` must outlive it.
  Leader(const Options& options, Cluster& cluster);
  /// Executes all runs without a row; returns the exit code. A signal handler may set `stop` meanwhile.
  int run(const std::atomic<StopMode>& stop);
  /// The result as a JSON object: number of runs, time, memory.
  std::string summary() const;

 private:
  std::int64_t next(StopMode stop);
  void startRuns(StopMode stop);
  void handleMessages(StopMode stop);
  void add(Row row);

  const Options& options_;
  Cluster& cluster_;
  Sweep sweep_;
  Table table_;
  std::int64_t number_ = 0;  ///< of the last run that was assigned or has a row
  std::int64_t existing_;    ///< number of rows that the table had before
  Progress progress_;
  Workers workers_;
  Usage usage_;
  int helpers_;  ///< number of helpers that are not done
};

/// Ends all helpers without giving them a run.
void dismissHelpers(Cluster& cluster);

/// The main function of any other process: requests runs from the leader and sends it their rows, until there are none.
void runHelper(const Options& options, Cluster& cluster);

}  // namespace sparkbatch
