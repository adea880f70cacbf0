#pragma once
/// \file
/// Small robots in URDF, built as those of makers are: an arm, a quadruped, a driving base, a gripper, a humanoid.

namespace spark::urdf::test {

/// An arm on a fixed base: `world`, revolute joints with limits and dynamics, torque interfaces, inertial frames that
/// are turned.
inline constexpr const char* kArm = R"(<?xml version="1.0" ?>
<!-- an arm -->
<robot name="arm">
  <material name="steel"><color rgba="0.7 0.7 0.75 1"/></material>
  <link name="world"/>
  <joint name="world_joint" type="fixed"><parent link="world"/><child link="base"/><origin xyz="0 0 0.1" rpy="0 0 0"/></joint>
  <link name="base">
    <inertial><origin xyz="0 0 0.05"/><mass value="4"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>
    <visual><geometry><cylinder radius="0.08" length="0.1"/></geometry><material name="steel"/></visual>
    <collision><geometry><cylinder radius="0.08" length="0.1"/></geometry></collision>
  </link>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="upper"/><origin xyz="0 0 0.12" rpy="0 0.3 0.2"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" effort="150" velocity="3.15"/><dynamics damping="0.4" friction="0"/>
  </joint>
  <link name="upper">
    <inertial><origin xyz="0 0.02 0.2" rpy="0.4 -0.3 1.1"/><mass value="3.5"/><inertia ixx="0.05" ixy="0.002" ixz="-0.001" iyy="0.04" iyz="0.003" izz="0.02"/></inertial>
    <visual><origin xyz="0 0 0.2"/><geometry><box size="0.08 0.08 0.4"/></geometry><material name="red"><color rgba="0.8 0.1 0.1 1"/></material></visual>
    <collision><origin xyz="0 0 0.2"/><geometry><box size="0.08 0.08 0.4"/></geometry></collision>
  </link>
  <joint name="elbow" type="revolute">
    <parent link="upper"/><child link="fore"/><origin xyz="0.01 0 0.4" rpy="0.1 0 -0.2"/><axis xyz="0 0.6 0.8"/>
    <limit lower="-2.5" upper="2.5" effort="80" velocity="3.15"/><dynamics damping="0.2"/>
  </joint>
  <link name="fore">
    <inertial><origin xyz="0 0 0.15"/><mass value="1.5"/><inertia ixx="0.012" ixy="0" ixz="0" iyy="0.011" iyz="0" izz="0.004"/></inertial>
    <collision><origin xyz="0 0 0.15"/><geometry><cylinder radius="0.03" length="0.3"/></geometry></collision>
  </link>
  <joint name="lift" type="prismatic">
    <parent link="fore"/><child link="tool"/><origin xyz="0 0 0.3" rpy="0 1.2 0"/><axis xyz="1 0 0"/>
    <limit lower="-0.5" upper="0.5" effort="40" velocity="1"/><dynamics damping="3"/>
  </joint>
  <link name="tool"><inertial><mass value="0.4"/><inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/></inertial></link>
  <joint name="flange" type="fixed"><parent link="tool"/><child link="tip"/><origin xyz="0.05 0 0" rpy="0.5 0 0"/></joint>
  <link name="tip"><inertial><origin xyz="0.02 0.01 0"/><mass value="0.1"/><inertia ixx="0.0002" ixy="0" ixz="0" iyy="0.0003" iyz="0" izz="0.0003"/></inertial></link>
  <transmission name="t1"><type>transmission_interface/SimpleTransmission</type>
    <joint name="shoulder"><hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface></joint>
    <actuator name="m1"><mechanicalReduction>1</mechanicalReduction></actuator></transmission>
  <transmission name="t2"><type>transmission_interface/SimpleTransmission</type>
    <joint name="elbow"><hardwareInterface>hardware_interface/PositionJointInterface</hardwareInterface></joint>
    <actuator name="m2"/></transmission>
</robot>
)";

