"""STEP and IGES files made of text: flat facets and bilinear patches, from one rectangle to thousands."""

from __future__ import annotations

import numpy as np

STEP_UNITS = {
    "mm": "(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.))",
    "m": "(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT($,.METRE.))",
}
IGES_UNITS = {"in": (1, "IN"), "mm": (2, "MM"), "m": (6, "M")}


def step_rectangle(length: float, width: float, unit: str = "mm") -> str:
    """STEP AP214 text of a rectangle in the plane z = 0; lengths in the unit."""
    corners = [(0, 0, 0), (length, 0, 0), (length, width, 0), (0, width, 0)]
    return step_facets(np.array(corners, float), [(0, 1, 2, 3)], unit)


def step_facets(points: np.ndarray, facets: list[tuple[int, ...]], unit: str = "mm") -> str:
    """STEP AP214 text of flat facets (corner numbers, counter-clockwise) that share edges; lengths in the unit."""
    rows: list[str] = []

    def add(text: str) -> str:
        rows.append(f"#{len(rows) + 1}={text};")
        return f"#{len(rows)}"

    def triple(v: np.ndarray) -> str:
        return ",".join(repr(float(x)) for x in v)

    def point(v: np.ndarray) -> str:
        return add(f"CARTESIAN_POINT('',({triple(v)}))")

    def direction(v: np.ndarray) -> str:
        return add(f"DIRECTION('',({triple(v / np.linalg.norm(v))}))")

    def placed(at: np.ndarray, normal: np.ndarray, along: np.ndarray) -> str:
        return add(f"AXIS2_PLACEMENT_3D('',{point(at)},{direction(normal)},{direction(along)})")

    placement = placed(*np.array([[0.0, 0, 0], [0, 0, 1], [1, 0, 0]]))
    vertices = [add(f"VERTEX_POINT('',{point(v)})") for v in points]
    edges: dict[tuple[int, int], str] = {}
    faces = []
    for facet in facets:
        around = []
        for a, b in zip(facet, (*facet[1:], facet[0]), strict=True):
            low, high = min(a, b), max(a, b)
            if (low, high) not in edges:
                vector = add(f"VECTOR('',{direction(points[high] - points[low])},1.)")
                line = add(f"LINE('',{point(points[low])},{vector})")
                edges[low, high] = add(f"EDGE_CURVE('',{vertices[low]},{vertices[high]},{line},.T.)")
            around.append(add(f"ORIENTED_EDGE('',*,*,{edges[low, high]},.{'T' if a < b else 'F'}.)"))
        loop = add(f"EDGE_LOOP('',({','.join(around)}))")
        bound = add(f"FACE_OUTER_BOUND('',{loop},.T.)")
        a, b, c = (points[n] for n in facet[:3])
        plane = add(f"PLANE('',{placed(a, np.cross(b - a, c - a), b - a)})")
        faces.append(add(f"ADVANCED_FACE('',({bound}),{plane},.T.)"))
    shell = add(f"OPEN_SHELL('',({','.join(faces)}))")
    model = add(f"SHELL_BASED_SURFACE_MODEL('',({shell}))")
    length_unit = add(STEP_UNITS[unit])
    angle_unit = add("(NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.))")
    solid_unit = add("(NAMED_UNIT(*) SI_UNIT($,.STERADIAN.) SOLID_ANGLE_UNIT())")
    accuracy = add(
        f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-7),{length_unit},'distance_accuracy_value','')"
    )
    context = add(
        "(GEOMETRIC_REPRESENTATION_CONTEXT(3) "
        f"GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(({accuracy})) "
        f"GLOBAL_UNIT_ASSIGNED_CONTEXT(({length_unit},{angle_unit},{solid_unit})) "
        "REPRESENTATION_CONTEXT('',''))"
    )
    shape = add(f"MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',({placement},{model}),{context})")
    application = add("APPLICATION_CONTEXT('automotive_design')")
    product_context = add(f"PRODUCT_CONTEXT('',{application},'mechanical')")
    product = add(f"PRODUCT('part','part','',({product_context}))")
    formation = add(f"PRODUCT_DEFINITION_FORMATION('','',{product})")
    definition_context = add(f"PRODUCT_DEFINITION_CONTEXT('part definition',{application},'design')")
    definition = add(f"PRODUCT_DEFINITION('design','',{formation},{definition_context})")
    definition_shape = add(f"PRODUCT_DEFINITION_SHAPE('','',{definition})")
    add(f"SHAPE_DEFINITION_REPRESENTATION({definition_shape},{shape})")
    return "\n".join(
        [
            "ISO-10303-21;",
            "HEADER;",
            "FILE_DESCRIPTION((''),'2;1');",
            "FILE_NAME('','',(''),(''),'','','');",
            "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));",
            "ENDSEC;",
            "DATA;",
            *rows,
            "ENDSEC;",
            "END-ISO-10303-21;",
            "",
        ]
    )


def iges_rectangle(length: float, width: float, unit: str = "mm") -> str:
    """IGES 5.3 text of a rectangle in the plane z = 0 as one bilinear surface; lengths in the unit."""
    return iges_patches(np.array([[[0, 0, 0], [length, 0, 0], [0, width, 0], [length, width, 0]]], float), unit)


def iges_patches(corners: np.ndarray, unit: str = "mm") -> str:
    """IGES 5.3 text of bilinear B-spline surfaces (entity 128), corners (k, 4, 3) at 00, 10, 01, 11; in the unit."""
    flag, name = IGES_UNITS[unit]
    header = (
        f"1H,,1H;,4Hpart,8Hpart.igs,4Hnone,4Hnone,32,38,6,308,15,4Hpart,1.,{flag},{len(name)}H{name},1,0.01,"
        "15H20000101.000000,1.E-7,1000.,4Hnone,4Hnone,11,0,15H20000101.000000;"
    )
    wrapped = _wrapped(header, 72)
    lines = [f"{'patches':<72}S{1:>7}", *(f"{text:<72}G{i:>7}" for i, text in enumerate(wrapped, 1))]
    entries: list[str] = []
    parameters: list[str] = []
    for n, patch in enumerate(corners):
        values = "128,1,1,1,1,0,0,1,0,0,0.,0.,1.,1.,0.,0.,1.,1.,1.,1.,1.,1.,"
        values += ",".join(repr(float(x)) for x in patch.ravel()) + ",0.,1.,0.,1.;"
        rows = _wrapped(values, 64)
        first = len(parameters) + 1
        entries.append("".join(f"{x:>8}" for x in (128, first, 0, 0, 0, 0, 0, 0)) + "00000000" + f"D{2 * n + 1:>7}")
        entries.append("".join(f"{x:>8}" for x in (128, 0, 0, len(rows), 0, "", "", "", 0)) + f"D{2 * n + 2:>7}")
        parameters += [f"{text:<64}{2 * n + 1:>8}P{i:>7}" for i, text in enumerate(rows, first)]
    counts = f"S{1:>7}G{len(wrapped):>7}D{len(entries):>7}P{len(parameters):>7}"
    return "\n".join([*lines, *entries, *parameters, counts.ljust(72) + f"T{1:>7}", ""])


def _wrapped(text: str, width: int) -> list[str]:
    """Break at commas so that no number is cut."""
    lines, line = [], ""
    for word in text.replace(",", ",\n").split("\n"):
        if len(line) + len(word) > width:
            lines.append(line)
            line = ""
        line += word
    return [*lines, line]
