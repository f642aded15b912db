"""What Pinocchio finds of the models and motions on standard input, one JSON object a line; answers in the same way.

It opens a model as a tree in which all joints are free; how they follow the driven ones is read from the file here. Where
it is asked to, it opens it again with followers that it knows by itself.
"""

import json
import sys
import xml.etree.ElementTree as xml

import numpy as np
import pinocchio as pin


def followed(robot):
    """For each joint that turns: the joint it follows, and how often it turns for one turn of that."""
    joints = {}
    for joint in robot.findall("joint"):
        if joint.get("type") != "fixed":
            mimic = joint.find("mimic")
            own = (joint.get("name"), 1.0, 0.0)
            read = lambda: (mimic.get("joint"), float(mimic.get("multiplier", 1)), float(mimic.get("offset", 0)))
            joints[joint.get("name")] = own if mimic is None else read()
    return joints


for line in sys.stdin:
    asked = json.loads(line)
    robot = xml.fromstring(asked["model"])
    model = pin.buildModelFromXML(asked["model"])
    model.gravity.linear = np.array(asked["gravity"] + [0.0])
    data = model.createData()
    joints = followed(robot)
    motors = asked["motors"]
    turns = np.zeros((model.nv, len(motors)))
    shift = np.zeros(model.nv)
    for name, (driver, multiplier, offset) in joints.items():
        row = model.joints[model.getJointId(name)].idx_v
        turns[row, motors.index(driver)] = multiplier
        shift[row] = offset
    assert len(joints) == model.nv
    # Angles of the motors from those of the drives.
    turns = turns @ np.array(asked["motors_from_drives"])
    knows = None
    if asked["knows_followers"]:
        knows = pin.buildModelFromXML(asked["model"], mimic=True)
        places = [knows.joints[knows.getJointId(name)].idx_v for name in motors]
        assert knows.nv == len(motors)
    answers = []
    for motion in asked["motions"]:
        angles = turns @ np.array(motion["q"]) + shift
        q = pin.integrate(model, pin.neutral(model), angles)
        v, a = turns @ np.array(motion["qd"]), turns @ np.array(motion["qdd"])
        mass = pin.crba(model, data, q)
        mass = np.triu(mass) + np.triu(mass, 1).T
        reduced = None
        if knows is not None:
            from_drives = np.array(asked["motors_from_drives"])
            own = np.zeros(knows.nv)
            own[places] = from_drives @ np.array(motion["q"])
            # With data of its own: what it adds up for followers is kept from call to call.
            own = pin.crba(knows, knows.createData(), pin.integrate(knows, pin.neutral(knows), own))
            own = (np.triu(own) + np.triu(own, 1).T)[np.ix_(places, places)]
            reduced = (from_drives.T @ own @ from_drives).ravel().tolist()
        weight = pin.computeGeneralizedGravity(model, data, q)
        com = pin.centerOfMass(model, data, q)
        torque = pin.rnea(model, data, q, v, a)
        roots = [i for i in range(1, model.njoints) if model.parents[i] == 0]
        held = sum((data.oMi[i].act(data.f[i]) for i in roots), pin.Force.Zero())
        pin.framesForwardKinematics(model, data, q)
        links = {}
        for link in robot.findall("link"):
            origin = link.find("inertial/origin")
            if origin is not None:
                at = np.array([float(x) for x in origin.get("xyz").split()])
                links[link.get("name")] = data.oMf[model.getFrameId(link.get("name"))].act(at)[:2].tolist()
        answers.append({
            "mass_matrix": (turns.T @ mass @ turns).ravel().tolist(),
            "reduced": reduced,
            "weight": (turns.T @ weight).tolist(),
            "torque": (turns.T @ torque).tolist(),
            "com": com[:2].tolist(),
            "mass": float(sum(body.mass for body in model.inertias)),
            # What holds the machine; what it does to the base is the opposite.
            "force": (-held.linear[:2]).tolist(),
            "moment": -float(held.angular[2]),
            "links": links,
            "end_effector": data.oMf[model.getFrameId(asked["end"])].translation[:2].tolist(),
        })
    print(json.dumps(answers), flush=True)
