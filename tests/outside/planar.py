"""Random planar MJCF as others write it, and what MuJoCo finds of it.

A line of standard input is a seed, an answer one JSON object: the model, and for some states of motion its mass matrix,
forces, centre of mass and end effector in the coordinates u of the hinges that motors turn. Styles differ: classes, units,
orientations, shapes or inertias, with and without names, keyframes, loops, couplings and rotors.
"""

import json
import random
import sys

import mujoco
import numpy as np


def text(values):
    return " ".join(repr(float(x)) for x in np.atleast_1d(values))


def quat_of(matrix):
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, np.asarray(matrix, float).ravel())
    return quat


class Writer:
    def __init__(self, seed):
        self.r = random.Random(seed)
        self.is_radian = self.r.random() < 0.5
        self.sequence = self.r.choice(["xyz", "zyx", "XYZ", "zxz", "yZx"])
        self.weighing = self.r.choice(["auto", "auto", "auto", "true", "false"])
        self.classes = self.r.random() < 0.6
        self.lines = []
        self.count = 0
        # Hinges in order: name, body, how it turns with u, its angle as drawn, its angle now, range, sign of its axis.
        self.hinges = []
        self.equalities, self.actuators, self.tendons = [], [], []
        self.limits = []

    def unit(self, angle):
        return angle if self.is_radian else np.degrees(angle)

    def turn(self, angle):
        """An attribute that turns about z."""
        c, s = np.cos(angle), np.sin(angle)
        kind = self.r.choice(["quat", "euler", "axisangle", "xyaxes"])
        if kind == "quat":
            return f'quat="{text([np.cos(angle / 2), 0, 0, np.sin(angle / 2)])}"'
        if kind == "axisangle":
            sign = self.r.choice([-1, 1])
            return f'axisangle="{text([0, 0, 2 * sign, self.unit(sign * angle)])}"'
        if kind == "xyaxes":
            return f'xyaxes="{text([2 * c, 2 * s, 0, 0.3 * c - s, 0.3 * s + c, 0])}"'
        angles = [self.unit(angle) if axis in "zZ" and i == self.sequence.lower().index("z") else 0.0
                  for i, axis in enumerate(self.sequence)]
        return f'euler="{text(angles)}"'

    def any_turn(self):
        """An attribute that turns anyhow."""
        r = self.r
        kind = r.choice(["quat", "euler", "axisangle", "xyaxes", "zaxis", "none"])
        some = lambda n: [r.uniform(-1, 1) for _ in range(n)]
        if kind == "none":
            return ""
        if kind == "euler":
            return f'euler="{text([self.unit(x) for x in some(3)])}"'
        if kind == "axisangle":
            return f'axisangle="{text(some(3) + [self.unit(r.uniform(-3, 3))])}"'
        return f'{kind}="{text(some({"quat": 4, "xyaxes": 6, "zaxis": 3}[kind]))}"'

    def shape(self):
        r = self.r
        kind = r.choice(["sphere", "capsule", "cylinder", "box", "ellipsoid"])
        size = {"sphere": 1, "capsule": 2, "cylinder": 2}.get(kind, 3)
        sizes = [r.uniform(0.01, 0.08) for _ in range(size)]
        where = f'pos="{text([r.uniform(-0.1, 0.3), r.uniform(-0.1, 0.1), r.uniform(-0.05, 0.05)])}" {self.any_turn()}'
        if size > 1 and r.random() < 0.5:
            sizes = sizes[:1]
            ends = [r.uniform(-0.1, 0.0), 0, 0, r.uniform(0.1, 0.4), r.uniform(-0.05, 0.05), r.uniform(-0.02, 0.02)]
            where = f'fromto="{text(ends)}"'
        weight = r.choice(["", f'density="{r.uniform(200, 8000)}"', f'mass="{r.uniform(0.1, 2)}"'])
        group = r.choice(["", "", "", 'group="2"', 'group="5"'])
        name = "" if self.classes and kind == "capsule" and r.random() < 0.5 else f'type="{kind}"'
        own = ""
        if not name:
            own = 'class="round"'
        elif self.classes and r.random() < 0.3:
            own = 'class="heavy"'
        return f"<geom {name} {own} size=\"{text(sizes)}\" {where} {weight} {group}/>"

    def inertial(self):
        r = self.r
        at = f'pos="{text([r.uniform(-0.2, 0.3), r.uniform(-0.1, 0.1), r.uniform(-0.05, 0.05)])}" mass="{r.uniform(0.1, 4)}"'
        # Of a body that there can be: sums of squares.
        squares = [r.uniform(0.002, 0.02) for _ in range(3)]
        principal = [sum(squares) - square for square in squares]
        if r.random() < 0.7:
            return f'<inertial {at} {self.any_turn()} diaginertia="{text(principal)}"/>'
        axes, _ = np.linalg.qr(np.array([[r.uniform(-1, 1) for _ in range(3)] for _ in range(3)]))
        full = axes @ np.diag(principal) @ axes.T
        return f'<inertial {at} fullinertia="{text(full[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]])}"/>'

    def mass(self):
        """Lines that give a body its mass."""
        r = self.r
        shapes = [self.shape() for _ in range(r.randint(1, 3))]
        if self.weighing == "false":
            return [self.inertial()] + shapes[1:]
        if self.weighing == "auto" and r.random() < 0.4:
            return [self.inertial()] + shapes[1:]
        if self.weighing == "true" and r.random() < 0.3:
            shapes.append(self.inertial())
        if r.random() < 0.2:
            shapes.append(f'<body pos="{text([r.uniform(-0.2, 0.2), 0.02, 0.01])}" {self.turn(r.uniform(-3, 3))}>{self.shape()}</body>')
        return shapes

    def link(self, parent, at, rate, drawn=None, coupled=None, extra=""):
        """A body with one hinge; `rate`: how its hinge turns with u. Gives its number; the caller closes it."""
        r = self.r
        self.count += 1
        name = f"part {self.count}"
        joint = f"j{self.count}"
        drawn = r.uniform(-2, 2) if drawn is None else drawn
        sign = r.choice([-1, 1]) if coupled is None else 1
        ref = r.uniform(-1, 1) if r.random() < 0.2 and coupled is None else 0.0
        body = f'name="{name}"' if r.random() < 0.7 else ""
        child = r.choice(["", "", 'childclass="arm"', 'childclass="plain"']) if self.classes else ""
        self.lines.append(f'<body {body} {child} pos="{text([at, 0, r.uniform(-0.05, 0.05)])}" {self.turn(drawn)}>')
        axis = "" if sign > 0 and r.random() < 0.5 else f'axis="{text([0, 0, 2.0 * sign])}"'
        kind = r.choice(["", 'type="hinge"'])
        self.lines.append(f'<joint name="{joint}" {kind} {axis} {f"ref={chr(34)}{self.unit(ref)}{chr(34)}" if ref else ""} {extra}/>')
        self.hinges.append(dict(name=joint, rate=np.array(rate, float) * sign, ref=ref, sign=sign, parent=parent))
        self.lines.extend(self.mass())
        return len(self.hinges) - 1

    def close(self):
        self.lines.append("</body>")


