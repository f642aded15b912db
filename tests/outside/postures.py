

"""Least costs of paths by dynamic programming over random poses and by SciPy's SLSQP."""

from scipy.interpolate import make_interp_spline
from scipy.optimize import minimize


def passed(machine, q):
    """The integral of the squared torques, (N m)² s, of poses at even times of 1 s."""
    torque = np.diff(q, 2, axis=0) @ machine.torques().T * (len(q) - 1) ** 2
    return float((torque**2).sum() / (len(q) - 1))


class Task:
    """A path of the end effector over stations at even shares of its length, passed by the quintic law in 1 s."""

    def __init__(self, arm, points):
        self.arm, self.points, self.count, self.size = arm, points, len(points), len(arm.low)
        m, t = self.count, np.linspace(0, 1, 20001)
        s = np.linspace(0, 1, m)
        t = np.interp(s, t**3 * (10 - 15 * t + 6 * t * t), t)
        rate, acceleration = 30 * t**2 * (1 - t) ** 2, 60 * t * (1 - t) * (1 - 2 * t)
        ds = 1 / (m - 1)
        weight = np.full(m, ds)
        weight[[0, -1]] *= 0.5
        # Differences over stations: first ones between them, and both derivatives at each.
        step = (np.eye(m, k=1) - np.eye(m))[:-1] / ds
        first = np.zeros((m, m))
        second = np.zeros((m, m))
        for i in range(1, m - 1):
            first[i, [i - 1, i + 1]] = np.array([-0.5, 0.5]) / ds
            second[i, i - 1 : i + 2] = np.array([1, -2, 1]) / ds**2
        first[0, :3] = np.array([-1.5, 2, -0.5]) / ds
        first[-1, -3:] = np.array([0.5, -2, 1.5]) / ds
        inner = slice(1, m - 1)
        turned = np.zeros((m, m))
        turned[inner] = (rate[inner, None] ** 2 * second[inner] + acceleration[inner, None] * first[inner])
        turned[inner] /= np.sqrt(rate[inner, None])
        # At rest s'' / sqrt(s') tends to the root of 120.
        turned[0], turned[-1] = np.sqrt(120) * first[0], np.sqrt(120) * first[-1]
        torque = arm.machine.torques()
        ranges = np.diag(1 / np.maximum(0.5 * (arm.high - arm.low), 5e-7) ** 2)
        middle = 0.5 * (arm.high + arm.low)
        lift = arm.lift
        self.costs = {
            "rates": (ds * step.T @ step, lift.T @ lift, 0 * middle),
            "torque": (turned.T @ (weight[:, None] * turned), lift.T @ torque.T @ torque @ lift, 0 * middle),
            "middle": (0.5 * np.diag(weight), ranges, middle),
        }

    def cost(self, kind, a):
        over, among, about = self.costs[kind]
        off = a - about
        gradient = over @ off @ among
        return float((off * gradient).sum()), 2 * gradient

    def polished(self, kind, a, iterations=60):
        """A path of least cost beside another, and its cost; None if SciPy finds none."""
        shape = a.shape
        scale = max(self.cost(kind, a)[0], 1e-12)

        def cost(x):
            value, gradient = self.cost(kind, x.reshape(shape))
            return value / scale, gradient.ravel() / scale

        def gap(x):
            off = self.arm.p(x.reshape(shape)) - self.points
            return np.concatenate([off.real, off.imag])

        def slope(x):
            d = self.arm.dp(x.reshape(shape))
            rows = np.zeros((2, self.count, self.count, self.size))
            for i in range(self.count):
                rows[0, i, i], rows[1, i, i] = d[i].real, d[i].imag
            return rows.reshape(2 * self.count, -1)

        bounds = list(zip(np.tile(self.arm.low, self.count), np.tile(self.arm.high, self.count)))
        found = minimize(cost, a.ravel(), jac=True, method="SLSQP", bounds=bounds,
                         constraints={"type": "eq", "fun": gap, "jac": slope},
                         options={"maxiter": iterations, "ftol": 1e-9})
        x = found.x.reshape(shape)
        if not np.isfinite(x).all() or abs(gap(found.x)).max() > 1e-7 * self.arm.reach:
            return None
        return x, self.cost(kind, x)[0]

    def routes(self, random, count):
        """For each cost the cheapest path through random poses; none if poses of a station are missing."""
        layers = []
        for p in self.points:
            poses = self.arm.poses(random, p, 4 * count)[:count]
            if len(poses) == 0:
                return {}
            layers.append(poses)
        found = {}
        ds = 1 / (self.count - 1)
        for kind in ("rates", "middle"):
            _, among, about = self.costs[kind]
            rates = self.costs["rates"][1]
            best, back = np.zeros(len(layers[0])), []
            for i, poses in enumerate(layers):
                if i > 0:
                    step = poses[:, None] - layers[i - 1][None]
                    far = np.einsum("ijk,kl,ijl->ij", step, rates, step)
                    # A jump is no path.
                    cost = best + (far / ds if kind == "rates" else 1e-3 * far / ds) + 1e3 * (far > 0.3)
                    back.append(cost.argmin(1))
                    best = cost.min(1)
                if kind == "middle":
                    off = poses - about
                    best = best + 0.5 * ds * np.einsum("ij,jk,ik->i", off, among, off)
            at = [int(best.argmin())]
            for row in reversed(back):
                at.append(int(row[at[-1]]))
            found[kind] = np.array([layers[i][k] for i, k in enumerate(reversed(at))])
        return found

    def torque(self, a):
        """The squared torques of a smooth path through the poses of the stations, at 1000 even times."""
        t = np.linspace(0, 1, 1001)
        smooth = make_interp_spline(np.linspace(0, 1, self.count), self.arm.q(a), k=5)
        return passed(self.arm.machine, smooth(t**3 * (10 - 15 * t + 6 * t * t)))

    def is_smooth(self, a):
        return abs(np.diff(self.arm.q(a), axis=0)).max() < 0.3


