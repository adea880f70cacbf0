#include "player.h"
#include "recorded_match.h"
#include "recorder.h"
#include "snapshots.h"

SPARK_PLUGIN("recorder", "1.0", "Records the inputs of a run to an MCAP file, and plays them.", spark::Recorder,
             spark::InputPlayer, spark::Snapshots, spark::RecordedMatch)
