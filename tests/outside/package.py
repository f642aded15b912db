"""Holds the package stillbase against its own documentation, the command line in it, and plain sums."""

import ast
import copy
import doctest
import inspect
import json
import pickle
import os
import re
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Mapping
from importlib import resources
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import stillbase as sb
from stillbase import _stillbase

# Examples write files.
folder = tempfile.TemporaryDirectory()
os.chdir(folder.name)

# Every public name has examples, and they hold.
runner, parser = doctest.DocTestRunner(), doctest.DocTestParser()


def documented(name, one):
    """Runs the examples of a name; there must be some."""
    text = re.sub("^```(python)?$", "", inspect.getdoc(one) or "", flags=re.MULTILINE)
    test = parser.get_doctest(text, {}, name, None, 0)
    assert test.examples, f"{name} has no example"
    assert runner.run(test).failed == 0, name


def public(owner):
    """Public names of a class, and what notebooks ask for."""
    return [name for name in vars(owner) if not name.startswith("_") or name.startswith("_repr_")]


documented("stillbase", sb)
names = [name for name in sb.__all__ if name != "__version__"]
assert set(names) | {"main"} == {name for name in dir(_stillbase) if not name.startswith("_")} | {"trim"}, names
for name in names + ["main"]:
    one = getattr(sb, name, None) or getattr(_stillbase, name)
    documented(name, one)
    if isinstance(one, type) and not issubclass(one, Exception):
        for member in public(one):
            documented(f"{name}.{member}", getattr(one, member))

# The stub in the package states the names, signatures and documentation of the module as it is.
package = resources.files(sb)
assert (package / "py.typed").is_file()
stub = ast.parse((package / "_stillbase.pyi").read_text(encoding="utf-8"))


def parts(body):
    """Functions, classes and values of a part of the stub, by name."""
    found = {}
    for node in body:
        if isinstance(node, ast.AnnAssign):
            found[node.target.id] = node
        elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            found[node.name] = node
    return found


def stated(node, is_bound):
    """Parameters of a function of the stub: name, kind, default."""
    given, kinds = node.args, inspect.Parameter
    positional = given.posonlyargs + given.args
    defaults = [None] * (len(positional) - len(given.defaults)) + given.defaults
    rows = [(one.arg, kinds.POSITIONAL_ONLY if one in given.posonlyargs else kinds.POSITIONAL_OR_KEYWORD, default)
            for one, default in zip(positional, defaults)][is_bound:]
    rows += [(given.vararg.arg, kinds.VAR_POSITIONAL, None)] if given.vararg else []
    rows += [(one.arg, kinds.KEYWORD_ONLY, default) for one, default in zip(given.kwonlyargs, given.kw_defaults)]
    rows += [(given.kwarg.arg, kinds.VAR_KEYWORD, None)] if given.kwarg else []
    return [(name, kind, default and ast.unparse(default)) for name, kind, default in rows]


def actual(one, is_bound):
    """Parameters of a function of the module, as `stated`."""
    rows = list(inspect.signature(one).parameters.values())[is_bound:]
    return [(row.name, row.kind, None if row.default is row.empty else repr(row.default)) for row in rows]


def current(name, node, one, owner=None):
    """Compares a part of the stub with what it states."""
    assert inspect.cleandoc(ast.get_docstring(node) or "") == (inspect.getdoc(one) or ""), name
    if isinstance(node, ast.FunctionDef) and callable(one):
        # A method of a class is called without the class.
        is_method = owner is not None
        is_class = any(ast.unparse(each) == "classmethod" for each in node.decorator_list)
        assert stated(node, is_method) == actual(one, is_method and not is_class), name


top = parts(stub.body)
assert set(top) == {name for name in dir(_stillbase) if not name.startswith("_")} | {"__version__"}, set(top)
for name, node in top.items():
    one = getattr(_stillbase, name)
    if name == "__version__":
        continue
    current(name, node, one)
    if isinstance(node, ast.ClassDef) and not issubclass(one, Exception):
        members = parts(node.body)
        assert set(public(one)) == {each for each in members if each in public(one) or not each.startswith("__")}, name
        for member in public(one):
            current(f"{name}.{member}", members[member], getattr(one, member), one)

