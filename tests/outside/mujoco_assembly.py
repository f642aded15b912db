"""What MuJoCo finds of assemblies in motion on standard input, one JSON object a line; answers in the same way."""

import json
import sys

import mujoco
import numpy as np


def equality_rows(model, data):
    """How open the equalities are, and how they change with each degree of freedom."""
    rows = np.zeros((data.nefc, model.nv))
    if data.nefc and mujoco.mj_isSparse(model):
        mujoco.mju_sparse2dense(rows, data.efc_J, data.efc_J_rownnz, data.efc_J_rowadr, data.efc_J_colind)
    elif data.nefc:
        rows = data.efc_J.reshape(data.nefc, -1)
    is_equality = data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY
    return np.abs(data.efc_pos[is_equality]).max(initial=0.0), rows[is_equality]


def tips(data, names):
    return [data.sensor(f"{name}/end effector").data.tolist() for name in names]


def found(model, data, asked, motion):
    columns = np.array(asked["columns"]).T
    hinges = model.nv - len(columns)

    def move():
        data.qpos[:], data.qvel[:], data.qacc[:] = motion["qpos"], motion["qvel"], motion["qacc"]

    # Whether pins, gears and platforms hold, and stay so to first order whatever drive turns.
    model.opt.disableflags = 0
    move()
    mujoco.mj_forward(model, data)
    open_by, rows = equality_rows(model, data)
    moves_by = np.abs(rows[:, hinges:] @ columns).max(initial=0.0)
    # What the motion takes, with nothing but it: it keeps equalities by itself.
    model.opt.disableflags = mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    move()
    mujoco.mj_inverse(model, data)
    mujoco.mj_subtreeVel(model, data)
    base = model.body("base").id
    return {
        "open": float(open_by),
        "moves": float(moves_by),
        "torque": (columns.T @ data.qfrc_inverse[hinges:]).tolist(),
        # What moves a base that floats: a force in space, and a moment about its origin in its axes.
        "on_base": data.qfrc_inverse[:hinges].tolist(),
        # They read what holds the blocks; what these do to the base is the opposite.
        "force": (-data.sensor("base force").data).tolist(),
        "moment": (-data.sensor("base moment").data).tolist(),
        "tips": tips(data, asked["blocks"]),
        # Of base and blocks, in space: about the common centre of mass.
        "linear": (data.subtree_linvel[base] * model.body_subtreemass[base]).tolist(),
        "angular": data.subtree_angmom[base].tolist(),
    }


def simulated(model, data, asked):
    """Applies the torques of a run and nothing else; returns end effectors, and what most of all reaches the base."""
    model.opt.disableflags = 0
    step, torques = asked["step"], asked["torques"]
    # Stages of the integrator fall on the instants at which the torques are known.
    model.opt.integrator, model.opt.timestep = mujoco.mjtIntegrator.mjINT_RK4, 2 * step

    def control(_, data):
        data.ctrl[:] = torques[min(round(data.time / step), len(torques) - 1)]

    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    data.qvel[:] = asked["qvel"]
    mujoco.set_mjcb_control(control)
    ways, reaction = [], 0.0
    for _ in range((len(torques) - 1) // 2):
        mujoco.mj_step(model, data)
        mujoco.mj_forward(model, data)
        ways.append(tips(data, asked["blocks"]))
        six = [data.sensor(f"base {what}").data for what in ("force", "moment")]
        reaction = max(reaction, float(np.abs(six).max()))
    mujoco.set_mjcb_control(None)
    return {"tips": ways, "reaction": reaction}


for line in sys.stdin:
    asked = json.loads(line)
    model = mujoco.MjModel.from_xml_string(asked["model"])
    data = mujoco.MjData(model)
    if "torques" in asked:
        print(json.dumps(simulated(model, data, asked)), flush=True)
    else:
        print(json.dumps([found(model, data, asked, motion) for motion in asked["motions"]]), flush=True)
