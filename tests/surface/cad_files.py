"""The smallest STEP and IGES files that hold a face: a flat rectangle in the plane z = 0."""

from __future__ import annotations

STEP_UNITS = {
    "mm": "(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.))",
    "m": "(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT($,.METRE.))",
}
IGES_UNITS = {"in": (1, "IN"), "mm": (2, "MM"), "m": (6, "M")}


def step_rectangle(length: float, width: float, unit: str = "mm") -> str:
    """STEP AP214 text of a rectangle; lengths in the unit."""
    corners = [(0, 0), (length, 0), (length, width), (0, width)]
    rows: list[str] = []

    def add(text: str) -> str:
        rows.append(f"#{len(rows) + 1}={text};")
        return f"#{len(rows)}"

    def point(x: float, y: float) -> str:
        return add(f"CARTESIAN_POINT('',({float(x)!r},{float(y)!r},0.))")

    def direction(x: float, y: float, z: float) -> str:
        return add(f"DIRECTION('',({float(x)!r},{float(y)!r},{float(z)!r}))")

    placement = add(f"AXIS2_PLACEMENT_3D('',{point(0, 0)},{direction(0, 0, 1)},{direction(1, 0, 0)})")
    vertices = [add(f"VERTEX_POINT('',{point(x, y)})") for x, y in corners]
    edges = []
    for i, (x, y) in enumerate(corners):
        nx, ny = corners[(i + 1) % 4]
        vector = add(f"VECTOR('',{direction(nx - x, ny - y, 0)},1.)")
        line = add(f"LINE('',{point(x, y)},{vector})")
        curve = add(f"EDGE_CURVE('',{vertices[i]},{vertices[(i + 1) % 4]},{line},.T.)")
        edges.append(add(f"ORIENTED_EDGE('',*,*,{curve},.T.)"))
    loop = add(f"EDGE_LOOP('',({','.join(edges)}))")
    bound = add(f"FACE_OUTER_BOUND('',{loop},.T.)")
    plane = add(f"PLANE('',{placement})")
    face = add(f"ADVANCED_FACE('',({bound}),{plane},.T.)")
    shell = add(f"OPEN_SHELL('',({face}))")
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
    """IGES 5.3 text of a rectangle as one bilinear B-spline surface (entity 128); lengths in the unit."""
    flag, name = IGES_UNITS[unit]
    start = ["rectangle"]
    numbers = "32,38,6,308,15"
    header = (
        f"1H,,1H;,4Hpart,8Hpart.igs,4Hnone,4Hnone,{numbers},4Hpart,1.,{flag},{len(name)}H{name},1,0.01,"
        "15H20000101.000000,1.E-7,1000.,4Hnone,4Hnone,11,0,15H20000101.000000;"
    )
    values = "128,1,1,1,1,0,0,1,0,0,0.,0.,1.,1.,0.,0.,1.,1.,1.,1.,1.,1.,"
    values += f"0.,0.,0.,{float(length)},0.,0.,0.,{float(width)},0.,{float(length)},{float(width)},0.,"
    values += "0.,1.,0.,1.;"
    parameters = _wrapped(values, 64)
    lines = [f"{text:<72}S{i:>7}" for i, text in enumerate(start, 1)]
    wrapped = _wrapped(header, 72)
    lines += [f"{text:<72}G{i:>7}" for i, text in enumerate(wrapped, 1)]
    lines.append("".join(f"{x:>8}" for x in (128, 1, 0, 0, 0, 0, 0, 0)) + "00000000" + f"D{1:>7}")
    lines.append("".join(f"{x:>8}" for x in (128, 0, 0, len(parameters), 0, "", "", "", 0)) + f"D{2:>7}")
    lines += [f"{text:<64}{1:>8}P{i:>7}" for i, text in enumerate(parameters, 1)]
    lines.append(f"S{1:>7}G{len(wrapped):>7}D{2:>7}P{len(parameters):>7}".ljust(72) + f"T{1:>7}")
    return "\n".join([*lines, ""])


def _wrapped(text: str, width: int) -> list[str]:
    """Break at commas so that no number is cut."""
    lines, line = [], ""
    for word in text.replace(",", ",\n").split("\n"):
        if len(line) + len(word) > width:
            lines.append(line)
            line = ""
        line += word
    return [*lines, line]
