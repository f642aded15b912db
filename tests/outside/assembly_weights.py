"""Counterweights of whole assemblies by HiGHS: positions and momenta of all bodies in space, at random poses.

The blocks put nothing on the base while each holds its b if the momentum for a unit rate of every drive vanishes, and the
angular momentum about the base is the same in every pose. Both are linear in the mass w and the first moment w x of each
counterweight; w x x adds the same in every pose. Inertia s s/w and w w are bounded by tangents, added where they are off.
"""

import re

from scipy.optimize import linprog


class Block:
    def __init__(self, given, first):
        self.machine, self.first = Machine(given["machine"]), first
        self.on, self.at = given["on"], np.array(given["at"])
        self.x, self.y = np.array(given["x"]), np.array(given["y"])
        self.z = np.cross(self.x, self.y)
        self.end_height = self.machine.spec.get("payload", {}).get("axial", 0.0)

    def heights(self):
        return [link.get("axial", 0.0) for link in self.machine.spec["link"]]


class Whole:
    def __init__(self, blocks, random, poses):
        self.blocks, self.n = [], 0
        for given in blocks:
            self.blocks.append(Block(given, self.n))
            self.n += self.blocks[-1].machine.n
        self.q = random.uniform(-np.pi, np.pi, (poses, self.n))

    def vector(self, block, arms, height):
        """Place in space from the mount of a block, and its derivatives by all drives; the first axis counts poses."""
        own = slice(block.first, block.first + block.machine.n)
        each = arms * np.exp(1j * self.q[:, own])
        total, by = each.sum(1), np.zeros((len(self.q), self.n, 3))
        plane = lambda c: c.real[..., None] * block.x + c.imag[..., None] * block.y
        by[:, own] = plane(1j * each)
        return plane(total) + height * block.z, by

    def mount(self, block):
        place, by = np.zeros((len(self.q), 3)) + block.at, np.zeros((len(self.q), self.n, 3))
        if block.on is not None:
            carrier = self.blocks[block.on]
            below, below_by = self.mount(carrier)
            end, end_by = self.vector(carrier, carrier.machine.tip, carrier.end_height)
            place, by = place + below + end, by + below_by + end_by
        return place, by

    def body(self, block, arms, height):
        place, by = self.mount(block)
        own, own_by = self.vector(block, arms, height)
        return place + own, by + own_by

    @staticmethod
    def momenta(one, other):
        """Angular momentum of bodies at R for each drive, from R and the derivatives of R."""
        return np.cross(one[0][:, None, :], other[1])

    def rows(self, linear, angular):
        """What has to vanish: the momentum, and how the angular momentum differs from that of the first pose."""
        return np.concatenate([linear.ravel(), (angular[1:] - angular[0]).ravel()])

    def own(self, angular):
        """The sum over drives of the angular momentum about the axis of each block, in the first pose."""
        axes = np.concatenate([np.tile(block.z, (block.machine.n, 1)) for block in self.blocks])
        return (angular[0] * axes).sum()

    def fixed(self, with_weights):
        """Rows, and the sum of D_k, of all bodies but the counterweights that are sought."""
        rows, inertia = 0.0, 0.0
        for block in self.blocks:
            machine, heights = block.machine, block.heights()
            weights = [w for w in machine.weights() if with_weights or w.get("fixed")]
            each = list(machine.bodies(weights=weights))
            links = list(range(len(heights))) + [machine.names.index(w["link"]) for w in weights]
            at = [heights[j] for j in links] + [block.end_height]
            for (mass, spin, arms, _), height in zip(each, at):
                body = self.body(block, arms, height)
                angular = mass * self.momenta(body, body)
                rows = rows + self.rows(mass * body[1], angular)
                inertia += spin + self.own(angular)
        return rows, inertia

    def sites(self, sites):
        """Rows by w and by s of each site, and what both add to the sum of D_k."""
        by, inertia = [], []
        for b, j, *_ in sites:
            block = self.blocks[b]
            machine, height = block.machine, block.heights()[j]
            root = self.body(block, machine.on(j, 0.0), height)
            away = self.body(block, machine.on(j, 1.0), height)
            arm = away[0] - root[0], away[1] - root[1]
            for linear, angular in [
                (root[1], self.momenta(root, root)),
                (arm[1], self.momenta(root, arm) + self.momenta(arm, root)),
            ]:
                by.append(self.rows(linear, angular))
                inertia.append(self.own(angular))
        return np.array(by).T, np.array(inertia)


