"""Holds the package stillbase against its own documentation, the command line in it, and plain sums."""

import doctest
import json
import subprocess
import sys
import tempfile
import warnings

import numpy as np
import stillbase as sb
from stillbase import _stillbase

failed, tried = doctest.testmod(sb)
assert tried >= 4 and not failed, (tried, failed)
finder = doctest.DocTestFinder()
runner = doctest.DocTestRunner()
texts = {
    name: getattr(one, "__doc__", None) or ""
    for owner in (_stillbase, sb.Machine, sb.Run)
    for name, one in vars(owner).items()
    if not name.startswith("__")
}
parser = doctest.DocTestParser()
examples = 0
for name, text in texts.items():
    test = parser.get_doctest(text.replace("```python", "").replace("```", ""), {}, name, None, 0)
    examples += len(test.examples)
    assert runner.run(test).failed == 0, name
assert examples >= 6, examples

# Rows, one state for all rows, and a single state give the same numbers, on any number of threads.
random = np.random.default_rng(7)
for name in ("nine-link", "spot", "four-drive", "two-drive", "nine-link-geared"):
    machine = sb.Machine.builtin(name)
    n = len(machine.drives)
    q, qd, qdd = (random.normal(size=(1001, n)) for _ in range(3))
    rows = machine.dynamics(q, qd, qdd)
    assert rows.torque.shape == (1001, n) and rows.base_force.shape == (1001, 2) and rows.base_moment.shape == (1001,)
    for threads in (2, 3, 2000):
        other = machine.dynamics(q, qd, qdd, threads=threads)
        for part in ("torque", "base_force", "base_moment"):
            assert np.array_equal(getattr(rows, part), getattr(other, part)), (name, threads, part)
    one = machine.dynamics(q[5], qd[5], qdd[5])
    assert one.torque.shape == (n,) and np.array_equal(one.torque, rows.torque[5])
    wide = machine.dynamics(np.asfortranarray(q), qd[0].tolist(), qdd[:, ::-1][:, ::-1])
    assert np.array_equal(wide.torque, machine.dynamics(q, np.tile(qd[0], (1001, 1)), qdd).torque)
    again = machine.dynamics(qdd, qd, q, out=rows)
    assert again is rows and np.array_equal(rows.torque, machine.dynamics(qdd, qd, q).torque)
    # The moment on the base is the rate at which its angular momentum is lost: by central differences along a motion.
    if name == "nine-link":
        h, state = 1e-5, (q[0], qd[0], qdd[0])

        def momentum(t):
            at = state[0] + t * state[1] + t * t / 2 * state[2]
            rate = state[1] + t * state[2]
            # Momentum is linear in the rates: the moment of unit accelerations from rest.
            rest = machine.dynamics(at, np.zeros(n), np.eye(n)).base_moment
            return -rest @ rate

        lost = -(momentum(h) - momentum(-h)) / (2 * h)
        assert abs(lost - machine.dynamics(*state).base_moment) < 1e-6
    for wrong in ((q[:, :-1], qd, qdd), (q, qd[:7], qdd), (q[None], qd, qdd)):
        try:
            machine.dynamics(*wrong)
        except ValueError as why:
            assert "want" in str(why), why
        else:
            raise AssertionError(f"{name} takes {[x.shape for x in wrong]}")

# The same answers as the command line prints, and the same words.
line = [sys.executable, "-m", "stillbase"]
printed = subprocess.run([*line, "check", "spot", "--json"], capture_output=True, text=True, check=True).stdout
assert json.loads(printed) == sb.Machine.builtin("spot").check() == sb.ask("check", "spot")
refused = subprocess.run([*line, "reach", "nine-link", "5,5", "--json"], capture_output=True, text=True)
try:
    sb.ask("reach", "nine-link", (5, 5))
except sb.NoAnswer as why:
    assert [f"stillbase: {words}" for words in str(why).split("\n")] == refused.stderr.splitlines(), why
else:
    raise AssertionError("a point out of reach")

# A machine as a dictionary and back; a wrong one is refused with its place.
machine = sb.Machine.builtin("nine-link")
spec = machine.to_dict()
assert sb.Machine.from_dict(spec) == machine == sb.Machine.from_toml(machine.to_toml())
spec["link"][3]["mass"] = -2.0
try:
    sb.Machine.from_dict(spec)
except sb.WrongInput as why:
    assert "mass of link 4" in str(why), why
else:
    raise AssertionError("a negative mass")
assert machine.set({"link.5.com": 0}).check()["force_balanced"] is False
assert sb.Machine.builtin("nine-link-bare").counterweights(max_mass={"1": 8})["certified"]

run = sb.simulate("case-1", set={"plant.payload.mass": 0.1}, every=10)
assert run.time.flags.owndata or run.time.base is not None
assert run["torque/1"].shape == run.time.shape and run.units["torque/1"] == "N m"
assert np.isclose(abs(run["moment/total"]).max(), run.verdict["peak_base_moment"], rtol=0.05)
with warnings.catch_warnings(record=True) as notes, tempfile.TemporaryDirectory() as folder:
    warnings.simplefilter("always")
    sb.ask("export-model", "spot", output=f"{folder}/spot.xml")
assert any("--base spot" in str(note.message) for note in notes), notes
