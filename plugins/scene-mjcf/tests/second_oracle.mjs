// Moves a T1 in a current MuJoCo (WebAssembly) with the actuators of its file, and prints its joint angles as JSON.
//
//     node second_oracle.mjs FOLDER ROBOT.xml standing|moving      FOLDER: contains node_modules/@mujoco/mujoco
//
// The targets are those of trajectory_test.cpp.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [folder, robot, motion] = process.argv.slice(2);
const { default: load } = await import(pathToFileURL(`${folder}/node_modules/@mujoco/mujoco/mujoco.js`));
const mujoco = await load();
const world = `<option timestep="0.005" density="1.2" viscosity="2e-5"/>
  <worldbody><geom name="ground" type="plane" size="0 0 1"/></worldbody>`;
const text = readFileSync(robot, "utf8").replace(/<default>/, `${world}<default>`);
const model = mujoco.MjModel.from_xml_string(text), data = new mujoco.MjData(model);

const standing = motion === "standing", [kp, kd] = standing ? [200, 5] : [100, 3];
const target = (joint, time) => {
  const [low, high] = [model.jnt_range[2 * joint], model.jnt_range[2 * joint + 1]];
  if (standing) return Math.max(low + 0.02, Math.min(high - 0.02, 0));
  return 0.12 * Math.sin(2 * 3.14159265358979 * (0.5 + 0.07 * joint) * time + 0.4 * joint);
};

// Three actuators for each joint: torque, position, velocity.
for (let i = 0; i < model.nu; ++i) {
  const row = 10 * i;
  const position = model.actuator_biasprm[row + 1] !== 0, velocity = model.actuator_biasprm[row + 2] !== 0;
  if (position) model.actuator_gainprm[row] = kp, model.actuator_biasprm[row + 1] = -kp;
  if (velocity) model.actuator_gainprm[row] = kd, model.actuator_biasprm[row + 2] = -kd;
}
for (let cycle = 0; cycle < (standing ? 100 : 50); ++cycle) {
  for (let i = 0; i < model.nu; ++i)
    if (model.actuator_biasprm[10 * i + 1] !== 0) data.ctrl[i] = target(model.actuator_trnid[2 * i], cycle * 0.02);
  for (let k = 0; k < 4; ++k) mujoco.mj_step(model, data);
}
const angles = {};
for (let j = 1; j < model.njnt; ++j)
  angles[mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT.value, j)] = data.qpos[model.jnt_qposadr[j]];
console.log(JSON.stringify({ version: mujoco.mj_versionString(), motion, angles }));
