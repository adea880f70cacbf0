#include "spark/plugin.h"

#include "rsg_importer.h"
#include "scene_writer.h"

SPARK_PLUGIN("scene-rsg", "1.0", "The importer of the RSG scene language.", spark::RsgImporter, spark::SceneWriter)
