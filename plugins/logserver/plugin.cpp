#include "spark/plugin.h"

#include "file_log_sink.h"
#include "log_server.h"
#include "memory_log_sink.h"
#include "udp_log_sink.h"

SPARK_PLUGIN("logserver", "1.0", "The log as a node: levels at run time, and sinks: a rotating file, memory, UDP.",
             spark::LogServer, spark::LogSink, spark::FileLogSink, spark::MemoryLogSink, spark::UdpLogSink)
