"""flat.dxf: the flat pattern in true scale as DXF R2010 in mm, for cutters and CAD."""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geomdrap.export.drawing import Drawing, Layer, flat_drawing
from geomdrap.export.whole import write_whole

if TYPE_CHECKING:
    from geomdrap.fields import Drape

MILLIMETRES = 4
METRIC = 1


def write(result: Drape, path: Path) -> None:
    """Write the flat pattern as DXF; the same bytes for the same drape. Raises GeomdrapError if it cannot."""
    write_whole(path, dxf_text(flat_drawing(result)))


def dxf_text(drawing: Drawing) -> str:
    """The drawing as the text of a DXF file."""
    import ezdxf

    with fixed_metadata():
        document = ezdxf.new("R2010", units=MILLIMETRES)
        document.header["$MEASUREMENT"] = METRIC
        for layer in drawing.layers:
            add_layer(document, layer)
        set_window(document, drawing)
        sort_classes(document)
        stream = io.StringIO()
        document.write(stream)
    return stream.getvalue()


def add_layer(document: Any, layer: Layer) -> None:
    """Make the layer and draw what is on it into the model space."""
    document.layers.add(layer.name, color=layer.aci)
    space = document.modelspace()
    attributes = {"layer": layer.name}
    for line in layer.polylines:
        space.add_lwpolyline(line.points.tolist(), format="xy", close=line.closed, dxfattribs=attributes)
    for text in layer.texts:
        space.add_text(text.words, height=text.height, dxfattribs={**attributes, "insert": text.at})


def set_window(document: Any, drawing: Drawing) -> None:
    """Make CAD programs open the file with the whole drawing in sight."""
    width, height = (float(x) for x in drawing.upper - drawing.lower)
    middle = 0.5 * (drawing.lower + drawing.upper)
    lower, upper = ((float(x), float(y), 0.0) for x, y in (drawing.lower, drawing.upper))
    document.modelspace().reset_extents(lower, upper)
    document.set_modelspace_vport(
        height=round(1.05 * max(height, 0.5 * width), 6), center=[round(float(x), 6) for x in middle]
    )


def sort_classes(document: Any) -> None:
    """List the classes by name: ezdxf takes them from a set, whose order changes from one process to the next."""
    section = document.classes
    section.add_required_classes(document.dxfversion)
    section.classes = dict(sorted(section.classes.items()))


@contextmanager
def fixed_metadata() -> Iterator[None]:
    """Let ezdxf write constants for dates, its version and random identities: equal input, equal bytes."""
    import ezdxf

    before = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = before
