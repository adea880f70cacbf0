#pragma once
/// \file
/// The state of a recorded run at any time.

#include <memory>

#include "options.h"
#include "recorded_run.h"

namespace sparkhost {

/// The state of the run at the end of the last cycle up to `own.at`, simulated from the last recorded state before,
/// with the recorded inputs. `own`: options of this program. nullptr: the file is a snapshot, whose one state is of
/// that time. Throws Error if there is no such state, or if the run cannot be simulated again until then.
std::shared_ptr<const ForkState> stateAt(const RecordedRun& run, const Options& own);

}  // namespace sparkhost
