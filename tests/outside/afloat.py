"""Replays motor torques in MuJoCo on models whose bases float, one JSON object a line; answers with their base poses."""

import json
import sys

import mujoco

for line in sys.stdin:
    asked = json.loads(line)
    model = mujoco.MjModel.from_xml_string(asked["model"])
    data = mujoco.MjData(model)
    step, torques = asked["step"], asked["torques"]
    # Stages of the integrator fall on the instants at which the torques are known.
    model.opt.integrator, model.opt.timestep = mujoco.mjtIntegrator.mjINT_RK4, 2 * step

    def control(_, data):
        data.ctrl[:] = torques[round(data.time / step)]

    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    mujoco.set_mjcb_control(control)
    poses = []
    for _ in range((len(torques) - 1) // 2):
        mujoco.mj_step(model, data)
        poses.append([float(data.joint(name).qpos[0]) for name in ("base_x", "base_y", "base_turn")])
    mujoco.set_mjcb_control(None)
    print(json.dumps(poses), flush=True)
