"""The paper's statements on its test specimens, each beside what the mechanical model gives.

Usage: python samples/paper_tests.py
A. Cherouat and H. Borouchaki, Materials 2 (2009) 1835, sections 3.1 and 3.2. Prints a Markdown table: stated,
obtained, and the assumption that it rests on. Takes a few minutes.
"""

from __future__ import annotations

import numpy as np

from geomdrap.forming import RELAXATIONS, Cloth, Fibre, Resin
from geomdrap.forming.coupon import biaxial, uniaxial
from geomdrap.forming.specimen import tensions
from geomdrap.forming.uniaxial import kinematic_lock

CELLS = 14
ANGLES = (0.0, 15.0, 30.0, 45.0)


def pulled(angle=45.0, speed=20.0, undulation=0.005, relaxation="table"):
    """Displacement and force of a strip."""
    yarn = Fibre(undulation=undulation)
    cloth = Cloth(yarn, yarn, Resin(relaxation=RELAXATIONS[relaxation]))
    result = uniaxial(cloth, angle, speed, cells=CELLS).result
    return result.displacement, result.forces["force"]


def at(curve, displacement):
    """Force, N, at a displacement."""
    return float(np.interp(displacement, *curve))


def reached(curve, force):
    """Displacement, mm, at which a force is reached."""
    return float(np.interp(force, curve[1], curve[0]))


def slopes(curve, places):
    """Stiffness, N/mm, at displacements."""
    slope = np.gradient(curve[1], curve[0])
    return [float(np.interp(place, curve[0], slope)) for place in places]


def compute():
    """All curves: by angle, by speed with straight yarns for two readings of Table 1, and the biaxial tests."""
    angles = {angle: pulled(angle) for angle in ANGLES}
    speeds = {
        name: {speed: pulled(speed=speed, undulation=0.0, relaxation=name) for speed in (20.0, 40.0, 80.0)}
        for name in ("table", "creep")
    }
    knit = {ratio: biaxial(ratio=ratio, frames=20).result for ratio in (0.5, 1.0)}
    return angles, speeds, knit


def rows(angles, speeds, knit):
    """The table: stated, obtained, resting on."""
    oblique = angles[45.0]
    first, kinematic, hard, linear = slopes(oblique, (1.5, 15.0, 40.0, 52.0))
    yield (
        "four phases: viscoelastic, pseudo-kinematic, hardening, linear (45°)",
        f"stiffness {first:.0f}, {kinematic:.0f}, {hard:.0f}, {linear:.0f} N/mm at 1.5, 15, 40, 52 mm; "
        f"along the yarns it is {slopes(angles[0.0], (2.9,))[0]:.0f}",
        "the law of Eq. 5 read with its sign and −1 restored; yarn a quarter of the thickness each way",
    )
    yield (
        "the angle influences the response largely (figure 6: 0, 15, 30, 45°)",
        "at 2 mm "
        + ", ".join(f"{at(angles[a], 2.0):.0f}" for a in ANGLES)
        + " N; 10 kN at "
        + ", ".join(f"{reached(angles[a], 1e4):.1f}" for a in ANGLES)
        + " mm; yarns straight at "
        + ", ".join(f"{kinematic_lock(150.0, 30.0, a):.1f}" for a in ANGLES)
        + " mm",
        "clamps hold the full width; displacement and force scales of the figure are not known",
    )
    for name, words in (("table", "shares of a Prony series"), ("creep", "samples of a creep compliance")):
        curves = speeds[name]
        ratios = [[at(curves[v], d) / at(curves[20.0], d) for v in (40.0, 80.0)] for d in (3.0, 12.0, 45.0)]
        yield (
            "speed influences the first phase considerably (figure 7: 20, 40, 80 mm/min)",
            "F40/F20 and F80/F20 " + ", ".join(f"{a:.3f}/{b:.3f}" for a, b in ratios) + " at 3, 12, 45 mm",
            f"Table 1 read as {words}; straight yarns",
        )
    straight = speeds["table"][20.0]
    shift = reached(oblique, 1e4) - reached(straight, 1e4)
    yield (
        "undulation influences the total force (figure 8: 0 and 0.005, 45°)",
        f"at 45 mm {at(straight, 45.0):.0f} and {at(oblique, 45.0):.0f} N; 10 kN is reached {shift:.2f} mm later",
        "as printed, Eq. 5 would show no undulation: its exponent is a constant",
    )
    even, other = knit[1.0], knit[0.5]
    yield (
        "largest forces 620 N (warp) and 1,180 N (weft) at 140 mm (Table 2)",
        f"{even.forces['force_warp'][-1]:.0f} and {even.forces['force_weft'][-1]:.0f} N",
        "fitted, not foretold: moduli are in a thesis only; 20 × 20 cells between grips of 150 mm",
    )
    _, tension, family = tensions(even)
    top = [float(np.percentile(tension[family == k], 99)) for k in (0, 1)]
    yield (
        "the largest tension in the weft is twice that in the warp (figure 11)",
        f"{top[1]:.1f} over {top[0]:.1f} N/mm = {top[1] / top[0]:.2f} (99th percentiles)",
        "follows from the fitted forces",
    )
    yield (
        "the response depends strongly on the ratio of strains",
        f"warp force at 140 mm {even.forces['force_warp'][-1]:.0f} N at a ratio of 1, "
        f"{other.forces['force_warp'][-1]:.0f} N with half the opening on the weft",
        "yarns of warp and weft are coupled through the resin and the free corners only, not through their crimp",
    )


def main():
    """Print the table."""
    print("| stated | obtained | rests on |\n|---|---|---|")
    for row in rows(*compute()):
        print("| " + " | ".join(row) + " |", flush=True)


if __name__ == "__main__":
    main()
