

"""Bounds of what counterweights come to: from below by HiGHS over tangents of all that is convex, from above by SLSQP.

With clearance, every choice between pins is a program of its own. Off the axis a clearance is left out from below, and
kept from above.
"""

import itertools

from scipy.optimize import linprog, minimize


class Stock:
    """What a mass of it weighs about its own centre, and how far it reaches, as functions of w; complex w for slopes."""

    def __init__(self, stock):
        self.kind, self.size, self.by = stock["kind"], stock["size"], stock["area_per_mass"]

    def sizes(self, w):
        """Outer radius, and distance of the centre of mass from that of the circles; half length and half width of a box."""
        area, a = w * self.by, self.size
        if self.kind == "box":
            return 0.5 * area / a, 0.5 * a
        if self.kind == "half-ring":
            r = np.sqrt(a**2 + 2 * area / np.pi)
            return r, 2 * (r**3 - a**3) / 3 / area
        return np.sqrt(a**2 + area / np.pi), 0.0

    def own(self, w):
        w = w + 1e-13
        (r, c), a = self.sizes(w), self.size
        if self.kind == "box":
            return w * (r**2 + c**2) / 3
        if self.kind == "half-ring":
            return (np.pi / 4 * (r**4 - a**4) - 2 * (r**3 - a**3) / 3 * c) / self.by
        return w * (r**2 + a**2) / 2

    def reach(self, w):
        """From the centre of mass to the flat side, to the round side, and across."""
        r, c = self.sizes(w + 1e-13)
        return {"box": (r, r, c), "half-ring": (c, r - c, r)}.get(self.kind, (r, r, r))

    def spans(self, w):
        flat, round_, _ = self.reach(w)
        return flat * w, round_ * w

    @staticmethod
    def slope(f, w):
        return f(max(w, 0.0) + 1e-30j).imag / 1e-30

    def bore(self):
        return self.size if self.kind in ("ring", "half-ring") else 0.0

    def choices(self, pins, gap):
        """Lists of rows for a counterweight on its axis: (sign, pin, side of the counterweight), or a pin in the bore."""
        flat, round_ = 0, 1
        between = lambda i, j: [(1, pins[i - 1]) if i else None, (-1, pins[j]) if j < len(pins) else None]
        if self.kind != "half-ring":
            all = [[(n, pin, round_) for n, pin in filter(None, between(i, i))] for i in range(len(pins) + 1)]
            if self.bore() > gap and self.kind == "ring":
                for i, j in itertools.combinations(range(len(pins) + 1), 2):
                    all.append([(n, pin, round_) for n, pin in filter(None, between(i, j))]
                               + [(0, pins[i], None), (0, pins[j - 1], None)])
            return all
        # A pin nearer to the root lies on the flat side of a half ring towards the tip, and the other way round.
        return [[(n, pin, flat if n == side else round_) for n, pin in filter(None, between(i, i))] + [(side, None, None)]
                for side in (-1, 1) for i in range(len(pins) + 1)]

    def missed(self, w, x, y, pin, gap):
        """By how much a pin is not clear, m."""
        flat, round_, wide = self.reach(w)
        bore = self.bore()
        if self.kind in ("disc", "ring"):
            away = np.hypot(pin - x, y)
            return min(gap + wide - away, gap + away - bore if bore else np.inf)
        out = (pin - x) * (1 if x >= 0 else -1)
        return min(flat - (bore if y == 0 else 0.0) + gap + out, round_ + gap - out, wide + gap - abs(y))


