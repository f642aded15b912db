"""Weighs what is cut from the drawings on standard input, one JSON object a line; answers with the residuals of (7), (8).

Outlines, holes and discs are taken from the DXF alone; the question adds thicknesses, densities, the pins of each link
by which its root is found on the sheet, and how its root moves with the drives.
"""

import io
import json
import math
import sys

import ezdxf


def moments(edge):
    """Area, centre and polar moment about the origin of a closed polygon, mm."""
    area = sx = sy = polar = 0.0
    for (x0, y0), (x1, y1) in zip(edge, edge[1:] + edge[:1]):
        cross = x0 * y1 - x1 * y0
        area += cross / 2
        sx += cross * (x0 + x1) / 6
        sy += cross * (y0 + y1) / 6
        polar += cross * (x0 * x0 + x0 * x1 + x1 * x1 + y0 * y0 + y0 * y1 + y1 * y1) / 12
    return (area, sx, sy, polar) if area > 0 else (-area, -sx, -sy, -polar)


def points_of(outline):
    """The corners of a closed outline; half circles as chords of a thousandth of a turn, not as Bézier curves."""
    edge = []
    for side in outline.virtual_entities():
        if side.dxftype() == "LINE":
            points = [(side.dxf.start.x, side.dxf.start.y), (side.dxf.end.x, side.dxf.end.y)]
        else:
            first, last = side.dxf.start_angle, side.dxf.end_angle
            turn = (last - first) % 360 or 360
            at = [math.radians(first + turn * i / 4000) for i in range(4001)]
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


for line in sys.stdin:
    asked = json.loads(line)
    space = ezdxf.read(io.StringIO(asked["dxf"])).modelspace()
    edges = [points_of(outline) for outline in space.query("POLYLINE")]
    circles = [(c.dxf.layer, c.dxf.center.x, c.dxf.center.y, c.dxf.radius) for c in space.query("CIRCLE")]
    assert len(edges) == len(asked["links"]), (len(edges), len(asked["links"]))
    drives = asked["drives"]
    first = [0j] * drives
    coupling = [[0j] * drives for _ in range(drives)]
    masses = []
    for edge, link in zip(edges, asked["links"]):
        holes = sorted((x, y, r) for layer, x, y, r in circles if layer == "HOLES" and inside((x, y), edge))
        pins = [1e3 * at for at in link["pins"]]
        assert len(holes) == len(pins), (link, holes)
        # The pins are in ascending order, as are the holes on the axis of the link.
        root = (holes[0][0] - pins[0], holes[0][1])
        assert all(abs(h[0] - root[0] - pin) < 1e-4 and abs(h[1] - root[1]) < 1e-6 for h, pin in zip(holes, pins))
        here = lambda x, y: (x - root[0], y - root[1])
        plate = asked["thickness"] * asked["density"]
        total = [plate * 1e-6 * x for x in moments([here(*p) for p in edge])]
        for x, y, r in holes:
            total = [a - plate * 1e-6 * b for a, b in zip(total, disc(*here(x, y), r))]
        # Only the discs of this link lie near its axis.
        low, high = min(p[1] for p in edge), max(p[1] for p in edge)
        left, right = min(p[0] for p in edge), max(p[0] for p in edge)
        heavy = asked["disc_thickness"] * asked["disc_density"]
        for layer, x, y, r in circles:
            if layer == "COUNTERWEIGHT" and left <= x <= right and low - 1e-6 <= y <= high + 1e-6:
                total = [a + heavy * 1e-6 * b for a, b in zip(total, disc(*here(x, y), r))]
        for m, at, across in link["lumps"]:
            total = [a + b for a, b in zip(total, [m, 1e3 * m * at, 1e3 * m * across, 0.0])]
        mass, sx, sy = total[0], total[1] * 1e-3, total[2] * 1e-3
        masses.append([mass, sx, sy])
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
    print(json.dumps({
        "force": max(abs(g) for g in first),
        "coupling": max([abs(coupling[k][l]) for k in range(drives) for l in range(drives) if k != l] or [0.0]),
        "masses": masses,
    }), flush=True)
