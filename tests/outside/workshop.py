"""Weighs what is cut from the drawings on standard input, one JSON object a line; answers with the masses of the links
and the residuals of (7), (8).

Outlines, holes and discs are taken from the DXF alone, materials, thicknesses and lumps from the parts list. The
question adds densities of materials, thickness and density of discs, which row of the list each outline is, the holes by
which the root of a link is found on the sheet, and how its root moves with the drives. A piece without holes lies where
the parts list has its centre of mass.
"""

import csv
import io
import json
import math
import sys

import ezdxf


CHORDS = 20000


def moments(edge):
    """Area, first moments and polar moment about the origin of a closed polygon, mm."""
    area = sx = sy = polar = 0.0
    for (x0, y0), (x1, y1) in zip(edge, edge[1:] + edge[:1]):
        cross = x0 * y1 - x1 * y0
        area += cross / 2
        sx += cross * (x0 + x1) / 6
        sy += cross * (y0 + y1) / 6
        polar += cross * (x0 * x0 + x0 * x1 + x1 * x1 + y0 * y0 + y0 * y1 + y1 * y1) / 12
    return (area, sx, sy, polar) if area > 0 else (-area, -sx, -sy, -polar)


def points_of(outline):
    """The corners of a closed outline; half circles as chords, not as Bézier curves: so many that a heavy one is off by less than 1e-7 kg m."""
    edge = []
    for side in outline.virtual_entities():
        if side.dxftype() == "LINE":
            points = [(side.dxf.start.x, side.dxf.start.y), (side.dxf.end.x, side.dxf.end.y)]
        else:
            first, last = side.dxf.start_angle, side.dxf.end_angle
            turn = (last - first) % 360 or 360
            at = [math.radians(first + turn * i / CHORDS) for i in range(CHORDS + 1)]
            (x, y, _), r = side.dxf.center, side.dxf.radius
            points = [(x + r * math.cos(a), y + r * math.sin(a)) for a in at]
        if edge and math.dist(edge[-1], points[0]) > math.dist(edge[-1], points[-1]):
            points.reverse()
        edge += points
    return edge


def inside(point, edge):
    x, y = point
    count = 0
    for (x0, y0), (x1, y1) in zip(edge, edge[1:] + edge[:1]):
        if (y0 > y) != (y1 > y) and x < x0 + (y - y0) / (y1 - y0) * (x1 - x0):
            count += 1
    return count % 2 == 1


def disc(x, y, radius):
    area = math.pi * radius * radius
    return area, area * x, area * y, area * (x * x + y * y + radius * radius / 2)


def plus(total, other, factor):
    """Adds moments of a plate, mm, times its mass per area, kg/m²."""
    return [a + factor * scale * b for a, b, scale in zip(total, other, (1e-6, 1e-9, 1e-9, 1e-12))]


def weigh(edge, holes, root, factor):
    """Mass, first moments and inertia about the root of a plate, kg, kg m, kg m²."""
    total = plus([0.0] * 4, moments([(x - root[0], y - root[1]) for x, y in edge]), factor)
    for x, y, r in holes:
        total = plus(total, disc(x - root[0], y - root[1], r), -factor)
    return total


