"""A real measurement that the pin-jointed model fails, and what it lacks: bias extension of a plain weave.

Usage: python samples/bias_extension.py [FOLDER]
Fits each effect to the shear up to 75 mm and lets it predict the rest, prints the story, and draws it in FOLDER.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from geomdrap.criticism.curve import EFFECTS, read_curves
from geomdrap.criticism.curve_verdict import THEORY, judge_curves

TABLE = Path(__file__).parent / "measurements" / "bias-extension-plain-weave.csv"
LENGTH, WIDTH = 450.0, 150.0  # mm, of the specimen
SPLIT = 75.0  # mm: fit up to here, predict the rest
SHADES = {"image": ("#1b4965", "#9fc5d8"), "hand": ("#b3541e", "#ecc19c")}  # held out, fitted


def compute():
    """The curves by series, and the verdict on them."""
    curves = read_curves(TABLE, LENGTH, WIDTH)
    return curves, judge_curves(curves, SPLIT)


def story(verdict):
    """The table of errors and the verdict with its doubt, as text."""
    lines = []
    for series, fits in verdict.fits.items():
        lines.append(f"{series:28}  rms    held out  values")
        for name, fit in fits.items():
            lines.append(f"  {name:26}  {fit.rms:5.2f}  {fit.held_rms:5.2f}     {values(fit)}")
    doubt = f"ambiguous: {' or '.join(dict.fromkeys(verdict.candidates.values()))}"
    lines.append(f"Verdict: {doubt if verdict.verdict == 'ambiguous' else verdict.verdict}")
    return "\n".join([*lines, *(f"  {reason}" for reason in verdict.reasons)])


def values(fit):
    """The fitted values with their units, and whether they are plausible."""
    pairs = zip(fit.effect.parameters, fit.values, strict=True)
    text = ", ".join(f"{p.name} {value:.3g} {p.unit}".strip() for p, value in pairs)
    return text if fit.plausible else f"{text} (not plausible, here or in the first part)"


def visualize(curves, verdict, path):
    """Left, the curves with the theory and the effects that win; right, the waterfall of errors."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13.0, 5.6), dpi=110, layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.25))
    draw_curves(left, curves, verdict)
    draw_waterfall(right, verdict)
    said = " or ".join(dict.fromkeys(verdict.candidates.values()))
    figure.suptitle(f"Bias extension, plain weave (Cao et al. 2008): {verdict.verdict}, {said}")
    figure.savefig(path)


def draw_curves(axes, curves, verdict):
    """Measured shear, the theory, and for each series the effect that foretells it best."""
    pull = np.linspace(0.0, 108.0, 200)
    length = LENGTH - WIDTH
    axes.plot(pull, EFFECTS[THEORY].model(pull, np.zeros(0), length), "k", label="pin-jointed theory")
    for (series, curve), marker in zip(curves.items(), "o^", strict=True):
        colour = SHADES[series][0]
        axes.plot(curve.displacement, curve.shear, marker, color=colour, markersize=4, label=f"measured, {series}")
        fit = verdict.fits[series][verdict.candidates[series]]
        line = fit.effect.model(pull, fit.held_values, length)
        axes.plot(pull, line, "--", color=colour, label=f"{fit.effect.name}, fitted to {series} up to {SPLIT:g} mm")
    axes.axvspan(SPLIT, 108.0, color="0.93", zorder=0)
    axes.text(SPLIT + 2.0, 2.0, "held out", color="0.4")
    axes.set(xlabel="displacement [mm]", ylabel="shear in the middle [deg]", xlim=(0.0, 108.0), ylim=(0.0, 58.0))
    axes.legend(loc="upper left", fontsize=8)


def draw_waterfall(axes, verdict):
    """Errors of each effect and series: of the fit to all points, and of the held-out ones."""
    names = list(EFFECTS)
    for n, (series, fits) in enumerate(verdict.fits.items()):
        strong, faint = SHADES[series]
        at = np.arange(len(names)) + 0.42 * n - 0.31
        held, all_ = ([getattr(fits[name], key) for name in names] for key in ("held_rms", "rms"))
        axes.barh(at, held, 0.2, color=strong, label=f"{series}: held out (above {SPLIT:g} mm)")
        axes.barh(at + 0.2, all_, 0.2, color=faint, label=f"{series}: fit to all points")
        for y, error, name in zip(at, held, names, strict=True):
            mark = "" if fits[name].plausible else " (values not plausible)"
            best = "  best" if name == verdict.candidates[series] else ""
            axes.text(error + 0.1, y, f"{error:.2f}{mark}{best}", va="center", fontsize=7)
    axes.axvline(1.0, color="0.5", linewidth=0.8, linestyle=":", label="two ways of reading agree to about 1°")
    axes.set(yticks=np.arange(len(names)), yticklabels=names, xlabel="root mean square error of the shear [deg]")
    axes.set(xlim=(0.0, 14.0))
    axes.invert_yaxis()
    axes.legend(loc="lower right", fontsize=8)


def main(folder):
    """Print the story and draw it."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    curves, verdict = compute()
    print(story(verdict))
    visualize(curves, verdict, folder / "bias-extension.png")


if __name__ == "__main__":
    if len(sys.argv) > 2:
        sys.exit("usage: python samples/bias_extension.py [FOLDER]")
    main(*(sys.argv[1:] or ["."]))
