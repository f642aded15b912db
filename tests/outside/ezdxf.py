"""What ezdxf reads of the drawings on standard input, one JSON string a line; answers in the same way."""

import io
import json
import sys

import ezdxf
from ezdxf import path
from ezdxf.math import area

for line in sys.stdin:
    drawing = ezdxf.read(io.StringIO(json.loads(line)))
    space = drawing.modelspace()
    outlines = []
    for outline in space.query("POLYLINE"):
        edge = list(path.make_path(outline).flattening(1e-4))
        across = [point.x for point in edge]
        outlines.append({
            "layer": outline.dxf.layer,
            "closed": bool(outline.is_closed),
            "area": abs(area(edge)),
            "length": max(across) - min(across),
        })
    print(json.dumps({
        "version": drawing.dxfversion,
        "errors": [str(error.message) for error in drawing.audit().errors],
        "units": drawing.units,
        "layers": sorted(layer.dxf.name for layer in drawing.layers),
        "kinds": sorted({entity.dxftype() for entity in space}),
        "outlines": outlines,
        "circles": [[c.dxf.layer, c.dxf.center.x, c.dxf.center.y, c.dxf.radius] for c in space.query("CIRCLE")],
        "texts": [text.plain_text() for text in space.query("TEXT")],
    }), flush=True)
