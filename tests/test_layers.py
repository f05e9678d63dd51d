"""The folders are the pipeline: a package imports only from those above it."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

import geomdrap

ROOT = Path(geomdrap.__file__).parent
ORDER = (
    "surface",
    "geodesic",
    "fishnet",
    "fields",
    "effects",
    "forming",
    "measurement",
    "criticism",
    "blind",
    "sweep",
    "export",
    "cli",
)
ANYWHERE = {"errors", "__version__"}
HEAVY = {"numpy", "scipy", "numba", "trimesh", "matplotlib", "meshio", "ezdxf", "igl"}
FILES = sorted(ROOT.rglob("*.py"))


def _name(path: Path) -> str:
    return str(path.relative_to(ROOT))


def _imports(path: Path, *, at_module_level_only: bool = False) -> Iterator[str]:
    """Yield the dotted names that a file imports, ``from a import b`` as ``a.b``."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in _outside_functions(tree) if at_module_level_only else ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = "." * node.level + (node.module or "")
            yield from (f"{base}.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.Call) and getattr(node.func, "id", "") == "import_module":
            yield from (
                a.value for a in node.args[:1] if isinstance(a, ast.Constant) and isinstance(a.value, str)
            )


def _outside_functions(node: ast.AST) -> Iterator[ast.AST]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)) or _for_types_only(child):
            continue
        yield child
        yield from _outside_functions(child)


def _for_types_only(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and getattr(node.test, "id", "") == "TYPE_CHECKING"


def test_every_package_has_its_place_in_the_order() -> None:
    packages = {path.parent.name for path in ROOT.glob("*/*.py")}
    assert packages <= set(ORDER), f"say where {packages - set(ORDER)} belongs"


@pytest.mark.parametrize("path", [p for p in FILES if p.parent != ROOT], ids=_name)
def test_imports_only_from_packages_above(path: Path) -> None:
    package = path.relative_to(ROOT).parts[0]
    allowed = {*ORDER[: ORDER.index(package) + 1], *ANYWHERE}
    used = {name.split(".")[1] for name in _imports(path) if name.startswith("geomdrap.")}
    assert used <= allowed, f"{_name(path)} imports {sorted(used - allowed)}, which come after {package}"


@pytest.mark.parametrize("path", FILES, ids=_name)
def test_imports_are_absolute(path: Path) -> None:
    assert not [name for name in _imports(path) if name.startswith(".")]


@pytest.mark.parametrize(
    "path", [*(p for p in FILES if p.parent.name == "cli"), *sorted(ROOT.glob("*.py"))], ids=_name
)
def test_the_command_line_imports_nothing_heavy_at_module_level(path: Path) -> None:
    used = {name.split(".")[0] for name in _imports(path, at_module_level_only=True)}
    assert not used & HEAVY


@pytest.mark.parametrize("path", [p for p in FILES if p.parent.name == "cli"], ids=_name)
def test_the_command_line_imports_only_itself_at_module_level(path: Path) -> None:
    used = {n for n in _imports(path, at_module_level_only=True) if n.startswith("geomdrap.")}
    others = {n for n in used if n.split(".")[1] not in ("cli", *ANYWHERE)}
    assert not others, f"import {sorted(others)} inside the command, so that --help stays instant"
