#include "spark/plugin.h"

#include "remote_mount.h"
#include "remote_server.h"

SPARK_PLUGIN("remote", "1.0", "Nodes of other hosts in this one's tree, and the server that other hosts mount.",
             spark::RemoteServer, spark::RemoteMount, spark::RemoteNode)
