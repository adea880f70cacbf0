#include "spark/plugin.h"

#include "file_server.h"

SPARK_PLUGIN("files", "1.0", "The file server, and folders as file systems.", spark::FileServer,
             spark::DirectoryFileSystem)
