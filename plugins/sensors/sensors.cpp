#include "accelerometer.h"
#include "angular_motor_perceptor.h"
#include "battery_perceptor.h"
#include "collision_perceptor.h"
#include "distance_perceptor.h"
#include "force_resistance_perceptor.h"
#include "gps.h"
#include "gyro_rate_perceptor.h"
#include "hinge2_perceptor.h"
#include "hinge_perceptor.h"
#include "hmdp_perceptor.h"
#include "image_perceptor.h"
#include "joint_perceptor.h"
#include "lidar_perceptor.h"
#include "perceptor_handler.h"
#include "perfect_vision_perceptor.h"
#include "pose_perceptors.h"
#include "sonar_perceptor.h"
#include "spark/plugin.h"
#include "time_perceptor.h"
#include "touch_perceptor.h"
#include "touch_perceptor_handler.h"
#include "universal_joint_perceptor.h"

SPARK_PLUGIN("sensors", "1.0", "Perceptors of robots, and the collision handlers that feed them.", spark::TimePerceptor,
             spark::HingePerceptor, spark::UniversalJointPerceptor, spark::Hinge2Perceptor,
             spark::AngularMotorPerceptor, spark::GyroRatePerceptor, spark::Accelerometer,
             spark::ForceResistancePerceptor, spark::CollisionPerceptor, spark::TouchPerceptor, spark::GPS,
             spark::BatteryPerceptor, spark::HMDPPerceptor, spark::PerfectVisionPerceptor, spark::RayPerceptor,
             spark::DistancePerceptor, spark::LidarPerceptor, spark::SonarPerceptor, spark::ImagePerceptor,
             spark::PerceptorHandler, spark::TouchPerceptorHandler, spark::JointPerceptor, spark::PositionPerceptor,
             spark::OrientationPerceptor)
