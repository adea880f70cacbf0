#include "bullet_engine.h"

#include "spark/plugin.h"

SPARK_PLUGIN("physics-bullet", "1.0", "Bullet: contacts and dynamics in coordinates of joints.", spark::BulletEngine)
