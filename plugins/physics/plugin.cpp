#include "spark/plugin.h"

#include "angular_motor.h"
#include "colliders.h"
#include "controllers.h"
#include "handlers.h"
#include "mesh_colliders.h"
#include "physics_server.h"

SPARK_PLUGIN(
    "physics", "1.0",
    "Bodies, colliders, joints, controllers and collision handlers as scene nodes; the engine is another plugin.",
    spark::PhysicsServer, spark::PhysicsObject, spark::World, spark::Space, spark::CollisionGroup, spark::Body,
    spark::RigidBody, spark::BodyController, spark::DragController, spark::VelocityController, spark::FPSController,
    spark::Battery, spark::Collider, spark::TransformCollider, spark::ConvexCollider, spark::ConcaveCollider,
    spark::ConeCollider, spark::CompoundCollider, spark::EmptyCollider, spark::BoxCollider, spark::SphereCollider,
    spark::CapsuleCollider, spark::CylinderCollider, spark::PlaneCollider, spark::RayCollider, spark::TriMeshCollider,
    spark::HeightFieldCollider, spark::CollisionHandler, spark::ContactJointHandler, spark::RecorderHandler,
    spark::ScriptHandler, spark::Joint, spark::Generic6DOFJoint, spark::HingeJoint, spark::UniversalJoint,
    spark::Hinge2Joint, spark::BallJoint, spark::SliderJoint, spark::FixedJoint, spark::ConeTwistJoint,
    spark::AngularMotor)
