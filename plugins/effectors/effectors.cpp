#include "agent_sync_effector.h"
#include "angular_motor_effector.h"
#include "control_effector.h"
#include "create_effector.h"
#include "force_effector.h"
#include "hinge2_effector.h"
#include "hinge_effector.h"
#include "hmdp_effector.h"
#include "slider_effector.h"
#include "spark/plugin.h"
#include "steering_effector.h"
#include "stiffness_effector.h"
#include "universal_joint_effector.h"

SPARK_PLUGIN("effectors", "1.0", "Effectors of robots: joints, motors, forces.", spark::HingeEffector,
             spark::UniversalJointEffector, spark::Hinge2Effector, spark::AngularMotorEffector,
             spark::StiffnessEffector, spark::AgentSyncEffector, spark::ForceEffector, spark::CreateEffector,
             spark::HMDPEffector, spark::ControlEffector, spark::ActuatorEffector, spark::EngineActuatorEffector,
             spark::SteeringEffector, spark::SliderEffector)
