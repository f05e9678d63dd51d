"""``geomdrap drape --plies``: a stack of plies instead of one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from geomdrap.cli.roll import on_roll
from geomdrap.errors import interrupt_within

if TYPE_CHECKING:
    from geomdrap.cli.progress import Progress
    from geomdrap.export.map_onto import ElementPly
    from geomdrap.export.outputs import Extras
    from geomdrap.sweep import Ply


def drape_plies(
    plies: tuple[float, ...], extras: Extras, folder: Path, outputs: tuple[str, ...], strict: bool, as_json: bool,
    quiet: bool, *, roll_width: float | None = None, seam_overlap: float | None = None, **asked: Any,
) -> int:  # fmt: skip
    """Drape the plies of a stack, at these angles in degrees, write and print them; the exit code."""
    from geomdrap.cli.elements import ply_on
    from geomdrap.cli.messages import print_json, say
    from geomdrap.cli.progress import Progress, announce_compilation
    from geomdrap.export.plies_outputs import as_dict
    from geomdrap.export.report_json import is_incomplete
    from geomdrap.sweep import lay_plies

    thickness = extras.ply_thickness
    assert thickness is not None
    with Progress(quiet) as progress:
        surface, laid = _read(progress, lambda: announce_compilation(quiet), **asked)
        progress.step("Draping plies")
        stack = lay_plies(
            surface, plies, thickness, **laid, on_ply=lambda ply: progress.share(ply.number / len(plies))
        )
        stack = tuple(replace(ply, drape=on_roll(ply.drape, roll_width, seam_overlap)) for ply in stack)
        progress.step("Writing")
        elements = [ply_on(ply.drape, None, None, outputs) for ply in stack]
        files = _write(stack, extras, folder, outputs, progress, elements)
    doubts = [(*ply.drape.warnings, *(on.notes() if on else ())) for ply, on in zip(stack, elements, strict=True)]
    warnings = [*by_plies(doubts), *_left_over(folder, files)]
    notes = by_plies([ply.drape.net.notes for ply in stack])
    say(warnings, notes, quiet)
    if as_json:
        print_json({**as_dict(stack, thickness, files), "warnings": warnings, "notes": notes})
    elif not quiet:
        click.echo("\n".join(_summary(stack, thickness, folder if files else None)))
    return int(strict and any(is_incomplete(ply.drape) for ply in stack))


def _read(
    progress: Any,
    before_drape: Any,
    *,
    part: Path,
    unit: str,
    tolerance: float | None,
    flip: bool,
    cuts: tuple[Path, ...],
    pitch: float | None,
    blank: tuple[float, float] | None,
    effect_texts: tuple[str, ...],
    model: Path | None,
    plugins: tuple[Path, ...],
    **laid: Any,
) -> tuple[Any, dict[str, Any]]:
    """The part, and how plies are laid on it."""
    from geomdrap.cli.acting import effects_of
    from geomdrap.cli.part import read_part
    from geomdrap.cli.pitch import require_room

    effects = effects_of(effect_texts, model, plugins)
    progress.step("Reading")
    surface = read_part(part, unit, tolerance, flip, cuts)
    if pitch is not None:
        require_room(surface, pitch)
    before_drape()
    reach = (blank[0] / 2, blank[1] / 2) if blank else None
    return surface, {"reach": reach, "effects": effects, "pitch": pitch, **laid}


def by_plies(texts: Sequence[Iterable[str]]) -> list[str]:
    """What is said of the plies, ``texts`` of each, once, with the numbers of those of which it is said."""
    plies: dict[str, list[int]] = {}
    for number, own in enumerate(texts, 1):
        for text in dict.fromkeys(own):
            plies.setdefault(text, []).append(number)
    return [
        f"{'ply' if len(numbers) == 1 else 'plies'} {', '.join(map(str, numbers))}: {text}"
        for text, numbers in plies.items()
    ]


def _left_over(folder: Path, files: Mapping[int, Mapping[str, Path]]) -> Iterator[str]:
    """Warn of folders and files of an earlier run."""
    from geomdrap.cli.messages import of_an_earlier_run
    from geomdrap.export.outputs import left_over
    from geomdrap.export.plies_outputs import left_over_plies

    if files:
        yield from of_an_earlier_run([*left_over(folder, ()), *left_over_plies(folder, files)], folder)
    for number, own in files.items():
        inside = folder / f"ply-{number}"
        yield from of_an_earlier_run(left_over(inside, own.values()), inside)


def _write(
    stack: Sequence[Ply],
    extras: Extras,
    folder: Path,
    outputs: tuple[str, ...],
    progress: Progress,
    elements: Sequence[ElementPly | None],
) -> dict[int, dict[str, Path]]:
    """Write the files of all plies; Ctrl-C says which there are."""
    from geomdrap.export.plies_outputs import write_plies

    written = 0

    def count(share: float) -> None:
        nonlocal written
        written += 1
        progress.share(share)

    try:
        return write_plies(stack, extras, folder, outputs, count, elements)
    except (KeyboardInterrupt, SystemError) as error:
        if not written or interrupt_within(error) is None:
            raise
        said = f"interrupted; {written} of {len(stack)} plies are written, in {folder / 'ply-1'}"
        if written > 1:
            said += f" to ply-{written}"
        raise KeyboardInterrupt(f"{said}, and no plies.json of them") from None


def _summary(stack: Sequence[Ply], thickness: float, folder: Path | None) -> Iterator[str]:
    """A line per ply; mm, mm², degrees."""
    first = stack[0].drape
    yield f"{first.net.surface.source}, {len(stack)} plies of {thickness:g} mm, pitch {first.net.pitch:g} mm"
    yield "ply  angle    below     max    95 %    cover      fabric  [°, mm, %, mm²]"
    for ply in stack:
        shear, area = ply.drape.statistics, ply.drape.area
        yield (
            f"{ply.number:3d} {ply.angle:6.4g} {ply.below[0]:8.3f}{shear.max:8.2f}{shear.p95:8.2f}"
            f"{100 * area.coverage:9.2f}{area.fabric:12.0f}"
        )
    yield f"fabric of all plies {sum(ply.drape.area.fabric for ply in stack):.0f} mm²"
    rolls = [ply.drape.roll for ply in stack if ply.drape.roll is not None]
    if rolls:
        strips = ", ".join(str(len(roll.strips)) for roll in rolls)
        used = sum(roll.length for roll in rolls)
        yield f"strips of a roll {rolls[0].width:g} mm wide: {strips}; {used:.1f} mm used"
    if folder:
        yield f"files: {folder / 'plies.json'}, {folder}/ply-1 to ply-{len(stack)}"
