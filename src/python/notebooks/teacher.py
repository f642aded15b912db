# %% [markdown]
# # Figures 3 to 5 of the paper
#
# Papadopoulos & Abu-Abed, *On the Design of Zero Reaction Manipulators*. The arm of nine links is balanced: it exerts
# no force on its base. It exerts no moment either while its motion stays on a plane q₁ + λ₂ q₂ + λ₃ q₃ = b.

# %%
import matplotlib.pyplot as plt
import numpy as np
import stillbase as sb

machine = sb.Machine.builtin("nine-link")
A, B = (0.50, 0.50), (0.55, 0.90)  # m
machine.check()

# %% [markdown]
# ## Fig. 3: the angle of drive 1 against b, for two points
# Where both curves exist, both points are reached without a reaction.

# %%
figure, axes = plt.subplots()
for name, point in (("A", A), ("B", B)):
    for low, high in machine.reach([point])["points"][0]["intervals"]:
        b = np.linspace(low, high, 80)[1:-1]
        q1 = [machine.poses(point, x)["poses"][0]["q"][0] for x in b]
        axes.plot(b, np.unwrap(q1), label=f"{name} {point}")
low, high = machine.reach([A, B])["overlap"][0]
print(f"both points from b = {low:.4f} to {high:.4f} rad")
assert low < 2.4 < high
axes.axvspan(low, high, alpha=0.2)
axes.set(xlabel="b, rad", ylabel="q₁, rad")
axes.legend()
figure.savefig("fig-3.svg")

# %% [markdown]
# ## Fig. 4: the reactionless workspaces of two b
# A change of b turns the workspace.


# %%
def draw_workspace(axes, b):
    """Draws the boundary of the workspace of b, rad."""
    workspace = machine.workspace(b)
    for loop in workspace["loops"]:
        axes.plot(*zip(*loop, loop[0]), label=f"b = {b:.2f} rad, {workspace['area']:.4f} m²")
    return workspace["area"]


figure, axes = plt.subplots()
areas = [draw_workspace(axes, b) for b in (2.4, 3.4)]
assert np.isclose(*areas)
axes.plot(*zip(A, B), "k.")
axes.set(xlabel="x, m", ylabel="y, m", aspect="equal")
axes.legend()
figure.savefig("fig-4.svg")

# %% [markdown]
# ## Fig. 5: three motions from A to B
# Along a straight line in case 1, to another pose in case 2, and on one plane in case 3.

# %%
figure, axes = plt.subplots(nrows=2, ncols=3, sharex=True, sharey="row", figsize=(10, 5))
for case, (above, below) in zip(("case-1", "case-2", "case-3"), axes.T):
    run = sb.simulate(case)
    for drive in machine.drives:
        above.plot(run.time, run[f"torque/{drive}"], label=f"τ {drive}")
    below.plot(run.time, run["moment/total"], "r")
    above.set(title=case)
    below.set(xlabel="t, s")
    print(f"{case}: peak |n_B| {abs(run['moment/total']).max():.6f} N m")
assert run.verdict["reactionless"]
axes[0, 0].set(ylabel="torque, N m")
axes[1, 0].set(ylabel="moment on the base, N m")
axes[0, 2].legend()
figure.tight_layout()
figure.savefig("fig-5.svg")

# %% [markdown]
# ## Turn b by hand
# In a notebook with ipywidgets, a slider turns the workspace.


# %%
def turn(b=2.4):
    """Draws the workspace of b, rad, with the two points."""
    figure, axes = plt.subplots()
    draw_workspace(axes, b)
    axes.plot(*zip(A, B), "k.")
    axes.set(xlim=(-1.3, 1.3), ylim=(-1.3, 1.3), aspect="equal")
    axes.legend()


try:
    from ipywidgets import interact
except ImportError:
    turn()
else:
    interact(turn, b=(0.0, 6.28, 0.05))
