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
make(1, effect="{effect}", part="{part}", folder=tempfile.mkdtemp())
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


def test_a_set_with_a_relaxed_net_is_made_without_any_other_part_of_the_product() -> None:
    code = PROBE.format(effect="shear-stiffness", part="saddle")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=120)
    used = {name.split(".")[1] for name in ast.literal_eval(done.stdout) if "." in name}
    assert used == {"blind", "errors"}