for line in sys.stdin:
    asked = json.loads(line)
    arm = Arm(Machine(asked["machine"]), asked["b"])
    points = np.array(asked["points"]) @ np.array([1, 1j])
    task, random = Task(arm, points), np.random.default_rng(asked["seed"])
    answer = {"own": {}, "least": {}, "off": 0.0, "past": 0.0, "b": 0.0}
    paths = {kind: np.array(q) for kind, q in asked["paths"].items()}
    for kind, q in paths.items():
        a = arm.a(q)
        answer["off"] = max(answer["off"], abs(np.exp(1j * q) @ arm.tip - points).max() / arm.reach)
        answer["past"] = max(answer["past"], (arm.low - a).max(), (a - arm.high).max())
        answer["b"] = max(answer["b"], abs(q @ arm.rates - asked["b"]).max())
        if kind in task.costs:
            answer["own"][kind] = task.cost(kind, a)[0]
    if asked["timed"] is not None:
        answer["own"]["torque"] = passed(arm.machine, np.array(asked["timed"]))
    routes = task.routes(random, asked["poses"])
    starts = [arm.a(q) for q in paths.values()] + list(routes.values())
    for kind in task.costs:
        found = [task.polished(kind, np.clip(a, arm.low, arm.high)) for a in starts]
        costs = [one for one in found if one is not None and task.is_smooth(one[0])]
        # Of torques, far paths are other minima.
        if kind == "torque" and kind in paths:
            costs = [one for one in costs if abs(one[0] - arm.a(paths[kind])).max() < 0.5]
        costs = [task.torque(one[0]) if kind == "torque" else one[1] for one in costs]
        answer["least"][kind] = min(costs, default=None)
    print(json.dumps(answer), flush=True)