# Rows, one state for all rows, and a single state give the same numbers, on any number of threads.
random = np.random.default_rng(7)
PARTS = ("torque", "base_force", "base_moment")
for name in ("nine-link", "spot", "four-drive", "two-drive", "nine-link-geared", "serial-3r"):
    machine = sb.Machine.builtin(name).set({"gravity": (0.3, -9.81)})
    n = len(machine.drives)
    q, qd, qdd = (random.normal(size=(1001, n)) for _ in range(3))
    rows = machine.dynamics(q, qd, qdd)
    assert rows.torque.shape == (1001, n) and rows.base_force.shape == (1001, 2) and rows.base_moment.shape == (1001,)
    for threads in (2, 3, 2000):
        other = machine.dynamics(q, qd, qdd, threads=threads)
        for part in PARTS:
            assert np.array_equal(getattr(rows, part), getattr(other, part)), (name, threads, part)
    one = machine.dynamics(q[5], qd[5], qdd[5])
    assert one.torque.shape == (n,) and np.array_equal(one.torque, rows.torque[5])
    wide = machine.dynamics(np.asfortranarray(q), qd[0].tolist(), qdd[:, ::-1][:, ::-1])
    assert np.array_equal(wide.torque, machine.dynamics(q, np.tile(qd[0], (1001, 1)), qdd).torque)
    again = machine.dynamics(qdd, qd, q, out=rows)
    assert again is rows and np.array_equal(rows.torque, machine.dynamics(qdd, qd, q).torque)
    # Shapes broadcast as those of NumPy.
    broadcast = ((4, 1), (5,), ()), ((1,), (3,), (2, 1)), ((1, 1), (), (1,)), ((0,), (1,), ()), ((2, 3, 4), (3, 1), (4,))
    for shapes in broadcast:
        states = [random.normal(size=(*shape, n)) for shape in shapes]
        all_states = np.broadcast_arrays(*states)
        got, want = machine.dynamics(*states), machine.dynamics(*(x.reshape(-1, n) for x in all_states))
        assert got.torque.shape == all_states[0].shape and got.base_moment.shape == all_states[0].shape[:-1], shapes
        for part in PARTS:
            assert np.array_equal(getattr(got, part).ravel(), getattr(want, part).ravel()), (shapes, part)
    # The numbers are those of the command line, to the last bit.
    with open("states.json", "w") as file:
        json.dump([{"q": a.tolist(), "qd": b.tolist(), "qdd": c.tolist()} for a, b, c in zip(q, qd, qdd)], file)
    rows = machine.dynamics(q, qd, qdd)
    printed = sb.ask("dynamics", machine, states="states.json")["results"]
    for part in PARTS:
        assert np.array_equal(getattr(rows, part), np.array([row[part] for row in printed])), (name, part)
    # The moment on the base is the rate at which its angular momentum is lost: by central differences along a motion.
    if name == "nine-link":
        machine = sb.Machine.builtin(name)
        h, state = 1e-5, (q[0], qd[0], qdd[0])

        def momentum(t):
            at = state[0] + t * state[1] + t * t / 2 * state[2]
            rate = state[1] + t * state[2]
            # Momentum is linear in the rates: the moment of unit accelerations from rest.
            rest = machine.dynamics(at, np.zeros(n), np.eye(n)).base_moment
            return -rest @ rate

        lost = -(momentum(h) - momentum(-h)) / (2 * h)
        assert abs(lost - machine.dynamics(*state).base_moment) < 1e-6
    for wrong in ((q[:, :-1], qd, qdd), (q, qd[:7], qdd), (1.0, qd, qdd)):
        try:
            machine.dynamics(*wrong)
        except ValueError as why:
            assert "want" in str(why), why
        else:
            raise AssertionError(f"{name} takes {[np.shape(x) for x in wrong]}")