def serial(w, n):
    """Chain with a motor in each hinge, some with rotors."""
    r = w.r
    at = 0.0
    where = None
    parent = None
    rotors = []
    for k in range(n):
        rate = np.eye(n)[k]
        low, high = sorted([r.uniform(-4, 4), r.uniform(-4, 4)])
        limited = r.random() < 0.5
        extra = f'range="{text([w.unit(low), w.unit(high)])}"' if limited else ""
        if limited and r.random() < 0.3:
            extra += ' limited="true"'
        if r.random() < 0.3:
            # A rotor before its link, on what carries it.
            ratio = r.choice([-1, 1]) * r.uniform(5, 60)
            rotors.append((f"rotor{k}", k, ratio, at))
            w.lines.append(f'<body name="rotor{k}" pos="{text([at, 0, 0])}"><joint name="rotor{k}" axis="0 0 1"/>'
                           f'<inertial pos="0 0 0.01" mass="0.05" diaginertia="2e-5 2e-5 3e-5"/><geom type="sphere" size="0.01" mass="0"/></body>')
            w.hinges.append(dict(name=f"rotor{k}", rate=None, ref=0.0, sign=1, parent=parent, rotor=(k, ratio)))
        own = w.link(parent, at, rate, extra=extra)
        if limited and k:
            w.limits.append((own, low, high, k, k - 1))
        if rotors and rotors[-1][1] == k:
            # Of the hinge as it counts.
            w.equalities.append(f'<joint joint1="rotor{k}" joint2="{w.hinges[own]["name"]}" polycoef="0 {rotors[-1][2] * w.hinges[own]["sign"]} 0 0 0"/>')
            w.hinges[own - 1]["rate"] = rotors[-1][2] * np.eye(n)[k]
        w.hinges[own]["drive"] = k
        parent = own
        at = r.choice([-1, 1, 1]) * r.uniform(0.1, 0.5)
        where = at
    end(w, where, close=n)
    actuators(w, n)


