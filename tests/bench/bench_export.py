"""CPU time of the report and of the hand-over to finite elements, beside that of the drape itself, in one run.

    python tests/bench/bench_export.py
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import geomdrap as gd
from geomdrap.export import cut_pdf, fe_abaqus, fe_nastran, report_html
from geomdrap.export.fe_mesh import mesh_of_part
from geomdrap.export.fe_read import read_fe_mesh
from geomdrap.export.map_onto import map_onto
from geomdrap.surface import samples


def seconds(work: Callable[[], object]) -> float:
    """CPU seconds of a second run: the first compiles and fills caches."""
    work()
    start = time.process_time()
    work()
    return time.process_time() - start


def main() -> None:
    """Print a table."""
    part = samples.build("hood", facets=55_000)
    result = gd.evaluate(gd.drape(part, angle=45.0, pitch=10.0))
    elements = mesh_of_part(samples.build("hood", facets=100_000))
    ply = map_onto(result, elements)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rows = [
            ("drape and evaluate", len(part.triangles), lambda: gd.evaluate(gd.drape(part, angle=45.0, pitch=10.0))),
            ("report.html", len(part.triangles), lambda: report_html.write(result, folder / "report.html")),
            ("cut.pdf", len(part.triangles), lambda: cut_pdf.write(result, folder / "cut.pdf")),
            ("map onto elements", len(elements.element_ids), lambda: map_onto(result, elements)),
            ("fe.inp", len(elements.element_ids), lambda: fe_abaqus.write(ply, folder / "fe.inp")),
            ("fe.bdf", len(elements.element_ids), lambda: fe_nastran.write(ply, folder / "fe.bdf")),
            ("read fe.inp", len(elements.element_ids), lambda: read_fe_mesh(folder / "fe.inp")),
            ("read fe.bdf", len(elements.element_ids), lambda: read_fe_mesh(folder / "fe.bdf")),
        ]
        print(f"{'step':<22}{'facets':>9}{'CPU s':>9}{'of drape':>10}")
        drape = None
        for words, facets, work in rows:
            spent = seconds(work)
            drape = drape or spent
            print(f"{words:<22}{facets:>9,}{spent:>9.2f}{spent / drape:>10.2f}")
        print(f"report.html: {(folder / 'report.html').stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
