"""A machine file in NumPy, from the file's own words: arms, inertias, conditions (7) and (8), D_k, relative angles."""

import json
import sys
import tomllib

import numpy as np


def resolved(spec, length):
    """A length, m, from a number or a name."""
    if not isinstance(length, str):
        return float(length)
    sign, name = (-1.0, length[1:]) if length.startswith("-") else (1.0, length)
    return sign * spec["lengths"][name]


def gyration(weight):
    """Inertia of a counterweight about its centre of mass per mass, m^2, by areas of half planes of rings and boxes."""
    r, a = weight.get("radius", 0.0), weight.get("inner_radius", 0.0)
    if weight.get("length", 0.0) > 0:
        return (weight["length"] ** 2 + weight["width"] ** 2) / 12
    if not weight.get("half", False):
        return (r**2 + a**2) / 2
    area, first, polar = np.pi * (r**2 - a**2) / 2, 2 * (r**3 - a**3) / 3, np.pi * (r**4 - a**4) / 4
    return polar / area - (first / area) ** 2


class Machine:
    def __init__(self, text):
        self.spec = spec = tomllib.loads(text)
        self.drives = [drive["name"] for drive in spec["drive"]]
        self.n = len(self.drives)
        self.names = [link["name"] for link in spec["link"]]
        self.of = [self.drives.index(link["drive"]) for link in spec["link"]]
        self.sign = [float(link.get("direction", 1)) for link in spec["link"]]
        self.length = [resolved(spec, link["length"]) for link in spec["link"]]
        # Roots of links as sums of arms along the drives.
        self.roots = {}
        while len(self.roots) < len(self.names):
            for j, link in enumerate(spec["link"]):
                on = link["attach"]
                if on == "base":
                    self.roots[j] = np.zeros(self.n)
                elif self.names.index(on["link"]) in self.roots:
                    self.roots[j] = self.point(on)
        self.tip = self.point(spec["end_effector"])
        self.end = self.names.index(spec["end_effector"]["link"])

    def place(self, point):
        """Where a point is on its link, m from the root."""
        j, at = self.names.index(point["link"]), point.get("at", "tip")
        return self.length[j] if at == "tip" else 0.0 if at == "root" else resolved(self.spec, at)

    def point(self, point):
        j = self.names.index(point["link"])
        return self.on(j, self.place(point))

    def on(self, j, along):
        arms = self.roots[j].astype(complex if isinstance(along, complex) else float)
        arms[self.of[j]] += self.sign[j] * along
        return arms

    def pins(self, j):
        points = [link["attach"] for link in self.spec["link"] if link["attach"] != "base"]
        points += [end for closure in self.spec.get("closure", []) for end in (closure["a"], closure["b"])]
        return sorted({0.0} | {self.place(point) for point in points if point["link"] == self.names[j]})

    def weights(self):
        return self.spec.get("counterweight", [])

    def bodies(self, payload=None, weights=None):
        """Mass, inertia about the centre of mass, arms of that, and drive of each body."""
        for j, link in enumerate(self.spec["link"]):
            com = complex(link["com"], link.get("com_normal", 0.0))
            yield link["mass"], link["inertia"], self.on(j, com), self.of[j]
        for weight in self.weights() if weights is None else weights:
            j, mass = self.names.index(weight["link"]), weight["mass"]
            yield mass, mass * gyration(weight), self.on(j, complex(weight["at"], weight.get("across", 0.0))), self.of[j]
        held = self.spec.get("payload", {})
        mass = held.get("mass", 0.0) if payload is None else payload
        arms = self.tip.astype(complex)
        arms[self.of[self.end]] += self.sign[self.end] * complex(*held.get("offset", [0.0, 0.0]))
        yield mass, held.get("inertia", 0.0), arms, self.of[self.end]

    def conditions(self, payload=None, weights=None):
        """The first moments g_k, kg m, and the couplings C_kl, kg m², that balance makes zero."""
        g, c = np.zeros(self.n, complex), np.zeros((self.n, self.n), complex)
        for mass, _, arms, _ in self.bodies(payload, weights):
            g += mass * arms
            c += mass * np.outer(arms.conj(), arms)
        return g, c[np.triu_indices(self.n, 1)]

    def rotors(self):
        """Inertia of each rotor, and its rate for each rate of the drives."""
        for k, drive in enumerate(self.spec["drive"]):
            if "rotor" in drive:
                yield drive["rotor"]["inertia"], self.turned(k, drive["rotor"].get("ratio", 1.0))

    def turned(self, k, ratio):
        rates, on = np.zeros(self.n), self.spec["drive"][k].get("on")
        rates[k] = ratio
        if on is not None:
            rates[self.drives.index(on)] = 1.0 - ratio
        return rates

    def diagonal(self, weights=None):
        """H_kk of bodies alone, kg m²."""
        h = np.zeros(self.n)
        for mass, inertia, arms, drive in self.bodies(weights=weights):
            h += mass * abs(arms) ** 2
            h[drive] += inertia
        return h

    def inertia(self):
        """H of a balanced machine."""
        h = np.diag(self.diagonal())
        for inertia, rates in self.rotors():
            h += inertia * np.outer(rates, rates)
        return h

    def momenta(self):
        """The momentum D_k about the base for a unit rate of each drive, of a balanced machine."""
        return self.diagonal() + sum((inertia * rates for inertia, rates in self.rotors()), np.zeros(self.n))

    def torques(self):
        """Torques of the motors for accelerations of the drives of a balanced machine."""
        motors = np.eye(self.n)
        for k, drive in enumerate(self.spec["drive"]):
            if "on" in drive:
                motors[k, self.drives.index(drive["on"])] = -1.0
        return np.linalg.solve(motors.T, self.inertia())