def end(w, at, close, only=True):
    names = ["end_effector", "end effector", "ee", "ee_site", "tool0", "TCP", "attachment_site"]
    name = w.r.choice(names + ["marker"] * only)
    w.lines.append(f'<site name="{name}" pos="{text([at, 0, 0.02])}"/>')
    for _ in range(close):
        w.close()


def actuators(w, n):
    r = w.r
    for k in range(n):
        hinge = next(h for h in w.hinges if h.get("drive") == k)
        kind = r.choice(["motor", "motor", "position", "velocity", "general"])
        name = f'name="m{k}"' if r.random() < 0.3 else ""
        gear = r.choice(["", 'gear="2"', 'gear="-3 0 0 0 0 0"'])
        times = {"": 1, 'gear="2"': 2}.get(gear, 3)
        limits, torque = "", None
        if kind == "motor" and r.random() < 0.6:
            most = r.uniform(1, 50)
            limits, torque = f'ctrlrange="{text([-most, most])}"', times * most
        elif r.random() < 0.4:
            most = r.uniform(1, 50)
            limits, torque = f'forcerange="{text([-most / 2, most])}"', times * most
        own = ""
        if w.classes and r.random() < 0.3:
            # Whose range of control is no limit.
            own = 'class="arm"'
            if "ctrlrange" in limits:
                torque = None
        hinge["torque"] = torque
        w.actuators.append(f'<{kind} {own} {name} joint="{hinge["name"]}" {gear} {limits}/>')


def kept(w):
    """An upper arm and links that couplings keep parallel."""
    r = w.r
    upper = w.link(None, 0.0, [1, 0])
    w.hinges[upper]["drive"] = 0
    a, b, side = r.uniform(0.1, 0.3), r.uniform(0.35, 0.6), r.choice([-1, 1])
    drawn = r.uniform(-2, 2)
    first = w.link(upper, a, [0, 1], drawn, extra='range="-3 3"' if w.is_radian else 'range="-170 170"')
    w.hinges[first]["drive"] = 1
    most = 3.0 if w.is_radian else np.radians(170.0)
    w.limits.append((first, -most, most, 1, 0))
    length = r.uniform(0.2, 0.5)
    # On its tip a bar that keeps to the upper arm: it turns back by as much, and is drawn so.
    back = w.link(first, length, [0, -1], -drawn, coupled=True)
    sign = w.hinges[first]["sign"]
    w.equalities.append(coupling(w, back, first, -sign))
    w.close()
    w.close()
    second = w.link(upper, b, [0, 1], drawn, coupled=True)
    w.equalities.append(coupling(w, second, first, sign))
    w.lines.append(f'<site name="ee" pos="{text([r.uniform(0.2, 0.5), 0, 0])}"/>')
    w.close()
    w.close()
    actuators(w, 2)


def coupling(w, one, other, ratio):
    """Either of them first."""
    a, b = w.hinges[one]["name"], w.hinges[other]["name"]
    if abs(ratio) == 1 and w.r.random() < 0.5:
        a, b = b, a
    active = w.r.choice(["", 'active="true"', 'name="keep%d"' % one])
    if ratio == 1 and w.r.random() < 0.5:
        return f'<joint {active} joint1="{a}" joint2="{b}"/>'
    return f'<joint {active} joint1="{a}" joint2="{b}" polycoef="0 {float(ratio)} 0 0 0"/>'