/// A base that moves freely on legs with feet that are fixed to the shanks, meshes by package, an IMU.
inline constexpr const char* kQuadruped = R"(<robot name="dog">
  <link name="trunk">
    <inertial><origin xyz="0.01 0 0"/><mass value="6"/><inertia ixx="0.03" ixy="0" ixz="0" iyy="0.08" iyz="0" izz="0.09"/></inertial>
    <visual><geometry><mesh filename="package://dog_description/meshes/trunk.dae"/></geometry></visual>
    <collision><geometry><mesh filename="package://dog_description/meshes/trunk.obj" scale="0.5 0.2 0.1"/></geometry></collision>
  </link>
  <link name="imu_link"/>
  <joint name="imu_joint" type="fixed"><parent link="trunk"/><child link="imu_link"/></joint>
  <gazebo reference="imu_link"><sensor name="imu" type="imu"><always_on>true</always_on></sensor></gazebo>
  <joint name="FL_hip" type="revolute"><parent link="trunk"/><child link="FL_thigh"/><origin xyz="0.18 0.08 0"/><axis xyz="0 1 0"/>
    <limit lower="-1.5" upper="1.5" effort="24" velocity="30"/></joint>
  <link name="FL_thigh"><inertial><origin xyz="0 0 -0.1"/><mass value="1"/><inertia ixx="0.005" ixy="0" ixz="0" iyy="0.005" iyz="0" izz="0.001"/></inertial>
    <collision><origin xyz="0 0 -0.1"/><geometry><box size="0.03 0.03 0.2"/></geometry></collision></link>
  <joint name="FL_knee" type="revolute"><parent link="FL_thigh"/><child link="FL_shank"/><origin xyz="0 0 -0.2"/><axis xyz="0 1 0"/>
    <limit lower="-2.7" upper="-0.2" effort="24" velocity="30"/></joint>
  <link name="FL_shank"><inertial><origin xyz="0 0 -0.1"/><mass value="0.2"/><inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.0001"/></inertial></link>
  <joint name="FL_foot_fixed" type="fixed"><parent link="FL_shank"/><child link="FL_foot"/><origin xyz="0 0 -0.2"/></joint>
  <link name="FL_foot"><inertial><mass value="0.06"/><inertia ixx="1e-5" ixy="0" ixz="0" iyy="1e-5" iyz="0" izz="1e-5"/></inertial>
    <collision><geometry><sphere radius="0.02"/></geometry></collision></link>
</robot>
)";

/// A root link without a mass below a base with wheels and a caster; no transmissions.
inline constexpr const char* kCar = R"(<robot name="car">
  <link name="base_footprint"/>
  <joint name="base_joint" type="fixed"><parent link="base_footprint"/><child link="base_link"/><origin xyz="0 0 0.05"/></joint>
  <link name="base_link"><inertial><mass value="2"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.02"/></inertial>
    <visual><geometry><box size="0.2 0.15 0.05"/></geometry><material name="black"><color rgba="0.1 0.1 0.1 1"/></material></visual>
    <collision><geometry><box size="0.2 0.15 0.05"/></geometry></collision>
    <collision><origin xyz="-0.08 0 -0.035"/><geometry><sphere radius="0.015"/></geometry></collision></link>
  <link name="left_wheel"><inertial><mass value="0.1"/><inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="2e-4"/></inertial>
    <collision><geometry><cylinder radius="0.05" length="0.02"/></geometry></collision></link>
  <joint name="left" type="continuous"><parent link="base_link"/><child link="left_wheel"/><origin xyz="0.05 0.09 0" rpy="-1.5707963 0 0"/><axis xyz="0 0 1"/></joint>
  <link name="right_wheel"><inertial><mass value="0.1"/><inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="2e-4"/></inertial>
    <collision><geometry><cylinder radius="0.05" length="0.02"/></geometry></collision></link>
  <joint name="right" type="continuous"><parent link="base_link"/><child link="right_wheel"/><origin xyz="0.05 -0.09 0" rpy="-1.5707963 0 0"/><axis xyz="0 0 1"/></joint>
</robot>
)";

/// Two fingers, of which one follows the other, and a link without a mass between two joints.
inline constexpr const char* kGripper = R"(<robot name="gripper">
  <link name="world"/>
  <link name="turner"/>
  <joint name="turn" type="revolute"><parent link="world"/><child link="turner"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="5" velocity="1"/></joint>
  <link name="palm"><inertial><mass value="0.5"/><inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/></inertial></link>
  <joint name="tilt" type="revolute"><parent link="turner"/><child link="palm"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="5" velocity="1"/></joint>
  <link name="left_finger"><inertial><mass value="0.1"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
  <joint name="left_joint" type="prismatic"><parent link="palm"/><child link="left_finger"/><origin xyz="0 0 0.1"/><axis xyz="0 1 0"/><limit lower="0" upper="0.04" effort="20" velocity="0.2"/></joint>
  <link name="right_finger"><inertial><mass value="0.1"/><inertia ixx="1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
  <joint name="right_joint" type="prismatic"><parent link="palm"/><child link="right_finger"/><origin xyz="0 0 0.1"/><axis xyz="0 -1 0"/><limit lower="0" upper="0.04" effort="20" velocity="0.2"/>
    <mimic joint="left_joint" multiplier="1" offset="0"/></joint>
</robot>
)";

}  // namespace spark::urdf::test
