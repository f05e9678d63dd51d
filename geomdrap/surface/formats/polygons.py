"""OBJ, PLY, OFF and GLB through trimesh."""

from __future__ import annotations

import io
import re
from pathlib import Path
from typing import Any

import numpy as np

from geomdrap.errors import SurfaceError
from geomdrap.surface.formats.raw import RawMesh


def read(path: Path, tolerance: float | None) -> RawMesh:
    """Read all meshes of a file into one, in their places in the scene; polygons come as triangles."""
    data = path.read_bytes()
    kind = path.suffix.lower()[1:]
    if kind not in ("obj", "off"):
        return load(io.BytesIO(data), kind, path.name)
    try:
        text = data.decode()
    except UnicodeDecodeError:
        text = data.decode("latin-1")  # accents in comments and names: the numbers are ASCII
    (_check_obj if kind == "obj" else _check_off)(text, path.name)
    return load(io.StringIO(text), kind, path.name)


def _check_obj(text: str, name: str) -> None:
    """Refuse faces with fewer than three corners, which trimesh would leave out without a word."""
    text = text.replace("\\\n", " ")  # a backslash carries a line on
    broken = re.search(r"^[ \t]*f(?:[ \t]+\S+){0,2}[ \t]*\r?$", text, re.MULTILINE)
    if broken:
        line = text.count("\n", 0, broken.start()) + 1
        raise SurfaceError(f"{name}: the face on line {line} has fewer than 3 corners; export the part again")


def _check_off(text: str, name: str) -> None:
    """Refuse a file with fewer vertices and faces than its header promises."""
    lines = [line.split("#")[0].strip() for line in text.splitlines()]
    rows = [line for line in lines if line]
    if rows and rows[0].upper() == "OFF":
        rows = rows[1:]
    try:
        promised = sum(int(word) for word in rows[0].upper().removeprefix("OFF").split()[:2])
    except (ValueError, IndexError):
        raise SurfaceError(f"{name} cannot be read as OFF (no counts at the start); export again") from None
    short = bool(rows) and _corners_missing(rows[-1])
    if len(rows) - 1 < promised or (len(rows) - 1 == promised and short):
        raise SurfaceError(f"{name} is cut off: it holds less than its header promises; copy it again")


def _corners_missing(row: str) -> bool:
    words = row.split()
    return not words[0].isdigit() or len(words) < 1 + int(words[0])


def load(file: Any, kind: str, name: str) -> RawMesh:
    """Read an open file of the given kind (obj, ply, off, glb); the name is for messages."""
    import trimesh

    options: dict[str, Any] = {"skip_materials": True} if kind == "obj" else {}
    try:
        loaded = trimesh.load(file, file_type=kind, process=False, **options)
        pieces = _pieces(loaded)
    except Exception as error:  # trimesh raises whatever its parsers stumble on
        raise SurfaceError(
            f"{name} cannot be read as {kind.upper()} ({_first_line(error)}); export the part again"
        ) from None
    if not pieces:
        what = "only points or lines, no faces" if _has_points(loaded) else "no faces"
        raise SurfaceError(f"{name} holds {what}; export the part as a triangulated surface")
    starts = np.cumsum([0, *(len(points) for points, _ in pieces)])
    triangles = [faces + starts[i] for i, (_, faces) in enumerate(pieces)]
    return RawMesh(np.concatenate([points for points, _ in pieces]), np.concatenate(triangles))


def _pieces(loaded: Any) -> list[tuple[np.ndarray, np.ndarray]]:
    """Points and triangles of each mesh in a scene, moved to its place."""
    import trimesh

    if not isinstance(loaded, trimesh.Scene):
        faces = getattr(loaded, "faces", ())
        return [(np.asarray(loaded.vertices), np.asarray(faces))] if len(faces) else []
    pieces = []
    for node in loaded.graph.nodes_geometry:
        transform, key = loaded.graph[node]
        mesh = loaded.geometry[key]
        faces = np.asarray(getattr(mesh, "faces", ()))
        if len(faces):
            points = np.asarray(mesh.vertices) @ transform[:3, :3].T + transform[:3, 3]
            # a mirroring place in the scene would turn the faces inside out
            pieces.append((points, faces if np.linalg.det(transform[:3, :3]) > 0 else faces[:, ::-1]))
    return pieces


def _has_points(loaded: Any) -> bool:
    return len(getattr(loaded, "vertices", ())) > 0 or len(getattr(loaded, "geometry", ())) > 0


def _first_line(error: Exception) -> str:
    if isinstance(error, IndexError):
        return "a face names a vertex that is not there"
    text = (str(error).strip().splitlines() or [""])[0][:120]
    return text or type(error).__name__
