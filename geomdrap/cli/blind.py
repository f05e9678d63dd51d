"""``geomdrap blind``: sets with a hidden effect from an independent simulator; solve them, then see the truth."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from geomdrap.cli.options import folder_option, json_option, quiet_option
from geomdrap.cli.values import Number

PLACEMENTS = ("right", "wrong")  # as in geomdrap.blind; tests compare these with it
COLUMNS = ("all", "positions", "shear", "directions")


@click.group()
def blind() -> None:
    """Test the diagnosis blind: on simulated plies with a hidden effect, their truth under seal.

    The simulator shares no code with the rest of the program. The hash of the truth is printed before anybody solves
    the set, and checked when it is revealed.

    \b
    Examples:
      geomdrap blind make -o case
      geomdrap blind solve case
      geomdrap blind reveal case
    """


@blind.command()
@click.option("--seed", type=click.IntRange(min=0), help="Draw the same set again.  [default: drawn, and sealed]")
@click.option(
    "--effect",
    default="random",
    show_default=True,
    metavar="NAME|random|none|unknown",
    help="What is hidden: an effect of the library, two with a plus, random, none, placement, or unknown (an effect "
    "that the library does not have).",
)
@click.option("--part", metavar="NAME", help="Family of the part.  [default: one that shows the effect]")
@click.option("--amount", type=Number("X", above=0.0), default=1.0, help="Strength of the effect, 1 as drawn.")
@click.option("--noise", type=Number("X", above=0.0), default=1.0, help="Noise, 1 for 0.2 mm and 0.6 degrees.")
@click.option("--scatter", type=Number("MM"), help="Standard deviation of the lay-up scatter.  [default: drawn]")
@click.option("--placement", type=click.Choice(PLACEMENTS), help="Does the ply lie as believed?  [default: drawn]")
@click.option("--outliers", type=Number("SHARE"), help="Share of marks far off.  [default: drawn, to 0.04]")
@click.option("--points", type=click.IntRange(min=1), help="How many marks.  [default: one each 16 mm, some lost]")
@click.option("--columns", type=click.Choice(COLUMNS), default="all", show_default=True, help="What was recorded.")
@folder_option("blind", "Folder for the set; it is made if it is missing.")
@json_option
def make(folder: Path, as_json: bool, **wanted: Any) -> None:
    """Make a set: part.stl, measured.csv, setup.toml, and the truth in truth.sealed.

    \b
    Examples:
      geomdrap blind make
      geomdrap blind make --effect unknown -o case --noise 2
    """
    from geomdrap.blind import make as make_set
    from geomdrap.blind import read_seal
    from geomdrap.cli.messages import print_json, say
    from geomdrap.export.whole import check_writable

    check_writable(folder)
    made = make_set(folder=folder, **wanted)
    old = [name for name in ("solved.json", "revealed.json") if (made / name).exists()]
    for name in old:
        (made / name).unlink()
    say((f"{made / name} was of the set that lay here before, and is removed" for name in old), (), quiet=False)
    if as_json:
        files = [str(made / name) for name in ("part.stl", "measured.csv", "setup.toml", "truth.sealed", "seal.txt")]
        told = {"folder": str(made), "seal": read_seal(made), "files": files, "removed": old}
        print_json({"schema": "geomdrap.blind-make/1", **told})
        return
    click.echo(f"wrote {made}: part.stl, measured.csv, setup.toml, truth.sealed\nseal {read_seal(made)}")


@blind.command()
@click.argument("folder", type=click.Path(path_type=Path))
@json_option
@quiet_option
def solve(folder: Path, as_json: bool, quiet: bool) -> None:
    """Diagnose the set in FOLDER, and write the verdict to solved.json before the truth is shown.

    \b
    Examples:
      geomdrap blind solve case
      geomdrap blind solve case --json
    """
    import geomdrap as gd
    from geomdrap.blind.record import refuse_if_revealed, write_solved
    from geomdrap.blind.seal import hashes
    from geomdrap.cli.messages import print_json
    from geomdrap.cli.progress import Progress, announce_compilation

    refuse_if_revealed(folder)
    announce_compilation(quiet)
    read = hashes(folder)
    with Progress(quiet) as progress:
        progress.step("Diagnosing")
        diagnosis = gd.diagnose(**_read(folder), progress=progress.share)
    record = write_solved(folder, diagnosis.as_dict(), read)
    if as_json:
        print_json(record)
        return
    rivals = f" ({', '.join(record['candidates'])})" if record["verdict"] == "ambiguous" else ""
    click.echo(f"verdict {record['verdict']}{rivals}, confidence {record['confidence']}")
    click.echo(f"wrote {folder / 'solved.json'} for seal {record['seal']}")


def _read(folder: Path) -> dict[str, Any]:
    """Keywords of ``diagnose`` from the files of a set."""
    import geomdrap as gd

    setup = gd.read_setup(folder / "setup.toml")
    known = {name: getattr(setup, name) for name in ("angle", "pitch", "sigma_xyz", "sigma_shear", "reference")}
    surface, measurement = gd.read_surface(folder / "part.stl"), gd.read_measurement(folder / "measured.csv")
    return {"surface": surface, "measurement": measurement, "origin": setup.origin, **known}


@blind.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--anyway", is_flag=True, help="Show the truth of an unsolved or changed set, which ends it.")
@json_option
def reveal(folder: Path, anyway: bool, as_json: bool) -> int:
    """Check the seal of the set in FOLDER and show what was hidden beside what was found.

    Exit code 0 if the verdict was right (or ambiguous, with the truth among its candidates), or none graded; else 1.

    \b
    Examples:
      geomdrap blind reveal case
      geomdrap blind reveal case --anyway --json
    """
    from geomdrap.blind.record import reveal as show
    from geomdrap.cli.messages import print_json

    result = show(folder, anyway)
    if as_json:
        print_json(result)
    else:
        click.echo("\n".join(_lines(result)))
    return 1 if result["right"] is False else 0


def _lines(result: dict[str, Any]) -> list[str]:
    """The reveal as text."""
    truth = result["truth"]
    hidden = f"{truth['answer']} ({', '.join(truth['effect'])})" if truth["answer"] == "unknown" else truth["answer"]
    lines = [f"seal {result['seal']} holds", f"hidden  {hidden}"]
    solved = result["grade"] is not None or result["changed"] or result["edited"] or result["earlier"]
    if result["changed"]:
        lines.append(f"changed {', '.join(result['changed'])}: not what was sealed, so nothing is graded")
    if result["edited"]:
        lines.append("edited  solved.json: not what solving wrote, so nothing is graded")
    if result["earlier"]:
        lines.append("earlier solved.json: of a version that wrote no digest, so nothing is graded")
    if result["changed_since"]:
        on_sealed = "" if result["changed"] or not solved else "; the verdict is on what was sealed"
        after = "solving" if solved else "sealing"
        lines.append(f"since   {', '.join(result['changed_since'])} changed after {after}{on_sealed}")
    if result["grade"] is not None:
        rivals = f" ({', '.join(result['candidates'])})" if result["verdict"] == "ambiguous" else ""
        lines += [f"found   {result['verdict']}{rivals}", f"grade   {result['grade']}"]
    for row in result["parameters"]:
        lines.append(f"  {row['parameter']:16} true {row['true']:.4g}, {_found(row)}{_mark(row)}")
    if truth["placement"]:
        off = "du {du:.2f} mm, dv {dv:.2f} mm, dangle {dangle:.2f} deg".format(**truth["placement"])
        lines.append(f"  placement        true {off} from where setup.toml has it")
    if truth["scatter"]:
        lines.append("  lay-up scatter   true {sd:.2f} mm over {length:.0f} mm".format(**truth["scatter"]))
    return lines


def _found(row: dict[str, Any]) -> str:
    """What a diagnosis has of a parameter, with its 95 % interval."""
    if row["found"] is None:
        return "not fitted"
    if row["sigma"] is None:
        return "not seen"
    return f"found {row['found']:.4g} ± {1.96 * row['sigma']:.2g} {row['unit']}".rstrip() + " (95 %)"


def _mark(row: dict[str, Any]) -> str:
    """What is wrong with a value that was found."""
    wrong = [words for key, words in (("outside", "outside it"), ("wrong_sign", "of the other sign")) if row[key]]
    return f": the true value is {' and '.join(wrong)}" if wrong else ""
