"""What MuJoCo finds of the models and motions on standard input, one JSON object a line; answers in the same way."""

import json
import sys

import mujoco
import numpy as np

for line in sys.stdin:
    asked = json.loads(line)
    model = mujoco.MjModel.from_xml_string(asked["model"])
    data = mujoco.MjData(model)
    columns = np.array(asked["columns"]).T
    answers = []
    for motion in asked["motions"]:
        data.qpos[:], data.qvel[:], data.qacc[:] = motion["qpos"], motion["qvel"], motion["qacc"]
        # Whether its own pins and gears hold, and stay so to first order whatever drive turns.
        model.opt.disableflags = 0
        mujoco.mj_forward(model, data)
        rows = np.zeros((data.nefc, model.nv))
        if data.nefc:
            rows = data.efc_J.reshape(data.nefc, -1)
            if mujoco.mj_isSparse(model):
                dense = np.zeros((data.nefc, model.nv))
                mujoco.mju_sparse2dense(dense, data.efc_J, data.efc_J_rownnz, data.efc_J_rowadr, data.efc_J_colind)
                rows = dense
        is_equality = data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY
        open_by = np.abs(data.efc_pos[is_equality]).max(initial=0.0)
        moves_by = np.abs(rows[is_equality] @ columns).max(initial=0.0)
        # What the motion takes, with nothing but it: pins are kept by the motion itself.
        model.opt.disableflags = mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
        data.qpos[:], data.qvel[:], data.qacc[:] = motion["qpos"], motion["qvel"], motion["qacc"]
        mujoco.mj_inverse(model, data)
        mass = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, mass, data.qM) if hasattr(data, "qM") else mujoco.mj_fullM(model, data, mass)
        answers.append({
            "open": float(open_by),
            "moves": float(moves_by),
            "mass_matrix": (columns.T @ mass @ columns).ravel().tolist(),
            "torque": (columns.T @ data.qfrc_inverse).tolist(),
            # They read what holds the machine; what it does to the base is the opposite.
            "force": (-data.sensor("base force").data[:2]).tolist(),
            "moment": -float(data.sensor("base moment").data[2]),
            "end_effector": data.sensor("end effector").data[:2].tolist(),
        })
    print(json.dumps(answers), flush=True)
