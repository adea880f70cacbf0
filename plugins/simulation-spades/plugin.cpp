#include "spark/plugin.h"

#include "sense_schedule.h"
#include "spades_server.h"

SPARK_PLUGIN("simulation-spades", "1.0",
             "Agents in simulated time, as the middleware SPADES has them: latencies, think times, causality.",
             spark::ThinkTime, spark::FixedThinkTime, spark::CpuThinkTime, spark::InstructionThinkTime,
             spark::SpadesServer, spark::TypeLatency, spark::SenseSchedule)
