"""Interrupts calls of the package stillbase, as Ctrl-C does."""

import os
import signal
import subprocess
import sys
import tempfile
import threading
import time

import numpy as np
import stillbase as sb

folder = tempfile.TemporaryDirectory()
os.chdir(folder.name)
# An alarm raises what Ctrl-C raises.
signal.signal(signal.SIGALRM, signal.default_int_handler)

# When a call is interrupted, and how soon it has to end, s; other work may keep the processors busy.
AFTER, WITHIN = 0.4, 0.6
LONG = {"task.time": 1000}
bare = sb.Machine.builtin("nine-link-bare")
machine = sb.Machine.builtin("nine-link")
states = np.random.default_rng(1).normal(size=(100_000, 3))
loads = machine.dynamics(states, states, states)


def evaluated():
    while True:
        machine.dynamics(states, states, states, out=loads, threads=2)


# Each of them takes minutes.
calls = {
    "tolerance, summary": lambda: sb.ask("tolerance", "case-3", samples=10**9, summary=True, output="new.parquet"),
    "tolerance, rows": lambda: sb.ask("tolerance", "case-3", samples=10**9, shard="1/50", output="new.csv"),
    "tolerance, simulated": lambda: sb.ask("tolerance", "case-3", samples=10**5, simulate=True, output="new.csv"),
    "design, varied": lambda: sb.ask(
        "design", bare, counterweights=True, vary="length.l5=0.3:0.6:10000", table="new.csv"
    ),
    "design, lengths": lambda: bare.counterweights(length=["l5=0.3,0.6", "l9=0.2,0.5"], min_workspace=0.5, starts=1000),
    "design, front": lambda: bare.counterweights(front=1000),
    "design, fronts": lambda: sb.ask("design", "nine-link-bare", "two-drive", counterweights=True, front=1000),
    "simulate": lambda: sb.simulate("case-1", set=LONG | {"step": 2.5e-4}, every=10_000),
    "joints": lambda: sb.ask("joints", "case-1", set=LONG, output="new.csv"),
    "record": lambda: sb.record("case-1", "new.rrd", set=LONG),
    "compare": lambda: sb.ask("compare", "case-1", set=LONG),
    "spectrum": lambda: sb.ask("spectrum", "case-1", set=LONG),
    "dynamics": evaluated,
    "step_batch": lambda: machine.step_batch(states, states, np.zeros(3), 1e-6, steps=10**6, threads=2),
    "step_batch of one": lambda: machine.step_batch(states[0], states[1], np.zeros(3), 1e-9, steps=10**9),
}
reached = sb.ask("reach", "nine-link", "0.5,0.5")
for name, call in calls.items():
    signal.setitimer(signal.ITIMER_REAL, AFTER)
    begun = time.perf_counter()
    try:
        call()
    except KeyboardInterrupt:
        late = time.perf_counter() - begun - AFTER
    else:
        raise AssertionError(f"{name}: it is not interrupted")
    assert 0 <= late < WITHIN, f"{name}: it ends {late:.3f} s after the interrupt"
    # Nothing computes any more, nothing half-written is left, and the next call is as before.
    used = time.process_time()
    time.sleep(0.1)
    assert time.process_time() - used < 0.05, f"{name}: a thread goes on"
    assert not os.listdir("."), f"{name}: {os.listdir('.')}"
    assert sb.ask("reach", "nine-link", "0.5,0.5") == reached, name
assert np.array_equal(machine.dynamics(states, states, states).torque[:7], machine.dynamics(*[states[:7]] * 3).torque)

# A handler that raises nothing stops nothing.
heard = []
signal.signal(signal.SIGALRM, lambda *_: heard.append(time.perf_counter()))
signal.setitimer(signal.ITIMER_REAL, 0.2)
study = {"samples": 10**6, "summary": True}
whole = sb.ask("tolerance", "case-3", **study)
assert heard and whole["samples"] == 10**6

# A command of another thread goes on.
signal.signal(signal.SIGALRM, signal.default_int_handler)
beside = []
other = threading.Thread(target=lambda: beside.append(sb.ask("tolerance", "case-3", **study)))
other.start()
signal.setitimer(signal.ITIMER_REAL, 0.2)
try:
    calls["design, front"]()
except KeyboardInterrupt:
    assert other.is_alive()
else:
    raise AssertionError("it is not interrupted")
other.join()
assert beside == [whole]

# A script ends as any other does, and leaves no file. A shell may have its jobs in the background ignore the signal.
script = (
    "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
    "import stillbase as sb; print('go', flush=True); "
    "sb.ask('tolerance', 'case-3', simulate=True, samples=10**5, output='all.csv')"
)
with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as child:
    assert child.stdout.readline() == b"go\n"
    time.sleep(0.5)
    assert os.listdir("."), "it has begun to write"
    child.send_signal(signal.SIGINT)
    # A loaded machine takes its time to end a process.
    said = child.communicate(timeout=60)[1]
assert child.returncode == -signal.SIGINT and b"KeyboardInterrupt" in said, (child.returncode, said)
assert not os.listdir("."), os.listdir(".")

# The files may go.
os.chdir("/")
