"""coupon.png: force and shear against displacement for all cases, and the tension of the yarns at the end of one."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geomdrap.export import palette
from geomdrap.export.compare_picture import save

if TYPE_CHECKING:
    from geomdrap.forming.coupon import Coupon

COLOURS = ("#1b4965", "#b3541e", "#5b2a86", "#2f7d4f", "#8a6d00", "#c8322b", "#5f7381", "#111111")
FLAT = 2.5
"""Times the median of the largest forces beyond which the largest would leave the other curves flat."""
NO_TENSION = 1e-6
"""N/mm of yarn tension that is rounding."""
STYLES = ("-", "--", ":", "-.")
NAMES = {"force": "force", "force_warp": "warp", "force_weft": "weft"}
UNITS = {"angle": "°", "speed": " mm/min", "undulation": ""}


def write(coupons: Sequence[Coupon], path: Path) -> None:
    """Write coupon.png; no date or path in it. GeomdrapError if it cannot be written."""
    save(figure_of(coupons), path)


def figure_of(coupons: Sequence[Coupon]) -> Any:
    """The page: two plots of curves, two maps of tension."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13.0, 5.4), dpi=110, facecolor=palette.PAPER, layout="constrained")
    force, shear, warp, weft = figure.subplots(1, 4, width_ratios=(1.5, 1.2, 0.75, 0.75))
    _curves(force, shear, coupons)
    shown = coupons[-1]
    _maps(figure, (warp, weft), shown, label_of(shown, coupons))
    figure.suptitle(_title(coupons), fontsize=12, color=palette.INK)
    return figure


def _title(coupons: Sequence[Coupon]) -> str:
    fixed = {k: v for k, v in _settings(coupons[0]).items() if k not in _changing(coupons)}
    words = [f"{key} {value:g}{UNITS[key]}" for key, value in fixed.items()]
    return ", ".join([f"{coupons[0].test} test", *words])


def _settings(coupon: Coupon) -> dict[str, float]:
    cloth = coupon.result.specimen.cloth
    return {**{k: v for k, v in coupon.settings.items() if k in UNITS}, "undulation": cloth.warp.undulation}


def _changing(coupons: Sequence[Coupon]) -> list[str]:
    """Settings in which the cases differ."""
    return [key for key in UNITS if len({_settings(c).get(key) for c in coupons}) > 1]


def label_of(coupon: Coupon, coupons: Sequence[Coupon]) -> str:
    """What tells a case from the others."""
    settings = _settings(coupon)
    return ", ".join(f"{key} {settings[key]:g}{UNITS[key]}" for key in _changing(coupons))


def _curves(force: Any, shear: Any, coupons: Sequence[Coupon]) -> None:
    for number, coupon in enumerate(coupons):
        pulled, colour, label = coupon.result, COLOURS[number % len(COLOURS)], label_of(coupon, coupons)
        for (name, values), style in zip(pulled.forces.items(), STYLES, strict=False):
            words = ", ".join(w for w in (label, NAMES[name] if len(pulled.forces) > 1 else "") if w)
            force.plot(pulled.displacement, values, style, color=colour, label=words or None)
        marker = "o" if len(pulled.displacement) < 15 else None
        shear.plot(pulled.displacement, pulled.shear, color=colour, marker=marker, label=label or None)
    force.set(xlabel="displacement [mm]", ylabel="force [N]")
    shear.set(xlabel="displacement [mm]", ylabel="shear in the middle [deg]")
    for axes in (force, shear):
        axes.set_xlim(left=0.0)
        bare(axes)
    force.set_ylim(bottom=0.0, top=_top(coupons))
    if max(float(np.nanmax(np.abs(c.result.shear))) for c in coupons) < 1.0:
        shear.set_ylim(-1.0, 1.0)  # rounding must not look like shear
    if force.get_legend_handles_labels()[0]:
        force.legend(frameon=False, fontsize=8.5)


def bare(axes: Any) -> None:
    """Hide all sides of a plot but the left and the lower one."""
    for name, side in axes.spines.items():
        side.set_visible(name in ("left", "bottom"))


def _top(coupons: Sequence[Coupon]) -> float:
    """The end of the force scale: the largest force, or the median of the cases' where that is far below."""
    largest = [max(float(np.nanmax(f)) for f in c.result.forces.values()) for c in coupons]
    top, middle = max(largest), float(np.median(largest))
    return 1.05 * (top if top < FLAT * middle else middle) if top > 0.0 else 1.0


def _maps(figure: Any, both: Sequence[Any], coupon: Coupon, label: str) -> None:
    from matplotlib.collections import LineCollection

    from geomdrap.forming.specimen import tensions

    ends, tension, family = tensions(coupon.result)
    for number, (axes, name) in enumerate(zip(both, ("warp", "weft"), strict=True)):
        mine = family == number
        top = float(np.max(tension[mine], initial=0.0))
        lines = LineCollection(ends[mine][:, :, :2], cmap="viridis_r", linewidths=1.4)
        lines.set_array(tension[mine])
        lines.set_clim(0.0, top if top > NO_TENSION else 1.0)
        axes.add_collection(lines)
        axes.autoscale_view()
        axes.set_aspect("equal")
        axes.set_axis_off()
        words = (f"tension, {name} [N/mm]", f"at {coupon.result.displacement[-1]:.3g} mm", label)
        axes.set_title("\n".join(line for line in words if line), fontsize=9, color=palette.INK)
        figure.colorbar(lines, ax=axes, orientation="horizontal", shrink=0.85, pad=0.02).ax.tick_params(labelsize=8)
