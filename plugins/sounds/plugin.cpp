#include "spark/plugin.h"

#include "sound_handler.h"
#include "sounds.h"

SPARK_PLUGIN("sounds", "1.0", "Sounds for monitors and the page, and the collision handler that plays them.",
             spark::Sounds, spark::SoundHandler)
