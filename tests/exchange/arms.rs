//! Arms as others write them.

/// Two links in the plane, motors in the joints, names and shapes as usual.
pub const TWO: &str = r#"<?xml version="1.0"?>
<robot name="two">
  <link name="world"/>
  <link name="upper_arm">
    <visual><geometry><mesh filename="package://two/upper.stl"/></geometry></visual>
    <inertial>
      <origin xyz="0.18 0 0" rpy="0 0 0"/>
      <mass value="2.5"/>
      <inertia ixx="0.004" ixy="0" ixz="0" iyy="0.04" iyz="0" izz="0.04"/>
    </inertial>
    <collision><geometry><box size="0.4 0.05 0.05"/></geometry></collision>
  </link>

  <joint name="shoulder" type="revolute">
    <parent link="world"/>
    <child link="upper_arm"/>
    <origin xyz="0 0 0.1" rpy="0 0 0"/>
    <axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="40" velocity="2"/>
  </joint>
  <joint name="elbow" type="revolute">
    <parent link="upper_arm"/>
    <child link="forearm"/>
    <origin xyz="0.4 0 0"/>
    <axis xyz="0 0 1"/>
    <limit lower="-2.5" upper="2.5" effort="20" velocity="3"/>
  </joint>
  <link name="forearm">
    <inertial>
      <origin xyz="0.15 0 0"/>
      <mass value="1.5"/>
      <inertia ixx="0.002" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/>
    </inertial>
  </link>
  <link name="tool0">
  </link>
  <joint name="tool" type="fixed">
    <parent link="forearm"/>
    <child link="tool0"/>
    <origin xyz="0.35 0 0"/>
  </joint>
</robot>
"#;

/// Three links in a vertical plane: axes along y, one of them the other way round; a tilted inertia, a geared motor with its
/// rotor, and bars that run up and along in the pose of the file.
pub const THREE: &str = r#"<robot name="three">
  <link name="base_link"/>
  <link name="a"><inertial><origin xyz="0 0.02 0.1" rpy="0 0.4 0"/><mass value="3"/>
    <inertia ixx="0.05" ixy="0" ixz="0" iyy="0.06" iyz="0" izz="0.02"/></inertial></link>
  <link name="b"><inertial><origin xyz="0.2 0 0"/><mass value="2"/>
    <inertia ixx="0.004" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.03"/></inertial></link>
  <link name="c"><inertial><origin xyz="0.12 0 0.01"/><mass value="1"/>
    <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.008" iyz="0" izz="0.008"/></inertial></link>
  <link name="motor_b"><inertial><mass value="0.2"/><inertia ixx="6e-6" ixy="0" ixz="0" iyy="1e-5" iyz="0" izz="6e-6"/></inertial></link>
  <link name="tcp"/>
  <joint name="j1" type="continuous"><parent link="base_link"/><child link="a"/><origin xyz="0.1 0 0.3"/><axis xyz="0 1 0"/></joint>
  <joint name="j2" type="continuous"><parent link="a"/><child link="b"/><origin xyz="0 0 0.25"/><axis xyz="0 1 0"/></joint>
  <joint name="j3" type="continuous"><parent link="b"/><child link="c"/><origin xyz="0.45 0 0" rpy="0 0 0"/><axis xyz="0 -1 0"/></joint>
  <joint name="m2" type="continuous"><parent link="a"/><child link="motor_b"/><origin xyz="0 0 0.25"/><axis xyz="0 1 0"/>
    <mimic joint="j2" multiplier="80"/></joint>
  <joint name="t" type="fixed"><parent link="c"/><child link="tcp"/><origin xyz="0.3 0 0"/></joint>
</robot>
"#;