class Asked:
    def __init__(self, asked):
        self.__dict__.update(asked)
        self.machine = machine = Machine(asked["machine"])
        self.n, self.count = machine.n, len(self.sites)
        spec = machine.spec
        fixed = [weight for weight in machine.weights() if weight.get("fixed")]
        spec["counterweight"] = fixed
        self.free = {rotor["drive"]: spec["drive"][rotor["drive"]].pop("rotor", {"inertia": 0.0, "ratio": 1.0})
                     for rotor in self.rotors}
        ends = self.payload
        if ends is not None:
            spec.setdefault("payload", {})["mass"] = 0.5 * (ends[0] + ends[1])
        self.stock = Stock(self.stock)
        self.part = [machine.of[site[0]] for site in self.sites]
        self.root = [machine.roots[site[0]] for site in self.sites]
        self.sign = [machine.sign[site[0]] for site in self.sites]
        self.most = [np.inf if site[3] is None else site[3] for site in self.sites]
        self.beside = [site[4] for site in self.sites]
        self.is_beside = any(self.beside)
        # Conditions are linear in mass and first moments of a disc: real parts first, then imaginary ones.
        flat = lambda both: (lambda all: np.concatenate([all.real, all.imag]))(np.concatenate(both))
        self.left = flat(machine.conditions(weights=fixed))
        self.changes = np.zeros((len(self.left), 3 * self.count))
        for j, (link, *_) in enumerate(self.sites):
            with_disc = lambda at, across: flat(machine.conditions(
                weights=fixed + [{"link": machine.names[link], "mass": 1.0, "at": at, "across": across}])) - self.left
            self.changes[:, 3 * j] = with_disc(0.0, 0.0)
            self.changes[:, 3 * j + 1] = with_disc(1.0, 0.0) - with_disc(0.0, 0.0)
            self.changes[:, 3 * j + 2] = with_disc(0.0, 1.0) - with_disc(0.0, 0.0)
        self.ends = [self.left] if ends is None else [flat(machine.conditions(end, fixed)) for end in ends]
        reach = abs(machine.tip).sum()
        half = [1.0] * self.n + [reach] * (len(self.left) // 2 - self.n)
        self.per = np.array(half + half)
        self.h, self.d = machine.diagonal(fixed), machine.momenta() - machine.diagonal()
        self.d = self.d + self.h
        self.h = self.h + sum((i * r * r for i, r in machine.rotors()), np.zeros(self.n))
        self.is_range = ends is not None
        o = self.objective
        self.turns = o["inertia"] + o["momentum"] + o["torque"] > 0 or self.most_inertia is not None

    def turned(self, drive, ratio):
        return self.machine.turned(drive, ratio)

    def moments(self, w, x, y):
        return np.stack([w, w * x, w * y], 1).ravel()

    def measures(self, w, x, y, rotors):
        """Added mass, H_kk and D_k."""
        turned = np.zeros(self.n)
        for j in range(self.count):
            part = w[j] * self.root[j] ** 2
            k = self.part[j]
            part[k] = w[j] * abs(self.root[j][k] + self.sign[j] * complex(x[j], y[j])) ** 2 + self.stock.own(w[j])
            turned = turned + part
        h, d = self.h + turned, self.d + turned
        for rotor, value in zip(self.rotors, rotors):
            present = self.free[rotor["drive"]]
            inertia, ratio = (value, present["ratio"]) if rotor["free"] == "inertia" else (present["inertia"], value)
            rates = self.turned(rotor["drive"], ratio)
            h, d = h + inertia * rates**2, d + inertia * rates
        return w.sum(), h, d

    def value(self, w, x, y, rotors):
        mass, h, d = self.measures(w, x, y, rotors)
        o = self.objective
        torque = max(a * own for a, own in zip(o["accelerations"], h)) if o["torque"] > 0 else 0.0
        return o["mass"] * mass + o["inertia"] * h.sum() + o["momentum"] * abs(d).sum() + o["torque"] * torque

    def rooms(self):
        """For each site the pins between which its disc may be."""
        if self.clearance is None or self.is_beside:
            return [[[]]] * self.count
        return [self.stock.choices(self.machine.pins(site[0]), self.clearance) for site in self.sites]

    def residual(self, w, x, y):
        """The largest residual of (7) and (8), kg m."""
        def largest(end):
            left = (end + self.changes @ self.moments(w, x, y)) / self.per
            return float(np.hypot(*np.split(left, 2)).max())
        return max(largest(end) for end in self.ends)


class Linear:
    """Tangents of what is convex, shared by all choices between pins."""

    def __init__(self, asked):
        self.asked, c, n = asked, asked.count, asked.n
        sizes = {"w": c, "s": c, "b": c, "u": c, "v": c, "z0": c, "z1": c, "x": len(asked.rotors), "t": len(asked.rotors),
                 "d": n, "torque": 1, "worst": 1}
        starts = np.cumsum([0, *sizes.values()])
        self.at = {name: start for name, start in zip(sizes, starts)}
        self.size = starts[-1]
        self.cuts, self.right = [], []
        for j, (_, low, high, _, beside) in enumerate(asked.sites):
            most = min(asked.most[j], 40.0)
            for x in np.linspace(low, high, 9):
                for y in np.linspace(-beside, beside, 5 if beside else 1):
                    self.place(j, x, y)
            for w in np.linspace(0.0, most, 9):
                self.mass(j, w)
        for i, rotor in enumerate(asked.rotors):
            for value in np.linspace(*rotor["ends"], 9):
                self.ratio(i, value)

    def row(self, terms):
        row = np.zeros(self.size)
        for name, i, by in terms:
            row[self.at[name] + i] += by
        return row

    def cut(self, terms, right):
        self.cuts.append(self.row(terms))
        self.right.append(right)

    def place(self, j, x, y):
        # u >= (s^2 + b^2) / w
        self.cut([("s", j, 2 * x), ("b", j, 2 * y), ("w", j, -x * x - y * y), ("u", j, -1)], 0.0)

    def mass(self, j, w):
        # v, z0 and z1 lie above the tangents of what is convex in w.
        stock, w = self.asked.stock, max(w, 0.0)
        bounded = {"v": stock.own, "z0": lambda w: stock.spans(w)[0], "z1": lambda w: stock.spans(w)[1]}
        for name, f in bounded.items():
            slope = stock.slope(f, w)
            self.cut([("w", j, slope), (name, j, -1)], slope * w - f(w).real)

    def ratio(self, i, value):
        rotor = self.asked.rotors[i]
        inertia = self.asked.free[rotor["drive"]]["inertia"] if rotor["free"] == "ratio" else 0.0
        self.cut([("x", i, 2 * inertia * value), ("t", i, -1)], inertia * value * value)

    def turned(self, k):
        """H_kk and D_k, linear but for their constants."""
        asked, h = self.asked, []
        for j in range(asked.count):
            root = asked.root[j][k]
            h.append(("w", j, root * root))
            if asked.part[j] == k:
                h += [("s", j, 2 * asked.sign[j] * root), ("u", j, 1.0), ("v", j, 1.0)]
        d, ends = list(h), [asked.h[k], asked.d[k]]
        for i, rotor in enumerate(asked.rotors):
            present = asked.free[rotor["drive"]]
            if rotor["free"] == "inertia":
                rate = asked.turned(rotor["drive"], present["ratio"])[k]
                h.append(("x", i, rate * rate))
                d.append(("x", i, rate))
            else:
                plain = asked.turned(rotor["drive"], 0.0)[k]
                slope = asked.turned(rotor["drive"], 1.0)[k] - plain
                inertia = present["inertia"]
                h += [("x", i, 2 * plain * slope * inertia), ("t", i, slope * slope)]
                d.append(("x", i, slope * inertia))
                ends = [ends[0] + inertia * plain * plain, ends[1] + inertia * plain]
        return self.row(h), self.row(d), ends

    def program(self, rooms, worst):
        asked, o = self.asked, self.asked.objective
        cost, above, right = np.zeros(self.size), [], []
        most = lambda row, limit: (above.append(row), right.append(limit))
        if worst is None and asked.is_range:
            cost[self.at["worst"]] = 1.0
        else:
            cost += self.row([("w", j, o["mass"]) for j in range(asked.count)])
        total, fixed = np.zeros(self.size), 0.0
        for k in range(asked.n):
            h, d, [of_h, of_d] = self.turned(k)
            total, fixed = total + d, fixed + of_d
            most(d - self.row([("d", k, 1)]), -of_d)
            most(-d - self.row([("d", k, 1)]), of_d)
            if o["torque"] > 0:
                most(o["accelerations"][k] * h - self.row([("torque", 0, 1)]), -o["accelerations"][k] * of_h)
            if worst is not None or not asked.is_range:
                cost += o["inertia"] * h + self.row([("d", k, o["momentum"])])
        if worst is not None or not asked.is_range:
            cost += self.row([("torque", 0, o["torque"])])
        if asked.most_inertia is not None:
            most(total, asked.most_inertia - fixed)
        if asked.most_mass is not None:
            most(self.row([("w", j, 1) for j in range(asked.count)]), asked.most_mass)
        for j, (_, low, high, _, beside) in enumerate(asked.sites):
            most(self.row([("w", j, low), ("s", j, -1)]), 0.0)
            most(self.row([("s", j, 1), ("w", j, -high)]), 0.0)
            most(self.row([("b", j, 1), ("w", j, -beside)]), 0.0)
            most(self.row([("b", j, -1), ("w", j, -beside)]), 0.0)
            gap, bore = asked.clearance or 0.0, asked.stock.bore()
            for sign, pin, side in rooms[j]:
                if pin is None:
                    most(self.row([("s", j, -sign)]), 0.0)
                elif side is None:
                    for sign in (1, -1):
                        most(self.row([("s", j, sign), ("w", j, -sign * pin - bore + gap)]), 0.0)
                else:
                    less = bore if asked.stock.kind == "half-ring" and side == 0 else 0.0
                    most(self.row([("w", j, sign * pin + gap - less), (f"z{side}", j, 1), ("s", j, -sign)]), 0.0)
        sums = np.zeros((len(asked.left), self.size))
        for j in range(asked.count):
            for i, name in enumerate("wsb"):
                sums[:, self.at[name] + j] = asked.changes[:, 3 * j + i]
        equal, side = sums, -asked.left
        if asked.is_range:
            equal, side = None, None
            for end, i, sign in itertools.product(asked.ends, range(len(asked.left)), [1, -1]):
                most(sign * sums[i] - self.row([("worst", 0, asked.per[i])]), -sign * end[i])
            if worst is not None:
                most(self.row([("worst", 0, 1)]), worst * (1 + 1e-7) + 1e-10)
        bounds = [(0, None)] * self.size
        for j in range(asked.count):
            bounds[self.at["w"] + j] = (0, min(asked.most[j], 1e4))
            bounds[self.at["s"] + j] = bounds[self.at["b"] + j] = (None, None)
        for i, rotor in enumerate(asked.rotors):
            bounds[self.at["x"] + i] = tuple(rotor["ends"])
        bounds[self.at["torque"]] = (None, None)
        return cost, above, right, equal, side, bounds

    def least(self, rooms, worst, below):
        """The least of one choice between pins, from below; infinite if there is none, and beyond `below` any bound."""
        cost, above, right, equal, side, bounds = self.program(rooms, worst)
        base, asked, last = self.constant(worst), self.asked, -np.inf
        for _ in range(200):
            # HiGHS calls a bounded program unbounded now and then; without presolve it does not.
            for presolve in (True, False):
                found = linprog(cost, np.array(above + self.cuts), np.array(right + self.right), equal, side, bounds,
                                options={"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10,
                                         "presolve": presolve})
                if found.status in (0, 2):
                    break
            if found.status == 2:
                return np.inf, None
            assert found.status == 0, found.message
            value = found.fun + base
            get = lambda name, i: found.x[self.at[name] + i]
            off = 0.0
            for j in range(asked.count):
                w, s, b = get("w", j), get("s", j), get("b", j)
                if w > 1e-12:
                    if asked.turns:
                        off = max(off, (s * s + b * b) / w - get("u", j), asked.stock.own(w) - get("v", j))
                    if asked.clearance is not None and not asked.is_beside:
                        off = max(off, *(span - get(f"z{i}", j) for i, span in enumerate(asked.stock.spans(w))))
                    self.place(j, s / w, b / w)
                    self.mass(j, w)
            for i, rotor in enumerate(asked.rotors):
                if rotor["free"] == "ratio":
                    inertia = asked.free[rotor["drive"]]["inertia"]
                    off = max(off, inertia * get("x", i) ** 2 - get("t", i))
                    self.ratio(i, get("x", i))
            if off < 1e-9 or value > below:
                break
        return value, found.x

    def constant(self, worst):
        if worst is None and self.asked.is_range:
            return 0.0
        return self.asked.objective["inertia"] * sum(self.turned(k)[2][0] for k in range(self.asked.n))

    def least_of_all(self, worst=None):
        best, rooms = (np.inf, None), None
        for choice in itertools.product(*self.asked.rooms()):
            found = self.least(choice, worst, best[0])
            if found[0] < best[0]:
                best, rooms = found, choice
        return best[0], rooms


def tried(asked, random, worst, rooms, starts):
    """The least value of what SLSQP finds from starts, and random ones."""
    c, r, n = asked.count, len(asked.rotors), asked.n
    o = asked.objective
    sizes = [c, c, c, r, n, 1]
    cut = np.cumsum(sizes)[:-1]
    scale = lambda i: max(abs(asked.rotors[i]["ends"][0]), abs(asked.rotors[i]["ends"][1]), 1e-12)
    scales = np.array([scale(i) for i in range(r)])

    def parts(y):
        w, x, beside, rotors, d, torque = np.split(y, cut)
        return w, x, beside, rotors * scales, d, torque[0]

    def cost(y):
        w, x, beside, rotors, d, torque = parts(y)
        _, h, _ = asked.measures(w, x, beside, rotors)
        return o["mass"] * w.sum() + o["inertia"] * h.sum() + o["momentum"] * d.sum() + o["torque"] * torque

    def above(y):
        w, x, beside, rotors, d, torque = parts(y)
        mass, h, own = asked.measures(w, x, beside, rotors)
        rows = [d - own, d + own]
        if o["torque"] > 0:
            rows.append(torque - np.array(o["accelerations"]) * h)
        if asked.most_mass is not None:
            rows.append([asked.most_mass - mass])
        if asked.most_inertia is not None:
            rows.append([asked.most_inertia - own.sum()])
        if asked.is_range:
            both = asked.moments(w, x, beside)
            for end in asked.ends:
                left = (end + asked.changes @ both) / asked.per
                rows += [worst * (1 + 1e-7) + 1e-10 - left, worst * (1 + 1e-7) + 1e-10 + left]
        if asked.clearance is not None:
            gap, bore = asked.clearance, asked.stock.bore()
            for j, room in enumerate(rooms):
                mass = max(w[j], 0.0)
                if asked.is_beside:
                    away = lambda pin: -asked.stock.missed(mass, x[j], beside[j], pin, gap)
                    rows.append([w[j] * away(pin) for pin in asked.machine.pins(asked.sites[j][0])])
                    continue
                for sign, pin, side in room:
                    if pin is None:
                        rows.append([w[j] * sign * x[j]])
                    elif side is None:
                        rows.append([w[j] * (bore - gap - abs(x[j] - pin))])
                    else:
                        less = bore if asked.stock.kind == "half-ring" and side == 0 else 0.0
                        rows.append([w[j] * (sign * (x[j] - pin) - gap + less - asked.stock.reach(mass)[side])])
        return np.concatenate(rows)

    def equal(y):
        w, x, beside, *_ = parts(y)
        return (asked.left + asked.changes @ asked.moments(w, x, beside))[touched]

    # Rows that nothing changes would leave SLSQP without an answer.
    touched = abs(asked.changes).max(axis=1, initial=0.0) > 0
    bounds = [(0, min(most, 1e4)) for most in asked.most] + [tuple(site[1:3]) for site in asked.sites]
    bounds += [(-own, own) for own in asked.beside]
    bounds += [(rotor["ends"][0] / s, rotor["ends"][1] / s) for rotor, s in zip(asked.rotors, scales)]
    bounds += [(0, None)] * n + [(None, None)]
    limits = [{"type": "ineq", "fun": above}]
    if not asked.is_range and touched.any():
        limits.append({"type": "eq", "fun": equal})
    best = np.inf
    for start in starts + [None] * 6:
        if start is None:
            w = random.uniform(0, 1, c) * random.choice([0.3, 3.0, 10.0])
            x = np.array([random.uniform(*site[1:3]) for site in asked.sites])
            beside = np.array([random.uniform(-own, own) for own in asked.beside])
            rotors = np.array([random.uniform(*rotor["ends"]) for rotor in asked.rotors])
        else:
            w, x, beside, rotors = (np.array(part, float) for part in start)
        _, h, d = asked.measures(w, x, beside, rotors)
        torque = max(np.array(o["accelerations"]) * h) if o["torque"] > 0 else 0.0
        y = np.concatenate([w, x, beside, rotors / scales, abs(d), [torque]])
        y = np.clip(y, [-np.inf if low is None else low for low, _ in bounds],
                    [np.inf if high is None else high for _, high in bounds])
        found = minimize(cost, y, method="SLSQP", bounds=bounds, constraints=limits,
                         options={"maxiter": 200, "ftol": 1e-12})
        if not np.isfinite(found.x).all():
            continue
        if above(found.x).min() < -1e-9 or (not asked.is_range and abs(equal(found.x)).max(initial=0.0) > 1e-9):
            continue
        w, x, beside, rotors, *_ = parts(found.x)
        best = min(best, asked.value(w, x, beside, rotors))
    return best


for line in sys.stdin:
    line = json.loads(line)
    asked = Asked(line)
    random = np.random.default_rng(line["seed"])
    linear = Linear(asked)
    answer = {"worst": 0.0, "low": None, "high": None, "found": None}
    worst = None
    if asked.is_range:
        worst, rooms = linear.least_of_all()
        answer["worst"] = None if rooms is None else worst
        # One payload alone can be balanced exactly.
        asked.is_range = asked.payload[0] < asked.payload[1] or worst > 1e-9
        worst = worst if asked.is_range else None
    if worst is None or rooms is not None:
        low, rooms = linear.least_of_all(worst)
        answer["low"] = low if rooms is not None else None
    found = line["found"]
    starts = []
    if found is not None:
        machine = Machine(found)
        own = [weight for weight in machine.weights() if not weight.get("fixed")]
        w, y, off = np.zeros((3, asked.count))
        x = np.array([0.5 * (site[1] + site[2]) for site in asked.sites])
        links = [machine.names[site[0]] for site in asked.sites]
        for weight in own:
            j = links.index(weight["link"])
            w[j], x[j] = weight["mass"], weight["at"]
            off[j] = abs(asked.stock.own(w[j]) - w[j] * gyration(weight))
            y[j] = weight.get("across", 0.0)
        rotors = []
        for rotor in asked.rotors:
            given = machine.spec["drive"][rotor["drive"]].get("rotor", {"inertia": 0.0})
            rotors.append(given["inertia"] if rotor["free"] == "inertia" else given.get("ratio", 1.0))
        mass, h, d = asked.measures(w, x, y, rotors)
        past = [0.0]
        for j, (_, low, high, _, beside) in enumerate(asked.sites):
            if w[j] > 0:
                past += [low - x[j], x[j] - high, abs(y[j]) - beside, w[j] - asked.most[j], 1e3 * off[j] / w[j]]
                if asked.clearance is not None:
                    across = y[j] if beside else 0.0
                    pins = machine.pins(asked.sites[j][0])
                    past.append(max(asked.stock.missed(w[j], x[j], across, pin, asked.clearance) for pin in pins))
        past += [mass - asked.most_mass] if asked.most_mass is not None else []
        past += [d.sum() - asked.most_inertia] if asked.most_inertia is not None else []
        past += [max(rotor["ends"][0] - value, value - rotor["ends"][1]) for rotor, value in zip(asked.rotors, rotors)]
        answer["found"] = {
            "value": asked.value(w, x, y, rotors), "past": max(past), "residual": asked.residual(w, x, y),
            "mass": mass, "momenta": (machine.momenta() - d).tolist(), "diagonal": (np.diag(machine.inertia()) - h).tolist(),
        }
        starts.append((w, x, y, rotors))
    if answer["low"] is not None:
        high = tried(asked, random, worst, rooms, starts)
        answer["high"] = high if np.isfinite(high) else None
    print(json.dumps(answer), flush=True)
