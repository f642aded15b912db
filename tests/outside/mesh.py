"""Integrates over the solids of STL files on standard input, one file in a JSON string a line: of each solid its name,
volume, centre and second moment about the upright axis through its centre, mm. Each triangle with the origin is a
tetrahedron."""

import json
import re
import sys

import numpy as np

for line in sys.stdin:
    solids = []
    for name, body in re.findall(r"^solid (\S+)\n(.*?)^endsolid", json.loads(line), re.S | re.M):
        corners = np.array(re.findall(r"vertex (\S+) (\S+) (\S+)", body), dtype=float).reshape(-1, 3, 3)
        # About a corner of its own, so that no digits are lost far from the origin.
        about = corners[0, 0].copy()
        corners = corners - about
        a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
        volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
        volume = volumes.sum()
        centre = (volumes[:, None] * (a + b + c)).sum(0) / 4 / volume
        # ∫ x² over a tetrahedron with a corner at the origin: V/10 (Σ a² + Σ a b).
        squares = a * a + b * b + c * c + a * b + b * c + c * a
        second = (volumes[:, None] * squares).sum(0) / 10 - volume * centre**2
        solids.append([name, volume, *(centre + about), second[0] + second[1]])
    print(json.dumps(solids), flush=True)