def loop(w):
    """A parallelogram of four bars on two motors of the base."""
    r = w.r
    a, b = r.uniform(0.15, 0.4), r.uniform(0.45, 0.7)
    angles = r.uniform(-2, 2), 0.0
    angles = angles[0], angles[0] + r.choice([-1, 1]) * r.uniform(0.6, 2.4)

    def bar(drive, rate, at, turned, parent):
        w.count += 1
        name = f"bar{w.count}"
        w.lines.append(f'<body name="{name}" pos="{text([at, 0, 0])}" {w.turn(turned)}>')
        w.lines.append(f'<joint name="j{w.count}" pos="0 0 0"/>')
        w.hinges.append(dict(name=f"j{w.count}", rate=np.array(rate, float), ref=0.0, sign=1, parent=parent, drive=drive))
        w.lines.extend(w.mass())
        return name, len(w.hinges) - 1

    one, i = bar(0, [1, 0], 0.0, angles[0], None)
    three, _ = bar(None, [-1, 1], a, angles[1] - angles[0], i)
    w.lines.append(f'<site name="p" pos="{text([b, 0, 0])}"/>')
    end(w, b + r.uniform(0.1, 0.4), 2, only=False)
    two, j = bar(1, [0, 1], 0.0, angles[1], None)
    four, _ = bar(None, [1, -1], b, angles[0] - angles[1], j)
    w.lines.append(f'<site name="q" pos="{text([a, 0, 0])}"/>')
    w.close()
    w.close()
    if r.random() < 0.5:
        w.equalities.append('<connect site1="p" site2="q"/>')
    else:
        w.equalities.append(f'<connect body1="{three}" body2="{four}" anchor="{text([b, 0, 0])}"/>')
    actuators(w, 2)


def model(seed):
    w = Writer(seed)
    r = w.r
    kind = r.choice(["serial", "serial", "serial", "kept", "kept", "loop"])
    n = r.randint(1, 6) if kind == "serial" else 2
    if kind == "serial":
        serial(w, n)
    else:
        {"kept": kept, "loop": loop}[kind](w)
    # The plane of motion somewhere in space.
    axes = np.eye(3)
    if r.random() < 0.5:
        axes, _ = np.linalg.qr(np.array([[r.gauss(0, 1) for _ in range(3)] for _ in range(3)]))
        axes[:, 2] *= np.sign(np.linalg.det(axes))
    elif r.random() < 0.3:
        axes = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    mount = [r.uniform(-1, 1) for _ in range(3)]
    head = ['<mujoco model="planar">']
    compiler = f'<compiler angle="{"radian" if w.is_radian else "degree"}" eulerseq="{w.sequence}" inertiafromgeom="{w.weighing}"'
    if w.is_radian is False and r.random() < 0.5:
        compiler = compiler.replace('angle="degree" ', "")
    if r.random() < 0.2:
        compiler += ' inertiagrouprange="0 3"' if w.weighing != "true" else ""
    if r.random() < 0.1:
        compiler += ' boundmass="0.3" boundinertia="0.01"'
    head.append(compiler + "/>")
    head.append(f'<option gravity="{text([r.uniform(-9, 9) for _ in range(3)])}"/>' if r.random() < 0.8 else "<option/>")
    if w.classes:
        head.append('<default><geom rgba="1 0 0 1" density="2700"/><joint damping="0.1"/><default class="plain"><geom density="900"/>'
                    '<default class="arm"><joint axis="0 0 1"/><geom type="capsule"/><motor ctrllimited="false"/>'
                    '<default class="round"><geom type="capsule" size="0.02 0.12"/></default></default></default>'
                    '<default class="heavy"><geom density="7800"/></default></default>')
    head.append('<worldbody><light pos="0 0 3"/><geom type="plane" size="1 1 0.1"/>')
    head.append(f'<body name="mount" pos="{text(mount)}" quat="{text(quat_of(axes))}"><geom type="box" size="0.05 0.05 0.05"/>')
    tail = ["</body></worldbody>"]
    if w.tendons:
        tail.append("<tendon>" + "".join(w.tendons) + "</tendon>")
    if w.equalities:
        tail.append("<equality>" + "".join(w.equalities) + "</equality>")
    tail.append("<actuator>" + "".join(w.actuators) + "</actuator>")
    # The pose of the file.
    rates = np.array([h["rate"] for h in w.hinges])
    refs = np.array([h["ref"] for h in w.hinges])
    now = np.zeros(n)
    if r.random() < 0.5:
        now = np.array([r.uniform(-1.5, 1.5) for _ in range(n)])
        if kind == "loop":
            now *= 0.2
        tail.append(f'<keyframe><key name="home" qpos="{text(refs + rates @ now)}"/></keyframe>')
    tail.append("</mujoco>")
    return w, kind, n, axes, mount, now, rates, refs, "\n".join(head + w.lines + tail)


