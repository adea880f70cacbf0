#include "ode_engine.h"

#include "ode_collision.h"
#include "spark/plugin.h"

SPARK_PLUGIN("physics-ode", "1.0", "The Open Dynamics Engine: collision detection and dynamics.", spark::OdeCollision,
             spark::OdeEngine)
