# %% [markdown]
# # The same numbers by MuJoCo and Pinocchio
#
# The arm of nine links, written as MJCF and URDF, gives the same torques, the same moment on its base, and the same
# mass matrix there. The times are those of one core; the loops of the others run in Python.

# %%
import time

import mujoco
import numpy as np
import pinocchio as pin
import stillbase as sb

machine = sb.Machine.builtin("nine-link").set({"link.5.com": 0.05})
rng = np.random.default_rng(5)
q, qd, qdd = rng.normal(size=(3, 2000, 3))


def timed(name, states, work):
    """Prints how many states a second some work takes, and returns its result."""
    start = time.perf_counter()
    result = work()
    print(f"{name}: {states / (time.perf_counter() - start):.3g} states a second")
    return result


loads = timed("stillbase", len(q), lambda: machine.dynamics(q, qd, qdd))

# %% [markdown]
# ## MuJoCo
# A hinge turns by the angle of its own link, less that of the link it hangs on. The motion keeps the loops closed
# itself.

# %%
model = mujoco.MjModel.from_xml_string(machine.to_mjcf(quiet=True))
model.opt.disableflags = mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
drives = {f"link_{link['name']}": machine.drives.index(link["drive"]) for link in machine.to_dict()["link"]}
hinges = np.zeros((model.nv, 3))
for body in range(model.nbody):
    if model.body_dofnum[body] > 0:
        row, parent = hinges[model.body_dofadr[body]], model.body(model.body_parentid[body]).name
        row[drives[model.body(body).name]] += 1
        if parent in drives:
            row[drives[parent]] -= 1


def by_mujoco():
    """Returns torques of the drives and moments on the base, N m."""
    data, torques, moments = mujoco.MjData(model), np.empty_like(q), np.empty(len(q))
    for i in range(len(q)):
        data.qpos[:], data.qvel[:], data.qacc[:] = hinges @ q[i], hinges @ qd[i], hinges @ qdd[i]
        mujoco.mj_inverse(model, data)
        # The sensor reads what holds the machine.
        torques[i], moments[i] = hinges.T @ data.qfrc_inverse, -data.sensor("base moment").data[2]
    return torques, moments


torques, moments = timed("MuJoCo", len(q), by_mujoco)
off = np.abs(torques - loads.torque).max(), np.abs(moments - loads.base_moment).max()
print(f"torques differ by up to {off[0]:.1e} N m, moments by {off[1]:.1e} N m")
assert max(off) < 1e-6 * np.abs(loads.torque).max()

# %% [markdown]
# ## Pinocchio
# The URDF leaves loops out; joints that mimic others keep them closed. The mass matrix of the motors is left.

# %%
with open("nine-link.urdf", "w", encoding="utf-8") as file:
    file.write(machine.to_urdf(quiet=True))
urdf = pin.buildModelFromUrdf("nine-link.urdf", mimic=True)
motors = [urdf.joints[urdf.getJointId(f"drive_{k}")].idx_v for k in machine.drives]


def by_pinocchio():
    """Returns the mass matrices, kg m²."""
    data, matrices = urdf.createData(), np.empty((len(q), 3, 3))
    for i, angles in enumerate(q):
        rates = np.zeros(urdf.nv)
        rates[motors] = angles
        upper = np.triu(pin.crba(urdf, data, pin.integrate(urdf, pin.neutral(urdf), rates)))
        matrices[i] = (upper + np.triu(upper, 1).T)[np.ix_(motors, motors)]
    return matrices


matrices = timed("Pinocchio", len(q), by_pinocchio)
# Columns of the mass matrix are torques of unit accelerations from rest.
own = timed("stillbase", 3 * len(q), lambda: machine.dynamics(q[:, None], np.zeros(3), np.eye(3)).torque)
off = np.abs(matrices - own).max()
print(f"mass matrices differ by up to {off:.1e} kg m²")
assert off < 1e-6 * np.abs(own).max()

# %% [markdown]
# ## Forward in time
# A second of free motion, for all states at once.

# %%
steps = 1000
advance = lambda: machine.step_batch(q, qd, np.zeros(3), 1e-3, steps=steps)
after, rates = timed(f"stillbase, {steps} steps each", steps * len(q), advance)


def momentum(q, qd):
    """Returns the angular momentum about the base, kg m²/s: less the moment of the rates as accelerations from rest."""
    return -machine.dynamics(q, 0 * qd, qd).base_moment


drift = np.abs(momentum(after, rates) - momentum(q, qd)).max()
print(f"angular momentum drifts by up to {drift:.1e} kg m²/s")
assert drift < 1e-9
