#pragma once
/// \file
/// Small robots of Webots, built as those of makers are: a driving base, a humanoid, an arm, a car.

namespace spark::webots::test {

/// Two wheels and a caster, sensors by DEF and USE, a PROTO with fields in the same file, a floor and a light.
inline constexpr const char* kCar = R"(#VRML_SIM R2023b utf8

EXTERNPROTO "https://raw.githubusercontent.com/cyberbotics/webots/R2023b/projects/objects/backgrounds/protos/TexturedBackground.proto"
EXTERNPROTO "https://raw.githubusercontent.com/cyberbotics/webots/R2023b/projects/objects/floors/protos/RectangleArena.proto"

PROTO Wheel [
  field SFString{"left wheel", "right wheel"} name "wheel"
  field SFVec3f  translation 0 0 0
  field SFColor  color       0.2 0.2 0.2   # a comment
]
{
  Solid {
    translation IS translation
    rotation 1 0 0 1.5707963267948966
    name IS name
    children [
      DEF RIM Shape {
        appearance PBRAppearance { baseColor IS color roughness 1 metalness 0 }
        geometry Cylinder { height 0.02 radius 0.05 subdivision 24 }
      }
    ]
    boundingObject USE RIM
    physics Physics { density -1 mass 0.1 }
  }
}

WorldInfo { info [ "a car" ] title "car" basicTimeStep 16 gravity 9.8 coordinateSystem "ENU" }
Viewpoint { orientation 0 1 0 0.5, position -1 0 1 }
TexturedBackground { }
RectangleArena { floorSize 2 1 wallHeight 0.2 }
DEF LAMP PointLight { location 0 0 2 intensity 0.5 color 1 1 0.5 }
DEF CAR Robot {
  hidden linearVelocity_0 0.1 0 0
  translation 0 0 0.05
  rotation 0 0 1 0
  name "car"
  controller "<generic>"
  children [
    Shape { appearance Appearance { material Material { diffuseColor 1 0 0 } } geometry DEF HULL Box { size 0.2 0.15 0.05 } }
    HingeJoint {
      jointParameters HingeJointParameters { axis 0 1 0 anchor 0.05 0.09 0 }
      device [
        RotationalMotor { name "left motor" maxVelocity 6.28 maxTorque 0.5 }
        PositionSensor { name "left sensor" }
      ]
      endPoint Wheel { name "left wheel" translation 0.05 0.09 0 }
    }
    HingeJoint {
      jointParameters HingeJointParameters { axis 0 1 0 anchor 0.05 -0.09 0 }
      device [ RotationalMotor { name "right motor" maxVelocity 6.28 maxTorque 0.5 } PositionSensor { name "right sensor" } ]
      endPoint Wheel { name "right wheel" translation 0.05 -0.09 0 color 1 1 1 }
    }
    DistanceSensor { translation 0.1 0 0.01 name "ds0" lookupTable [ 0 0 0.1, 0.5 0.5 0.1 ] type "laser" }
    DEF GPS_NODE GPS { name "gps" }
  ]
  boundingObject Group {
    children [
      Shape { geometry USE HULL }
      Pose { translation -0.08 0 -0.035 children [ Sphere { radius 0.015 } ] }
    ]
  }
  physics Physics { mass 2 density -1 }
}
)";