# Steps of many simulations.
for name in ("nine-link-bare", "serial-3r", "spot", "four-drive", "nine-link-geared"):
    machine = sb.Machine.builtin(name).set({"gravity": (0, 0)})
    n = len(machine.drives)
    q, qd, qdd, torque = (random.normal(size=(203, n)) for _ in range(4))
    # A batch, on any number of threads, is its states one by one; results may overwrite what is given.
    got = machine.step_batch(q, qd, torque, 1e-3, steps=7)
    for threads in (2, 5):
        assert all(map(np.array_equal, got, machine.step_batch(q, qd, torque, 1e-3, steps=7, threads=threads)))
    for i in (0, 101, 202):
        one = machine.step_batch(q[i], qd[i], torque[i], 1e-3, steps=7)
        assert all(np.array_equal(a, b[i]) for a, b in zip(one, got)), name
    own = q.copy(), qd.copy()
    assert machine.step_batch(*own, torque, 1e-3, steps=7, out=own)[0] is own[0]
    assert all(map(np.array_equal, own, got)), name
    wide = machine.step_batch(q[0], qd[:, None], torque[:5], 1e-3)
    assert wide[0].shape == (203, 5, n)
    assert np.array_equal(wide[1][7, 3], machine.step_batch(q[0], qd[7], torque[3], 1e-3)[1])
    assert np.array_equal(machine.step_batch(q, qd, torque, 1e-3, steps=0)[0], q)
    # Forward dynamics undo inverse dynamics: rates change by qdd.
    torque, h = machine.dynamics(q, qd, qdd).torque, 1e-5
    change = (machine.step_batch(q, qd, torque, h)[1] - machine.step_batch(q, qd, torque, -h)[1]) / (2 * h)
    assert np.abs(change - qdd).max() < 1e-6 * (1 + np.abs(qdd).max()), name

    def energy(q, qd):
        """Kinetic energy, from the mass matrix of the command line."""
        with open("states.json", "w") as file:
            json.dump([{"q": a.tolist(), "qd": b.tolist(), "qdd": [0] * n} for a, b in zip(q, qd)], file)
        results = sb.ask("dynamics", machine, states="states.json")["results"]
        return 0.5 * np.array([b @ row["mass_matrix"] @ b for b, row in zip(qd, results)])

    # Without torques energy stays, with an error of the order of the method or better.
    before, lost = energy(q, qd), []
    for count in (20, 40, 80):
        after = machine.step_batch(q, qd, np.zeros(n), 0.4 / count, steps=count)
        lost.append(np.abs(energy(*after) / before - 1).max())
    orders = np.log2(np.array(lost[:-1]) / lost[1:])
    # A constant mass matrix leaves nothing to lose.
    is_constant = sb.ask("check", machine)["invariant"]
    assert lost[0] < 1e-12 if is_constant else lost[0] > 1e-9 and (orders > 3.5).all(), (name, lost, orders)
    # Energy grows by what the motors do, and constant torques do torque times angle: here of motors on the base.
    if name.startswith("nine-link"):
        after = machine.step_batch(q, qd, torque, 1e-4, steps=1000)
        work = np.einsum("ij,ij->i", torque, after[0] - q)
        assert np.abs(energy(*after) - before - work).max() < 1e-9 * np.abs(work).max(), name
    # Results that would spoil what is read, or whose rows lie elsewhere, are refused, and nothing is changed.
    fortran, swapped = (np.asfortranarray(q), np.asfortranarray(qd)), (qd.copy(), q.copy())
    force = torque.copy()
    for given, out in (
        ((q, qd, force), fortran),
        ((swapped[1], swapped[0], force), swapped),
        ((q, qd, force), (force, np.empty_like(qd))),
        ((q, qd, force), (np.empty((2 * len(q), n))[::2], np.empty_like(qd))),
    ):
        before = [np.array(part) for part in (*given, *out)]
        try:
            machine.step_batch(*given, 1e-3, out=out)
        except ValueError as why:
            assert "out has q" in str(why), why
        else:
            raise AssertionError(f"{name}: out of other memory")
        assert all(map(np.array_equal, before[:3], given)), name
for wrong in ({"dt": np.nan}, {"out": (np.zeros((2, 3)), np.zeros((2, 3)))}, {"q": np.zeros(2)}):
    given = {"q": np.zeros(3), "qd": np.zeros(3), "torque": np.zeros(3), "dt": 1e-3} | wrong
    try:
        sb.Machine.builtin("nine-link").step_batch(**given)
    except ValueError as why:
        assert "want" in str(why), why
    else:
        raise AssertionError(f"step_batch takes {wrong}")

