

"""Poses nearest to a target, nearest to the middle, and of least weighted norm beside another, by SciPy."""

from scipy.optimize import minimize, nnls


def nearest(arm, random, p, starts):
    """The least distance from p over all poses, m."""
    def cost(a):
        gap = (arm.p(a) - p) / arm.reach
        return abs(gap) ** 2, 2 * (gap.conjugate() * arm.dp(a) / arm.reach).real

    # Angles that turn freely are sought in one turn.
    low, high = np.maximum(arm.low, -np.pi), np.minimum(arm.high, np.pi)
    low, high = np.where(np.isinf(arm.low), low, arm.low), np.where(np.isinf(arm.high), high, arm.high)
    many = random.uniform(low, high, (3000, len(low)))
    order = np.argsort(abs(arm.p(many) - p))[:12]
    bounds = list(zip(low, high))
    best = np.inf
    for a in [many[i] for i in order] + [np.clip(start, low, high) for start in starts]:
        found = minimize(cost, a, jac=True, method="L-BFGS-B", bounds=bounds,
                         options={"ftol": 1e-16, "gtol": 1e-12, "maxiter": 500})
        best = min(best, abs(arm.p(found.x) - p))
    return best


def uphill(arm, p, a):
    """How much of the way to the middle is left at a pose that neither the point nor limits hold, as a fraction."""
    free = np.isinf(arm.low)
    low, high = np.where(free, -1.0, arm.low), np.where(free, 1.0, arm.high)
    # An angle that hardly turns is at its middle, and stays there.
    narrow = high - low < 1e-3
    off = 0.5 * (low + high) - a
    slope = np.where(free | narrow, 0.0, off / (0.5 * (high - low)) ** 2)
    d = arm.dp(a) / arm.reach
    held = [d.real, -d.real, d.imag, -d.imag]
    for i in range(len(a)):
        side = np.eye(len(a))[i]
        held += [side] if narrow[i] or arm.high[i] - a[i] < 1e-9 else []
        held += [-side] if narrow[i] or a[i] - arm.low[i] < 1e-9 else []
    return nnls(np.array(held).T, slope)[1] / max(1.0, np.linalg.norm(slope))


def least_norm(arm, weight, a, step):
    """Rates of the relative angles of least weighted norm for a small step of the end effector, within limits."""
    w = arm.lift.T @ weight @ arm.lift
    d = arm.dp(a)
    rows = np.array([d.real, d.imag])
    square = np.block([[w, rows.T], [rows, np.zeros((2, 2))]])
    return np.linalg.solve(square, np.append(np.zeros(len(a)), [step.real, step.imag]))[: len(a)]


for line in sys.stdin:
    asked = json.loads(line)
    machine = Machine(asked["machine"])
    random = np.random.default_rng(asked["seed"])
    torques = machine.torques()
    torque = torques.T @ torques
    torque = torque / np.trace(torque) + 1e-9 * np.eye(machine.n)
    answers = []
    for drag in asked["drags"]:
        arm = Arm(machine, drag["b"])
        p = complex(*drag["p"])
        a, centred, start = (np.array(drag[key]) for key in ("a", "centred", "from"))
        answer = {
            "past": float(max((arm.low - a).max(), (a - arm.high).max(), (arm.low - centred).max(), (centred - arm.high).max())),
            "off": float(abs(arm.p(a) - p) / arm.reach),
            "least": nearest(arm, random, p, [a, start]) / arm.reach,
            "centred": abs(arm.p(centred) - complex(*drag["at"])) / arm.reach,
        }
        answer["uphill"] = float(uphill(arm, complex(*drag["at"]), centred))
        steps = []
        for key, weight in (("energy", np.diag(np.maximum(abs(arm.rates), 1e-6))), ("torque", torque)):
            step = complex(*drag["step"])
            want = least_norm(arm, weight, start, step)
            got = np.array(drag[key]) - start
            norm = lambda x: float((arm.lift @ x) @ weight @ (arm.lift @ x)) ** 0.5
            d = arm.dp(start)
            rows = np.array([d.real, d.imag])
            condition = float(np.linalg.cond(rows))
            # Beside limits another step is the least.
            is_free = (start + 3 * want > arm.low).all() and (start + 3 * want < arm.high).all() and condition < 20
            steps.append(norm(got - want) / norm(want) if is_free and abs(want).max() < 1e-4 else None)
        answer["steps"] = steps
        answers.append(answer)
    print(json.dumps(answers), flush=True)
