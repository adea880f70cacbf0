#include "player.h"
#include "recorder.h"

SPARK_PLUGIN("recorder", "1.0", "Records the inputs of a run to an MCAP file, and plays them.", spark::Recorder,
             spark::InputPlayer)
