"""The simulator shares nothing with the product: finding what it hides proves something."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import geomdrap.blind

ROOT = Path(geomdrap.blind.__file__).parent
ALLOWED = {"geomdrap.blind", "geomdrap.errors", "numpy", "scipy"}
PROBE = """
import sys, tempfile
from geomdrap.blind import make
from geomdrap.blind.ply import lay
from geomdrap.blind.recipe import Recipe
from geomdrap.blind.tools import sphere
make(1, effect="bridging", folder=tempfile.mkdtemp())
lay(sphere(200.0, 60.0), Recipe(stiffness=0.01), 20.0)
print(sorted(n for n in sys.modules if n.split(".")[0] == "geomdrap"))
"""


def _imported(path: Path) -> set[str]:
    names: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0
            names.add(str(node.module))
    return names


def test_every_file_imports_only_itself_numpy_and_scipy() -> None:
    for path in ROOT.glob("*.py"):
        for name in _imported(path):
            top = ".".join(name.split(".")[:2]) if name.startswith("geomdrap") else name.split(".")[0]
            assert top in ALLOWED or top in sys.stdlib_module_names, f"{path.name} imports {name}"


def test_sets_and_relaxed_nets_are_made_without_any_other_part_of_the_product() -> None:
    done = subprocess.run([sys.executable, "-c", PROBE], capture_output=True, text=True, check=True, timeout=120)
    used = {name.split(".")[1] for name in ast.literal_eval(done.stdout) if "." in name}
    assert used == {"blind", "errors"}
