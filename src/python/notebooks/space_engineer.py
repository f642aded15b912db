# %% [markdown]
# # How heavy must the spacecraft be?
#
# The arm of SPOT, a simulator of spacecraft on air bearings, is not balanced. Led in joint space, it turns its base;
# led at zero momentum, it does not. The heavier the base, the less it matters.

# %%
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import stillbase as sb

spot = sb.Machine.builtin("spot")
print(f"{spot}, balanced: {spot.check()['force_balanced']}")

# %% [markdown]
# ## A sweep over the mass of the base
# The inertia of the base grows with its mass: its size stays.

# %%
MASS, INERTIA = 11.211, 0.20215  # kg, kg m², as built
rows = []
for factor in np.geomspace(0.5, 16, 6):
    base = {"base.mass": factor * MASS, "base.inertia": factor * INERTIA}
    for scenario in ("spot", "spot-swing"):
        run = sb.simulate(scenario, set=base, every=20)
        turned = np.rad2deg(run.verdict["base_angle"])
        shifted = 1e3 * run.verdict["base_shift"]
        rows.append({"mass kg": factor * MASS, "scenario": scenario, "turned deg": turned, "shifted mm": shifted})
table = pd.DataFrame(rows)
wide = table.pivot(index="mass kg", columns="scenario")
print(wide.round(4).to_string())

# %%
figure, axes = plt.subplots(ncols=2, figsize=(9, 4))
wide["turned deg"]["spot-swing"].plot(ax=axes[0], marker="o", logx=True, logy=True, ylabel="the base turns by, °")
wide["shifted mm"].plot(ax=axes[1], marker="o", logx=True, logy=True, ylabel="the base shifts by, mm")
figure.tight_layout()
figure.savefig("base.svg")
silent, swung = wide["turned deg"]["spot"], wide["turned deg"]["spot-swing"]
assert (silent < 1e-6).all() and (swung.diff().dropna() < 0).all()

# %% [markdown]
# ## One run
# The table of a run, and its signals.

# %%
run = sb.simulate("spot-swing")
columns = {f"{path} {run.units[path]}": run[path] for path in ("attitude/base", "moment/total")}
signals = pd.DataFrame(columns, index=run.time)
print(signals.abs().max().to_string())
run
