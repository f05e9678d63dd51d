"""The command line: a file per command, imported when that command runs."""

from __future__ import annotations

import click

from geomdrap import __version__
from geomdrap.cli.lazy import LazyGroup

COMMANDS = {
    "drape": "Drape a part: net, shear map, flat pattern, statistics.",
    "sweep": "Drape a part from many origins and headings, and rank them.",
    "optimize": "Find the origin and the heading with the best drape.",
    "compare": "Hold a drape against measured points: where it fails, and by how much.",
    "diagnose": "Say which physical effect a drape lacks, by measured points.",
    "improve": "Add missing effects to a drape until it agrees with measured points.",
    "check": "Say whether a mesh is fit for draping, and what is wrong with it.",
    "diff": "Say what changed between two results (for golden files in CI).",
    "effects": "List the physical effects that can be added to a drape, or explain one.",
    "coupon": "Pull a test specimen of the mechanical model, or fit the model to a measured test.",
    "blind": "Test the diagnosis on sets with a hidden effect.",
    "sample": "Write a sample part.",
}


@click.group(
    cls=LazyGroup,
    package=__name__,
    summaries=COMMANDS,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(__version__, "--version", message="geomdrap %(version)s")
def cli() -> None:
    """Drape a woven composite ply over a mould.

    Lengths are in mm, angles in degrees. Results go to stdout and to files, messages to stderr.

    \b
    Examples:
      geomdrap sample hemisphere
      geomdrap drape hemisphere.stl --angle 45 -o result
      geomdrap drape --help

    \b
    Exit codes:
      0  done
      1  done but incomplete (drape --strict), or a change was found (diff)
      2  bad input
      3  a bug in geomdrap
      130  interrupted (Ctrl-C)
    """
