"""Tables that are held in memory, for commands that read them from files."""

from __future__ import annotations

import csv
import os
import tempfile
from typing import Any

from ._stillbase import Machine, Run, ask


def trim(measured: Any, machine: str | os.PathLike[str] | Machine, **given: Any) -> dict[str, Any]:
    """Identifies the unbalance of a built machine from measured base forces, as `stillbase trim` with its options.

    `measured` is a table or a list of tables: the name of a file, a DataFrame of pandas, a mapping of names to arrays
    of one axis, an array of NumPy with named fields, or a `Run`. Columns are named as those of a file are: t, q1, q2, ...,
    fx, fy, nz, with units as in "nz (mN m)".

    >>> import numpy as np, stillbase as sb
    >>> built, t = sb.Machine.builtin("nine-link").set({"link.5.com": 0.01}), np.arange(0, 6, 0.01)
    >>> k, rate = np.arange(1, 4), np.array([2.1, 2.9, 3.7])
    >>> at = np.outer(t, rate)
    >>> q, qd, qdd = np.cos(at) + k, -rate * np.sin(at), -rate**2 * np.cos(at)
    >>> loads = built.dynamics(q, qd, qdd)
    >>> rng = np.random.default_rng(3)
    >>> noisy = lambda x: x + rng.normal(scale=1e-3, size=len(t))
    >>> table = {"t": t, "nz": noisy(loads.base_moment)}
    >>> for i in range(3):
    ...     table |= {f"q{i + 1}": q[:, i], f"qd{i + 1}": qd[:, i], f"qdd{i + 1}": qdd[:, i]}
    >>> for name, force in zip(("fx", "fy"), loads.base_force.T):
    ...     table[name] = noisy(force)
    >>> answer = sb.trim(table, "nine-link")
    >>> [number["name"] for number in answer["numbers"] if number["off"]]
    ['g 2 along', 'C 1,2 along', 'D 2']
    """
    tables = measured if isinstance(measured, (list, tuple)) else [measured]
    with tempfile.TemporaryDirectory() as folder:
        files = [_file(table, os.path.join(folder, f"{i + 1}.csv")) for i, table in enumerate(tables)]
        return ask("trim", *files, machine, **given)


def _file(table: Any, name: str) -> str:
    """Returns the name of a file of a table, which is written under this name unless it is one already."""
    if isinstance(table, (str, os.PathLike)):
        return os.fspath(table)
    if hasattr(table, "to_csv"):
        # The time may be the index of a DataFrame.
        table.to_csv(name, index=table.index.name is not None)
        return name
    if isinstance(table, Run):
        columns = {"time s": table.time, **{f"{path} {table.units[path]}": table[path] for path in table.signals}}
    elif getattr(getattr(table, "dtype", None), "names", None):
        columns = {head: table[head] for head in table.dtype.names}
    elif hasattr(table, "keys"):
        columns = {head: table[head] for head in table.keys()}
    else:
        want = "the name of a file, a DataFrame, a mapping of names to arrays, an array with named fields, or a Run"
        raise TypeError(f"{type(table).__name__}: want {want}")
    rows = {head: len(values) for head, values in columns.items()}
    if len(set(rows.values())) > 1:
        raise ValueError(f"columns have {rows} rows: want the same number in each")
    with open(name, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        # As Python's own numbers, which are written to the last bit.
        writer.writerows(zip(*(getattr(values, "tolist", lambda: values)() for values in columns.values())))
    return name