for line in sys.stdin:
    asked = json.loads(line)
    space = ezdxf.read(io.StringIO(asked["dxf"])).modelspace()
    of_layer = lambda begin: [points_of(line) for line in space.query("POLYLINE") if line.dxf.layer.startswith(begin)]
    edges, shaped = iter(of_layer("OUTLINE")), of_layer("COUNTERWEIGHT")
    circles = [(c.dxf.layer, c.dxf.center.x, c.dxf.center.y, c.dxf.radius) for c in space.query("CIRCLE")]
    rows = list(csv.DictReader(io.StringIO(asked["csv"], newline="")))
    parts = [row for row in rows if row["part"] == "part"]
    lumps = [row for row in rows if row["part"] == "lump"]
    weights = [row for row in rows if row["part"] == "counterweight"]
    drives = asked["drives"]
    first = [0j] * drives
    coupling = [[0j] * drives for _ in range(drives)]
    masses = []
    for link in asked["links"]:
        total, sheet_root = [0.0] * 4, None
        for piece in link["pieces"]:
            edge, row = next(edges), parts[piece["row"]]
            assert row["on link"] == link["name"], (row, link)
            factor = float(row["thickness m"]) * asked["densities"][row["material"]]
            holes = sorted((x, y, r) for layer, x, y, r in circles if layer.startswith("HOLES") and inside((x, y), edge))
            given = sorted((1e3 * x, 1e3 * y) for x, y in piece["holes"])
            assert len(holes) == len(given), (link, holes)
            if holes:
                root = (holes[0][0] - given[0][0], holes[0][1] - given[0][1])
                for hole, at in zip(holes, given):
                    assert math.dist(hole[:2], (root[0] + at[0], root[1] + at[1])) < 1e-4, (link, holes)
            else:
                m, sx, sy, _ = weigh(edge, [], (0.0, 0.0), factor)
                root = (1e3 * (sx / m - float(row["centre of mass m"])), 1e3 * (sy / m - float(row["left of axis m"])))
            sheet_root = sheet_root or root
            total = [a + b for a, b in zip(total, weigh(edge, holes, root, factor))]
        for row in weights:
            if row["on link"] == link["name"]:
                at = [sheet_root[0] + 1e3 * float(row["place m"]), sheet_root[1] + 1e3 * float(row["left of axis m"])]
                heavy = asked["disc"]["thickness"] * asked["disc"]["density"]
                if row["shape"] in ("disc", "ring"):
                    near = [(x, y, r) for layer, x, y, r in circles if layer.startswith("COUNTERWEIGHT") and math.dist((x, y), at) < 1e-4]
                    sizes = [float(row[key]) for key in ("radius m", "inner radius m") if row[key]]
                    for size, sign in zip(sizes, (1, -1)):
                        x, y, r = next(found for found in near if abs(found[2] - 1e3 * size) < 1e-4)
                        total = plus(total, disc(x - sheet_root[0], y - sheet_root[1], r), sign * heavy)
                    continue
                # Half a ring or a box: the outline whose centre of mass is where the list says.
                def centre(edge):
                    area, sx, sy, _ = moments(edge)
                    return sx / area, sy / area
                edge = min(shaped, key=lambda edge: math.dist(centre(edge), at))
                assert math.dist(centre(edge), at) < 1e-2, (row, centre(edge), at)
                moved = [(x - sheet_root[0], y - sheet_root[1]) for x, y in edge]
                total = plus(total, moments(moved), heavy)
        for row in lumps:
            if row["on link"] == link["name"]:
                m, x, y, own = (float(row[key]) for key in ("mass kg", "centre of mass m", "left of axis m", "inertia kg m²"))
                total = [a + b for a, b in zip(total, [m, m * x, m * y, own + m * (x * x + y * y)])]
        mass, sx, sy, _ = total
        masses.append(total)
        along = link["sign"] * complex(sx, sy)
        # A mass at r on the link is at Σ a_k e(q_k); a_k is real but for the link's own drive.
        own = link["drive"]
        for k in range(drives):
            a = link["root"][k]
            first[k] += mass * a + (along if k == own else 0)
            for l in range(drives):
                if k != l:
                    b = link["root"][l]
                    coupling[k][l] += mass * a * b
                    if l == own:
                        coupling[k][l] += a * along
                    if k == own:
                        coupling[k][l] += along.conjugate() * b
    assert next(edges, None) is None, "an outline that no part has"
    print(json.dumps({
        "force": [abs(g) for g in first],
        "coupling": [abs(coupling[k][l]) for k in range(drives) for l in range(k + 1, drives)],
        "masses": masses,
    }), flush=True)