def reduced(a, b):
    """The same equations without those that follow from others; None if they contradict each other."""
    both = np.column_stack([a, b])
    both = both / np.linalg.norm(both, axis=0).clip(1e-12)[None, :].max()
    _, size, rows = np.linalg.svd(both, full_matrices=False)
    rows = rows[size > 1e-9 * size[0]]
    return rows[:, :-1], rows[:, -1]


def least(asked, a, b, inertia, constant):
    """The least value of the objective, and the counterweights; None if there are none."""
    sites, own = asked["sites"], 1 / (2 * np.pi * asked["mass_per_area"])
    n, weight = len(sites), asked["inertia"]
    equal, right = reduced(a, b)
    # w, s of each site, then u >= s s/w and v >= own w w.
    cost = np.zeros(4 * n)
    cost[: 2 * n] = weight * inertia
    cost[: 2 * n : 2] += asked["mass"]
    cost[2 * n :] = weight
    equal = np.hstack([equal, np.zeros((len(equal), 2 * n))])
    above, most = [], []
    bounds = []
    for i, (_, _, low, high, heaviest) in enumerate(sites):
        for at, sign in [(low, 1.0), (high, -1.0)]:
            row = np.zeros(4 * n)
            row[2 * i], row[2 * i + 1] = sign * at, -sign
            above.append(row)
            most.append(0.0)
        bounds += [(0, heaviest), (None, None)]
        if weight > 0:
            # Without a few tangents to begin with, a mass could grow without end.
            for x in np.linspace(low, high, 9):
                row = np.zeros(4 * n)
                row[2 * i], row[2 * i + 1], row[2 * n + 2 * i] = -x * x, 2 * x, -1.0
                above.append(row)
                most.append(0.0)
            for mass in [1.0, 5.0, 20.0, 100.0, 500.0]:
                row = np.zeros(4 * n)
                row[2 * i], row[2 * n + 2 * i + 1] = 2 * own * mass, -1.0
                above.append(row)
                most.append(own * mass**2)
    bounds += [(0, None)] * (2 * n)
    for _ in range(200):
        found = linprog(cost, np.array(above), most, equal, right, bounds, method="highs")
        if found.status == 2:
            return None
        if found.status != 0:
            raise RuntimeError(found.message)
        w, s, u, v = found.x[: 2 * n : 2], found.x[1 : 2 * n : 2], found.x[2 * n :: 2], found.x[2 * n + 1 :: 2]
        gap, before = 0.0, len(above)
        for i in range(n if weight > 0 else 0):
            x = s[i] / w[i] if w[i] > 1e-12 else 0.0
            for place, value, exact, by_w, by_s, free in [
                (2 * n + 2 * i, u[i], w[i] * x * x, -x * x, 2 * x, 0.0),
                (2 * n + 2 * i + 1, v[i], own * w[i] ** 2, 2 * own * w[i], 0.0, -own * w[i] ** 2),
            ]:
                if exact - value > 1e-9:
                    row = np.zeros(4 * n)
                    row[2 * i], row[2 * i + 1], row[place] = by_w, by_s, -1.0
                    above.append(row)
                    most.append(-free)
                    gap += weight * (exact - value)
        if len(above) == before or gap < 1e-8 * (1 + abs(found.fun)):
            break
    return found.fun + weight * constant + gap, gap


def flat(blocks):
    """The same blocks at one height, each on the pin that carries it: their conditions (7) and (8) do not change."""
    given = []
    for block in blocks:
        level = re.sub(r"axial = [-+.0-9e]+", "axial = 0.0", block["machine"])
        given.append({**block, "machine": level, "at": [0, 0, 0]})
    return given


for line in sys.stdin:
    asked = json.loads(line)
    answer = {}
    for name, blocks in [("silent", asked["blocks"]), ("planar", flat(asked["blocks"]))]:
        whole = Whole(blocks, np.random.default_rng(asked["seed"]), 24)
        rows, constant = whole.fixed(False)
        by, inertia = whole.sites(asked["sites"])
        found = least(asked, by, -rows, inertia, constant)
        answer[name] = None if found is None else found[0]
    if asked["found"] is not None:
        for name, blocks in [("found", asked["found"]), ("found_planar", flat(asked["found"]))]:
            whole = Whole(blocks, np.random.default_rng(asked["seed"]), 24)
            rows, inertia = whole.fixed(True)
            answer[name] = {"left": abs(rows).max(), "inertia": inertia}
    print(json.dumps(answer), flush=True)