class Arm:
    """Poses of one b, by relative angles: q = base + lift a."""

    def __init__(self, machine, b):
        self.machine, self.tip, angles = machine, machine.tip, machine.spec["angle"]
        d = machine.momenta()
        self.rates = d / d[0]
        rows, side = [], []
        for angle in angles:
            row = np.zeros(machine.n)
            row[machine.drives.index(angle["to"])], row[machine.drives.index(angle["from"])] = 1.0, -1.0
            rows.append(row)
            side.append(-angle.get("offset", 0.0))
        self.rows, self.offset = np.array(rows), -np.array(side)
        inverse = np.linalg.inv(np.vstack([self.rows, self.rates]))
        self.lift, self.base = inverse[:, :-1], inverse @ np.append(side, b)
        self.low = np.array([angle.get("min", -np.inf) for angle in angles])
        self.high = np.array([angle.get("max", np.inf) for angle in angles])
        self.reach = abs(self.tip).sum()

    def q(self, a):
        return self.base + a @ self.lift.T

    def a(self, q):
        return q @ self.rows.T + self.offset

    def p(self, a):
        return np.exp(1j * self.q(a)) @ self.tip

    def dp(self, a):
        """dp/da."""
        return (1j * self.tip * np.exp(1j * self.q(a))) @ self.lift

    def poses(self, random, p, count):
        """Random poses at a point within limits."""
        a = random.uniform(self.low, self.high, (count, len(self.low)))
        for _ in range(30):
            gap, d = p - self.p(a), self.dp(a)
            j = np.stack([d.real, d.imag], 1)
            square = j @ j.transpose(0, 2, 1) + 1e-12 * self.reach**2 * np.eye(2)
            step = np.stack([gap.real, gap.imag], 1)[..., None]
            step = (j.transpose(0, 2, 1) @ np.linalg.solve(square, step))[..., 0]
            a = np.clip(a + np.clip(step, -0.5, 0.5), self.low - 0.5, self.high + 0.5)
        within = (abs(self.p(a) - p) < 1e-9 * self.reach) & (a >= self.low).all(1) & (a <= self.high).all(1)
        return a[within]