def planar(axis):
    """Axes of the plane, by the rule of the program: the normal points up as far as there is such."""
    first = next((x for x in axis[::-1] if abs(x) > 0.5), 1.0)
    normal = axis if first > 0 else -axis
    x = np.eye(3)[0] if abs(normal[0]) < 0.9 else np.eye(3)[1]
    x = x - normal * (normal @ x)
    x /= np.linalg.norm(x)
    return x, np.cross(normal, x), normal


for line in sys.stdin:
    seed = json.loads(line)
    w, kind, n, axes, mount, now, rates, refs, xml = model(seed)
    try:
        compiled = mujoco.MjModel.from_xml_string(xml)
    except ValueError as why:
        print(json.dumps({"refused": str(why), "model": xml}), flush=True)
        continue
    data = mujoco.MjData(compiled)
    x, y, normal = planar(axes[:, 2])
    side = np.sign(normal @ axes[:, 2])
    # Absolute rates of bodies about the common axis.
    turned = []
    for h in w.hinges:
        carried = turned[h["parent"]] if h["parent"] is not None else np.zeros(n)
        turned.append(carried + h["sign"] * h["rate"])
    drives = [next(i for i, h in enumerate(w.hinges) if h.get("drive") == k) for k in range(n)]
    to_drives = side * np.array([turned[i] for i in drives])
    noise = np.random.default_rng(seed)
    states = []
    compiled.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    compiled.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_PASSIVE if hasattr(mujoco.mjtDisableBit, "mjDSBL_PASSIVE") else 0
    compiled.dof_damping[:] = 0
    # What a rotor on the base weighs belongs to the base.
    moving = [b for b in range(compiled.nbody) if compiled.body_weldid[b] != 0 and compiled.body(b).name != "rotor0"]
    site = next(i for i in range(compiled.nsite) if compiled.site(i).name not in ("p", "q"))
    for _ in range(4):
        u, ud, udd = now + noise.uniform(-2, 2, n), noise.uniform(-3, 3, n), noise.uniform(-9, 9, n)
        data.qpos[:], data.qvel[:], data.qacc[:] = refs + rates @ u, rates @ ud, rates @ udd
        mujoco.mj_inverse(compiled, data)
        mass = np.zeros((compiled.nv, compiled.nv))
        try:
            mujoco.mj_fullM(compiled, data, mass)
        except TypeError:
            mujoco.mj_fullM(compiled, mass, data.qM)
        weight = compiled.body_mass[moving].sum()
        com = (compiled.body_mass[moving][:, None] * data.xipos[moving]).sum(axis=0) / weight
        flat = lambda p: [float(x @ (p - origin)), float(y @ (p - origin))]
        first = next(b for b in range(compiled.nbody) if compiled.body_jntnum[b])
        origin = data.xanchor[compiled.body_jntadr[first]].copy()
        states.append({
            "q": (to_drives @ (u - now)).tolist(),
            "qd": (to_drives @ ud).tolist(),
            "qdd": (to_drives @ udd).tolist(),
            "mass_matrix": (rates.T @ mass @ rates).ravel().tolist(),
            "torque": (rates.T @ data.qfrc_inverse).tolist(),
            "com": flat(com),
            "end_effector": flat(data.site_xpos[site]),
            "limited": [float(side * w.hinges[i]["sign"] * data.qpos[i]) for i, *_ in w.limits],
        })
    limits = []
    for i, low, high, to, base in w.limits:
        s = side * w.hinges[i]["sign"]
        limits.append({"to": to, "from": base, "range": [low, high] if s > 0 else [-high, -low]})
    print(json.dumps({
        "model": xml,
        "kind": kind,
        "to_drives": to_drives.tolist(),
        "mass": float(compiled.body_mass[moving].sum()),
        "torque_limits": [w.hinges[i]["torque"] for i in drives],
        "limits": limits,
        "states": states,
    }), flush=True)
