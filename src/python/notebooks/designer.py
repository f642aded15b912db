# %% [markdown]
# # Counterweights for an arm, and its links as a drawing
#
# The arm of nine links comes without counterweights. Which ones balance it? Lighter ones lie farther out, and make the
# arm harder to turn: a Pareto front shows the choice. Run this as a notebook with Jupytext, or as a script.

# %%
import matplotlib.pyplot as plt
import stillbase as sb

machine = sb.Machine.builtin("nine-link-bare")
machine

# %% [markdown]
# ## The front
# Each point is a set of counterweights of which none is both lighter and easier to turn. The computed optimum is
# certified: a bound from duality shows how far any other could be better.

# %%
front = machine.front(7)
mass, inertia = zip(*front["front"])
print(f"certified: {front['certified']}, gap {front['gap']:.1e}")
for point in front["front_points"]:
    print(f"{point['added_mass']:7.3f} kg   {point['inertia']:.4f} kg m²   workspace {point['workspace']:.4f} m²")

figure, axes = plt.subplots()
axes.plot(mass, inertia, "o-")
axes.set(xlabel="added mass, kg", ylabel="inertia, kg m²", title="What balance costs")
figure.savefig("front.svg")

# %% [markdown]
# ## The lightest one
# With a bound on one counterweight, the others make up for it.

# %%
lightest = machine.counterweights(output="balanced.toml", force=True)
bounded = machine.counterweights(max_mass={"1": 2.5})
print(f"lightest: {lightest['added_mass']:.3f} kg, with at most 2.5 kg on link 1: {bounded['added_mass']:.3f} kg")
balanced = sb.Machine.load("balanced.toml")
check = balanced.check()
print(f"balanced: {check['force_balanced']}, mass matrix constant: {check['invariant']}")
assert check["force_balanced"] and check["invariant"] and bounded["added_mass"] > lightest["added_mass"]

# %% [markdown]
# ## The links, to be cut
# DXF for the machine that cuts, and the same drawing here.

# %%
sb.ask("export-model", balanced, output="links.dxf", bar_width=0.03, pin_diameter=0.008, force=True, quiet=True)
balanced
