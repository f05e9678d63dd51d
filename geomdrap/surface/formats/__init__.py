"""Mesh files: a module for each family of formats, with one function ``read(path, tolerance) -> RawMesh``."""

from __future__ import annotations

from geomdrap.surface.formats.raw import RawMesh

#: ending of the file name → module that reads it
READERS = {
    ".stl": "stl",
    ".obj": "polygons",
    ".ply": "polygons",
    ".off": "polygons",
    ".glb": "polygons",
    ".vtu": "elements",
    ".vtk": "elements",
    ".msh": "elements",
    ".inp": "elements",
    ".bdf": "elements",
    ".nas": "elements",
    ".fem": "elements",
    ".step": "cad",
    ".stp": "cad",
    ".iges": "cad",
    ".igs": "cad",
}

__all__ = ["READERS", "RawMesh"]
