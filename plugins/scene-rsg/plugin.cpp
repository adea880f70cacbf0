#include "rsg_importer.h"
#include "spark/plugin.h"

SPARK_PLUGIN("scene-rsg", "1.0", "The importer of the RSG scene language.", spark::RsgImporter)