/// Legs of hinges one in another, as PROTO file: inertia by matrix, stops and soft limits, sensors of the body, feet
/// that feel, solids without joints.
inline constexpr const char* kHumanoid = R"(#VRML_SIM R2022a utf8
# license: own
PROTO Walker [
  field SFVec3f    translation   0 0 0.5
  field SFRotation rotation      0 0 1 0
  field SFString   name          "walker"
  field MFNode     headSlot      [ ]
  field SFFloat    kneeStop      -2.2
  unconnectedField SFBool unused FALSE
]
{
  Robot {
    translation IS translation
    rotation IS rotation
    name IS name
    children [
      Accelerometer { name "accelerometer" }
      Gyro { name "gyro" }
      InertialUnit { }
      Group { children IS headSlot }
      DEF HIP HingeJoint {
        jointParameters HingeJointParameters { axis 0 1 0 anchor 0 0.05 -0.1 minStop -1.5 maxStop 0.5 position 0.25 dampingConstant 0.1 }
        device [ RotationalMotor { name "LHipPitch" maxTorque 12 minPosition -1.2 maxPosition 0.4 } PositionSensor { name "LHipPitchS" } ]
        endPoint Solid {
          translation 0 0.05 -0.1
          rotation 0 1 0 0.25
          name "LThigh"
          children [
            HingeJoint {
              jointParameters HingeJointParameters { axis 0 1 0 anchor 0 0 -0.2 minStop IS kneeStop maxStop 0.1 springConstant 2 staticFriction 0.3 }
              device [ PositionSensor { name "LKneePitchS" } RotationalMotor { name "LKneePitch" } ]
              endPoint Solid {
                translation 0 0 -0.2
                name "LShin"
                children [
                  TouchSensor { translation 0 0 -0.2 name "LFoot" boundingObject Box { size 0.1 0.05 0.02 } physics Physics { mass 0.1 density -1 } }
                ]
                boundingObject Pose { translation 0 0 -0.1 children [ Capsule { radius 0.02 height 0.16 } ] }
                physics Physics { mass 0.5 density -1 centerOfMass [ 0 0 -0.09 ] inertiaMatrix [ 0.002 0.002 0.0002, 0 0 0 ] }
              }
            }
          ]
          physics Physics { mass 0.8 density -1 centerOfMass [ 0.01 0 -0.1 ] inertiaMatrix [ 0.003 0.003 0.0004 0 0.0001 0 ] }
        }
      }
    ]
    boundingObject Box { size 0.1 0.15 0.2 }
    physics Physics { density 500 }
    selfCollision TRUE
  }
}
)";

/// An arm on the ground: a base without a Physics, meshes, a slider for the tool, nested slots.
inline constexpr const char* kArm = R"(#VRML_SIM R2025a utf8
WorldInfo { }
Robot {
  name "arm"
  children [
    Shape { geometry Mesh { url "meshes/base.dae" } }
    HingeJoint {
      jointParameters HingeJointParameters { axis 0 0 1 anchor 0 0 0.1 }
      device RotationalMotor { name "shoulder_pan" maxVelocity 3.14 minPosition -6.28 maxPosition 6.28 maxTorque 150 }
      endPoint DEF UPPER Solid {
        translation 0 0 0.1
        name "upper"
        children [
          SliderJoint {
            jointParameters JointParameters { axis 1 0 0 minStop 0 maxStop 0.2 dampingConstant 5 }
            device [ LinearMotor { name "lift" maxForce 40 maxPosition 0.2 } ]
            endPoint Slot { type "tool" endPoint Solid {
              translation 0.1 0 0.3
              name "tool"
              boundingObject IndexedFaceSet {
                coord Coordinate { point [ 0 0 0, 0.1 0 0, 0 0.1 0, 0 0 0.1 ] }
                coordIndex [ 0 2 1 -1, 0 1 3 -1, 0 3 2 -1, 1 2 3 -1 ]
              }
              physics Physics { }
            } }
          }
        ]
        boundingObject Mesh { url [ "meshes/upper.stl" ] }
        physics Physics { mass 3.5 density -1 }
      }
    }
  ]
}
)";

/// A chassis with a steered wheel on a joint of two axes, and a ball joint for a trailer.
inline constexpr const char* kBuggy = R"(#VRML_SIM R2024a utf8
Robot {
  name "buggy"
  translation 0 0 0.3
  children [
    Hinge2Joint {
      jointParameters HingeJointParameters { axis 0 0 1 anchor 0.5 0.3 0 minStop -0.6 maxStop 0.6 position 0.3 }
      jointParameters2 JointParameters { axis 0 1 0 }
      device [ RotationalMotor { name "steer" } ]
      device2 [ RotationalMotor { name "roll" maxTorque 50 } PositionSensor { name "turns" } ]
      endPoint Solid { translation 0.5 0.3 0 rotation 0 0 1 0.3 name "wheel" boundingObject Sphere { radius 0.2 } physics Physics { } }
    }
    BallJoint {
      jointParameters BallJointParameters { anchor -0.6 0 0 dampingConstant 0.5 }
      endPoint Solid { translation -1 0 0 name "trailer" boundingObject Box { size 0.4 0.4 0.1 } physics Physics { mass 5 density -1 } }
    }
  ]
  boundingObject Box { size 1 0.5 0.2 }
  physics Physics { mass 20 density -1 }
}
)";

}  // namespace spark::webots::test
