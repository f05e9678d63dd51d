"""Help is instant: nothing heavy is loaded for it."""

from __future__ import annotations

import subprocess
import sys

import pytest

HEAVY = ("numpy", "scipy", "numba", "trimesh", "matplotlib", "meshio", "ezdxf", "igl")
PROBE = """
import sys
from geomdrap.__main__ import main
sys.argv = ["geomdrap", *{arguments}]
try:
    main()
except SystemExit as end:
    assert not end.code, end.code
print("loaded:", [name for name in {heavy} if name in sys.modules])
"""
COMMANDS = (
    *("drape", "sweep", "optimize", "compare", "diagnose", "improve", "blind", "effects", "coupon"),
    *("check", "diff", "sample"),
)
ALL = [["--help"], ["--version"], *([name, "--help"] for name in COMMANDS)]


def _run(code: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False, timeout=60
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("arguments", ALL, ids=" ".join)
def test_help_loads_no_heavy_library(arguments: list[str]) -> None:
    assert "loaded: []" in _run(PROBE.format(arguments=arguments, heavy=HEAVY))


def test_importing_the_package_loads_no_heavy_library() -> None:
    code = f"import sys, geomdrap; print([n for n in {HEAVY} if n in sys.modules])"
    assert _run(code).strip() == "[]"


def test_help_of_the_program_imports_no_command() -> None:
    code = (
        "import sys\nfrom geomdrap.cli import COMMANDS, cli\n"
        "try:\n    cli.main(['--help'])\nexcept SystemExit:\n    pass\n"
        "print('imported', [n for n in COMMANDS if f'geomdrap.cli.{n}' in sys.modules])"
    )
    assert _run(code).strip().endswith("imported []")


def test_the_modules_that_the_readme_names_are_there_without_another_import() -> None:
    code = "import geomdrap as gd; print(callable(gd.forming.coupon.uniaxial), callable(gd.forming.fit_coupon.fit_coupon))"
    assert _run(code).strip() == "True True"
