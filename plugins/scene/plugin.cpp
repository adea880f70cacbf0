#include "spark/plugin.h"

#include "materials.h"
#include "scene_server.h"
#include "status_variables.h"
#include "variables.h"
#include "visuals.h"

SPARK_PLUGIN("scene", "1.0", "The scene server, transforms, what viewers see, materials, script variables.",
             spark::SceneNode, spark::Transform, spark::Scene, spark::SceneServer, spark::Light, spark::Camera,
             spark::Axis, spark::RenderNode, spark::StaticMesh, spark::SingleMatNode, spark::Box, spark::Sphere,
             spark::Capsule, spark::Cylinder, spark::MaterialSolid, spark::Material2DTexture, spark::MaterialServer,
             spark::Variables, spark::StatusVariables)
