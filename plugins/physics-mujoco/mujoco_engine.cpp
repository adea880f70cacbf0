#include "mujoco_engine.h"

#include "mujoco_mesh.h"
#include "spark/plugin.h"

namespace spark {

void MujocoEngine::report(const std::string& message) {
  ++messages_;
  if ((messages_ & (messages_ - 1)) == 0)
    kernel().log().warning("{}: MuJoCo reports: {} (message {})", path(), message, messages_);
}

}  // namespace spark

SPARK_PLUGIN("physics-mujoco", "1.0", "MuJoCo: contacts and dynamics in coordinates of joints.", spark::MujocoEngine,
             spark::MujocoOptions, spark::MujocoSurface, spark::MujocoAxis, spark::MujocoEquality, spark::MujocoTendon,
             spark::MujocoActuator, spark::MujocoPair, spark::MujocoFreedom, spark::MujocoMesh)
