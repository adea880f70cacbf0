#include "spark/plugin.h"

#include "draw_effector.h"
#include "drawing_server.h"

SPARK_PLUGIN("drawing", "1.0", "Agents' drawings for viewers: a UDP port, an effector, and the sets that viewers show.",
             spark::DrawingServer, spark::DrawEffector)