# Steps are those of a simulation without control, to the last bit: falling so slowly needs no substeps.
falls = {"gravity": (0, -1), "link.1.com": 0.1, "link.2.com": 0.2, "link.3.com": 0.3, "link.5.com": 0.05}
run = sb.simulate("case-1", set={"control.law": "pd", "control.kp": 0, "control.kd": 0} | falls)
machine = sb.Machine.builtin("nine-link").set(falls)
angle, rate = (np.stack([run[f"{part}/{k}"] for k in (1, 2, 3)], axis=1) for part in ("angle", "rate"))
assert all(not run[f"torque/{k}"].any() for k in (1, 2, 3)) and np.ptp(angle, axis=0).min() > 0.01
for count in (1, 10, 300, 1000):
    q, qd = machine.step_batch(angle[0], rate[0], np.zeros(3), 1e-3, steps=count)
    assert np.array_equal(q, angle[count]) and np.array_equal(qd, rate[count]), (count, q - angle[count])

# The same answers as the command line prints, and the same words.
line = [sys.executable, "-m", "stillbase"]


def printed(*words):
    return subprocess.run([*line, *words], capture_output=True, text=True, check=True).stdout


spot = sb.Machine.builtin("spot")
checked = json.loads(printed("check", "spot", "--json"))
assert checked == spot.check() == sb.ask("check", "spot") == sb.ask("check", spot)
assert printed("--version").split()[1] == sb.__version__
refused = subprocess.run([*line, "reach", "nine-link", "5,5", "--json"], capture_output=True, text=True)
try:
    sb.ask("reach", "nine-link", (5, 5))
except sb.NoAnswer as why:
    assert [f"stillbase: {words}" for words in str(why).split("\n")] == refused.stderr.splitlines(), why
else:
    raise AssertionError("a point out of reach")
points = ["0.5,0.5", "0.55,0.9"]
options = ["--shape", "line", "--b", "2.4"]
plan = sb.plan(sb.Machine.builtin("nine-link"), [(0.5, 0.5), (0.55, 0.9)], shape="line", b=2.4, output="mine.toml")
assert plan == json.loads(printed("plan", "nine-link", *points, *options, "-o", "own.toml", "--json"))
assert sb.simulate("mine.toml").verdict["reactionless"]
recorded = sb.record("mine.toml", "mine.rrd")["recordings"]
assert recorded[0]["reactionless"] and printed("table", "mine.rrd").count("\n") > 100
try:
    sb.record("case-1", "mine.rrd")
except sb.WrongInput as why:
    assert "mine.rrd" in str(why), why
else:
    raise AssertionError("a file is overwritten")

# Models are the files of the command line, and XML.
machine = sb.Machine.builtin("nine-link")
for ending, text in (("xml", machine.to_mjcf()), ("urdf", machine.to_urdf())):
    printed("export-model", "nine-link", "-o", f"mine.{ending}")
    with open(f"mine.{ending}", encoding="utf-8") as file:
        assert file.read() == text, ending
    assert ElementTree.fromstring(text) is not None
assert machine.to_mjcf(pose=[1.5, 4.2, 3.1]) != machine.to_mjcf(pose=[1.5, 4.2, 3.0])
# A notebook shows the whole machine: a title for it and for each link, and a ring for each pin.
picture = ElementTree.fromstring(machine._repr_svg_())
assert picture.get("aria-label") == "nine-link: 3 drives, 16.050 kg" and picture.get("viewBox")
assert len(picture.findall(".//{*}title")) == 10 and len(picture.findall("{*}circle")) > 7

# A machine as a dictionary and back; a wrong one is refused with its place.
spec = machine.to_dict()
assert sb.Machine.from_dict(spec) == machine == sb.Machine.from_toml(machine.to_toml())
spec["link"][3]["mass"] = -2.0
try:
    sb.Machine.from_dict(spec)
except sb.WrongInput as why:
    assert "mass of link 4" in str(why), why
else:
    raise AssertionError("a negative mass")
assert pickle.loads(pickle.dumps(machine)) == machine == copy.deepcopy(machine)
assert {machine: 1}[sb.Machine.from_toml(machine.to_toml())] == 1
assert machine.set({"link.5.com": 0}).check()["force_balanced"] is False
assert machine.set("link.5.com", 0) == machine.set({"link.5.com": 0})
assert machine.set("gravity", (0, -9.81)).to_dict()["gravity"] == [0, -9.81]
for wrong in (("link.5.com",), ({"link.5.com": 0}, 1), (3, 4)):
    try:
        machine.set(*wrong)
    except TypeError:
        pass
    else:
        raise AssertionError(f"set takes {wrong}")
