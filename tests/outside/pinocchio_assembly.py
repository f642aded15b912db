"""What Pinocchio finds of assemblies in motion on standard input, one JSON object a line; answers in the same way."""

import json
import sys
import xml.etree.ElementTree as xml

import numpy as np
import pinocchio as pin

for line in sys.stdin:
    asked = json.loads(line)
    robot = xml.fromstring(asked["model"])
    model = pin.buildModelFromXML(asked["model"])
    model.gravity.linear = np.array(asked["gravity"])
    data = model.createData()
    motors = asked["motors"]
    turns, moving = np.zeros((model.nv, len(motors))), 0
    for joint in robot.findall("joint"):
        if joint.get("type") in ("fixed", "floating"):
            continue
        mimic = joint.find("mimic")
        driver, times = (joint.get("name"), 1.0) if mimic is None else (mimic.get("joint"), float(mimic.get("multiplier")))
        turns[model.joints[model.getJointId(joint.get("name"))].idx_v, motors.index(driver)] = times
        moving += 1
    floats = model.existJointName("base_floats")
    assert moving + (6 if floats else 0) == model.nv
    answers = []
    for motion in asked["motions"]:
        angles, v, a = (turns @ np.array(motion[key]) for key in ("q", "qd", "qdd"))
        if floats:
            v[:6] = motion["base"]
        q = pin.integrate(model, pin.neutral(model), angles)
        pin.framesForwardKinematics(model, data, q)
        torque = pin.rnea(model, data, q, v, a)
        roots = [i for i in range(1, model.njoints) if model.parents[i] == 0]
        held = sum((data.oMi[i].act(data.f[i]) for i in roots), pin.Force.Zero())
        # What never moves is part of the world, and only weighs.
        still = model.inertias[0]
        weight = still.mass * model.gravity.linear
        held -= pin.Force(weight, np.cross(still.lever, weight))
        momentum = pin.computeCentroidalMomentum(model, data, q, v)
        ends = [data.oMf[model.getFrameId(f"{block}/end_effector")].translation.tolist() for block in asked["blocks"]]
        answers.append({
            "mass": float(sum(body.mass for body in model.inertias)),
            "torque": (turns.T @ torque).tolist(),
            # What holds the blocks; what they do to the base is the opposite.
            "force": (-held.linear).tolist(),
            "moment": (-held.angular).tolist(),
            "tips": ends,
            "linear": momentum.linear.tolist(),
            "angular": momentum.angular.tolist(),
        })
    print(json.dumps(answers), flush=True)
