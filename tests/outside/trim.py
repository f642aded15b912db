"""Least squares of first moments, couplings and momenta from measured base forces, by NumPy and SciPy."""

import json
import sys

import numpy as np
import scipy.linalg

for line in sys.stdin:
    asked = json.loads(line)
    gravity = complex(*asked["gravity"])
    forces, moments, columns_force, columns_moment = [], [], [], []
    for motion in asked["motions"]:
        q, qd, qdd = (np.array(motion[key]).T for key in ("q", "qd", "qdd"))
        n = len(q)
        e = np.exp(1j * q)
        # Second derivatives of the unit vectors.
        turned = (1j * qdd - qd**2) * e
        pairs = [(k, l) for k in range(n) for l in range(k + 1, n)]
        units = (1, 1j)
        # A mass m at r = sum of a_k e_k pulls with -m r'' and turns with -Im(conj(r) m r'').
        force = [-unit * turned[k] for k in range(n) for unit in units]
        force += [np.zeros_like(e[0])] * (2 * len(pairs) + n)
        moment = [(np.conj(unit * e[k]) * gravity).imag for k in range(n) for unit in units]
        for k, l in pairs:
            for c in units:
                moment.append(-(np.conj(e[k]) * c * turned[l] + np.conj(c * e[l]) * turned[k]).imag)
        moment += [-qdd[k] for k in range(n)]
        # Sensors have an offset and a drift in each motion: a straight line over time is taken out of every row.
        time = np.array(motion["t"])
        line = np.column_stack([np.ones_like(time), time])
        straight = lambda row: row - line @ np.linalg.lstsq(line, row, rcond=None)[0]
        centred = lambda rows: np.array([straight(row) for row in rows]).T
        columns_force.append(centred(force))
        columns_moment.append(centred(moment))
        measured = np.array(motion["force"]) @ np.array([1, 1j])
        forces.append(straight(measured))
        read = np.array(motion["moment"])
        moments.append(straight(read))
    force, moment = np.vstack(columns_force), np.vstack(columns_moment)
    x = [np.vstack([force.real, force.imag]), moment]
    y = [np.concatenate([np.concatenate(forces).real, np.concatenate(forces).imag]), np.concatenate(moments)]
    sigma = [1.0, 1.0]
    for _ in range(20):
        found, _, _, _ = scipy.linalg.lstsq(
            np.vstack([x[0] / sigma[0], x[1] / sigma[1]]), np.concatenate([y[0] / sigma[0], y[1] / sigma[1]])
        )
        sigma = [float(np.sqrt(np.mean((y[i] - x[i] @ found) ** 2))) for i in range(2)]
    print(json.dumps({"found": found.tolist(), "sigma": sigma}), flush=True)