# A word that is no command is named; nothing opens a window.
for words in (("foo",), ("foo", "bar"), ("case-1",), ()):
    try:
        sb.ask(*words)
    except sb.WrongInput as why:
        named = f"{words[0]}: no such command: want one of " if words else "no command: want one of "
        assert str(why).startswith(named) and "simulate, " in str(why), why
    else:
        raise AssertionError(f"{words} are a command")
assert sb.Machine.builtin("nine-link-bare").counterweights(max_mass={"1": 8})["certified"]

run = sb.simulate("case-1", set={"plant.payload.mass": 0.1}, every=10)
assert run.time.flags.owndata or run.time.base is not None
assert run["torque/1"].shape == run.time.shape and run.units["torque/1"] == "N m"
# A run is a mapping of its signals.
assert isinstance(run, Mapping) and len(run) == len(run.signals) == len(list(run)) and len(run.time) == 101
assert list(run) == list(run.keys()) == [name for name, _ in run.items()] and dict(run).keys() == run.keys()
assert all(one is run[name] for name, one in zip(run, run.values())) and run.get("torque/1") is run["torque/1"]
assert "torque/1" in run and "torque/9" not in run and 3 not in run and run.get("torque/9", 7) == 7
try:
    run["torque/9"]
except KeyError as why:
    assert "torque/9" in str(why), why
else:
    raise AssertionError("a signal that is not there")
frame = pd.DataFrame(dict(run), index=run.time)
assert list(frame.columns) == list(run) and frame.index[-1] == 1.0 and (frame["torque/1"] == run["torque/1"]).all()
assert np.isclose(abs(run["moment/total"]).max(), run.verdict["peak_base_moment"], rtol=0.05)
table = ElementTree.fromstring(run._repr_html_())
assert "case-1" in table.find("caption").text and len(table.findall("tr")) > 5
cells = {row.find("th").text: row.find("td").text.strip() for row in table.findall("tr")}
assert cells["steps"] == "1000" and "." in cells["peak_base_moment"], cells
with warnings.catch_warnings(record=True) as notes:
    warnings.simplefilter("always")
    sb.ask("export-model", "spot", output="spot.xml")
assert any("--base spot" in str(note.message) for note in notes), notes

# Measured tables give the same answer from a file and from memory.
t = np.arange(0, 6, 0.01)
at, rate = np.outer(t, [2.1, 2.9, 3.7]), np.array([2.1, 2.9, 3.7])
states = np.cos(at) + [1, 2, 3], -rate * np.sin(at), -(rate**2) * np.cos(at)
loads = machine.set({"link.5.com": 0.01}).dynamics(*states)
columns = {"t": t, "fx": loads.base_force[:, 0], "fy": loads.base_force[:, 1], "nz": loads.base_moment}
columns = {name: x + random.normal(scale=1e-4, size=len(t)) * (name != "t") for name, x in columns.items()}
for name, x in zip(("q", "qd", "qdd"), states):
    columns |= {f"{name}{k + 1}": x[:, k] for k in range(3)}
table = pd.DataFrame(columns)
table.to_csv("measured.csv", index=False)
found = sb.trim("measured.csv", "nine-link")
assert any(number["off"] for number in found["numbers"])
fields = np.rec.fromarrays(list(columns.values()), names=list(columns))
for given in (columns, table, table.set_index("t"), fields, {name: list(x) for name, x in columns.items()}, [table]):
    assert sb.trim(given, machine) == found
run = sb.simulate("case-1", set={"link.5.com": 0.05})
with open("run.csv", "w") as file:
    file.write(printed("simulate", "case-1", "--set", "link.5.com=0.05"))
assert sb.trim(run, "nine-link") == sb.trim("run.csv", "nine-link")
for wrong in (3, {"t": [1, 2], "q1": [1]}):
    try:
        sb.trim(wrong, "nine-link")
    except (TypeError, ValueError) as why:
        assert "want" in str(why), why
    else:
        raise AssertionError(f"trim takes {wrong}")

# The files may go.
os.chdir("/")
