"""Compiled kernels are dropped when a source that they were built from changes.

The compiler's own check looks at the file of a kernel only, not at the files whose kernels and constants it has built
in: an edited helper would leave the old one at work, silently.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import re
from collections.abc import Iterable
from pathlib import Path

STAMP = "kernels.stamp"
IMPORT = re.compile(r"^from (geomdrap[\w.]*) import|^import (geomdrap[\w.]*)", re.MULTILINE)


def forget_stale_kernels(package: Path) -> int:
    """Delete compiled kernels of files that have changed, or that import what has; how many.

    Where nothing may be written nothing can have changed.
    """
    place = package / "__pycache__" / STAMP
    files = sorted(package.rglob("*.py"))
    listing = _digest(f"{f.relative_to(package)} {f.stat().st_size} {f.stat().st_mtime_ns}" for f in files)
    with contextlib.suppress(OSError):
        before = _read(place)
        if before.get("") == listing:
            return 0
        now = {"": listing, **_stamps(package, files)}
        stale = [
            kernel
            for kind in ("nbi", "nbc")
            for kernel in package.rglob(f"__pycache__/*.{kind}")
            if _changed(_source_of(kernel, package), before, now)
        ]
        for kernel in stale:
            kernel.unlink(missing_ok=True)
        place.parent.mkdir(exist_ok=True)
        place.write_text(json.dumps(now))
        return len(stale)
    return 0


def _changed(source: str, before: dict[str, str], now: dict[str, str]) -> bool:
    return source not in now or before.get(source) != now[source]


def _read(place: Path) -> dict[str, str]:
    """The stamps of the last run; none where there was none or where they cannot be read."""
    try:
        stamps = json.loads(place.read_text())
    except (OSError, ValueError):
        return {}
    return stamps if isinstance(stamps, dict) else {}


def _source_of(kernel: Path, package: Path) -> str:
    """The file, from the package, that ``__pycache__/cell.close_cell-73.py311.nbi`` was compiled from."""
    return str(kernel.parent.parent.relative_to(package) / (kernel.name.split(".")[0] + ".py"))


def _stamps(package: Path, files: list[Path]) -> dict[str, str]:
    """A stamp per file, of its text and of all that it imports from the package, directly or not."""
    texts = {f: f.read_text(encoding="utf-8") for f in files}
    uses = {f: {_file_of(package, m[1] or m[2]) for m in IMPORT.finditer(t)} & texts.keys() for f, t in texts.items()}
    stamps = {}
    for file in files:
        reached, todo = {file}, [file]
        while todo:
            new = uses[todo.pop()] - reached
            reached |= new
            todo += new
        stamps[str(file.relative_to(package))] = _digest(texts[f] for f in sorted(reached))
    return stamps


def _file_of(package: Path, module: str) -> Path:
    """The file of a module of the package."""
    path = package.joinpath(*module.split(".")[1:])
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")


def _digest(texts: Iterable[str]) -> str:
    return hashlib.sha256("\n".join(texts).encode()).hexdigest()
