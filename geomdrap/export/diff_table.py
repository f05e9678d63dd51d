"""Changes between two node tables: nodes matched by their fabric coordinates."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from geomdrap.export.diff import Change, Tolerance

_NUMBERS = ("u", "v", "x", "y", "z", "shear")
# lines of two nets closer than this are the same line; the smallest pitch is far above it
_SAME_LINE = 1e-3


@dataclass(frozen=True)
class _Table:
    uv: np.ndarray  # (n, 2) mm
    points: np.ndarray  # (n, 3) mm, NaN where absent
    shear: np.ndarray  # (n,) deg, NaN where absent
    status: np.ndarray  # (n,) text

    @property
    def present(self) -> np.ndarray:
        return ~np.isnan(self.points[:, 0])

    def rows(self, index: np.ndarray) -> _Table:
        return _Table(self.uv[index], self.points[index], self.shear[index], self.status[index])


def changes(old: bytes, new: bytes, tolerance: Tolerance) -> Iterator[Change]:
    """Yield what changed between two nodes.csv: nodes gone, come, moved, sheared, and why they are absent."""
    before, after = _parse(old), _parse(new)
    match = _match(before.uv, after.uv, max(_SAME_LINE, tolerance.mm))
    gone, come = match < 0, np.ones(len(after.uv), bool)
    come[match[~gone]] = False
    left, right = before.rows(np.flatnonzero(~gone)), after.rows(match[~gone])
    yield from _counted(before.rows(gone & before.present), left.rows(left.present & ~right.present), "gone")
    yield from _counted(after.rows(come & after.present), right.rows(~left.present & right.present), "new")
    yield from _moved(left, right, tolerance)
    yield from _sheared(left, right, tolerance)
    yield from _explained(left, right)


def _counted(unmatched: _Table, changed: _Table, word: str) -> Iterator[Change]:
    uv = np.vstack([unmatched.uv, changed.uv])
    if len(uv):
        first = uv[np.argmin(np.abs(uv).sum(axis=1))]
        yield Change("", _at(first), f"{_nodes(len(uv))} {word}, this one nearest to the origin")


def _moved(old: _Table, new: _Table, tolerance: Tolerance) -> Iterator[Change]:
    move = np.linalg.norm(new.points - old.points, axis=1)
    yield from _largest(old, move, tolerance, "mm", "moved")
    slip = np.abs(new.uv - old.uv).max(axis=1, initial=0.0)
    yield from _largest(old, slip, tolerance, "mm", "with other u, v")


def _sheared(old: _Table, new: _Table, tolerance: Tolerance) -> Iterator[Change]:
    lost = old.present & new.present & (np.isnan(old.shear) != np.isnan(new.shear))
    if lost.any():
        what = f"{_nodes(int(lost.sum()))} whose shear came or went, this one first"
        yield Change("", _at(old.uv[lost][0]), what)
    yield from _largest(old, np.abs(new.shear - old.shear), tolerance, "deg", "with other shear")


def _explained(old: _Table, new: _Table) -> Iterator[Change]:
    other = ~old.present & ~new.present & (old.status != new.status)
    if other.any():
        first = int(np.argmax(other))
        reasons = f"{old.status[first]} -> {new.status[first]}"
        what = f"{_nodes(int(other.sum()))} absent for another reason, here {reasons}"
        yield Change("", _at(old.uv[first]), what)


def _largest(
    table: _Table, amount: np.ndarray, tolerance: Tolerance, unit: str, word: str
) -> Iterator[Change]:
    amount = np.nan_to_num(amount, nan=0.0)
    limit = tolerance.deg if unit == "deg" else tolerance.mm
    beyond = amount > limit + tolerance.slack
    if beyond.any():
        worst = int(np.argmax(amount))
        x, y, z = table.points[worst]
        where = f"{_at(table.uv[worst])} (x {x:.6g}, y {y:.6g}, z {z:.6g})"
        what = f"{_nodes(int(beyond.sum()))} {word}, this one most,"
        yield Change("", where, what, float(amount[worst]), unit)


def _match(old: np.ndarray, new: np.ndarray, reach: float) -> np.ndarray:
    """Give for each old node (n, 2) the number of the new one (m, 2) on the same two lines, or −1."""
    columns = [_lines(old[:, axis], new[:, axis], reach) for axis in (0, 1)]
    width = 1 + max((int(c.max()) for _, c in columns if len(c)), default=0)
    keys_old, keys_new = (columns[0][side] * width + columns[1][side] for side in (0, 1))
    if not len(keys_new):
        return np.full(len(keys_old), -1)
    order = np.argsort(keys_new, kind="stable")
    slot = np.searchsorted(keys_new[order], keys_old).clip(max=len(order) - 1)
    return np.where(keys_new[order][slot] == keys_old, order[slot], -1)


def _lines(old: np.ndarray, new: np.ndarray, reach: float) -> tuple[np.ndarray, np.ndarray]:
    """Number the grid lines that two sets of coordinates lie on, values closer than ``reach`` on one line."""
    both = np.concatenate([old, new])
    order = np.argsort(both, kind="stable")
    number = np.empty(len(both), np.int64)
    number[order] = np.cumsum(np.diff(both[order], prepend=both[order][:1]) > reach)
    return number[: len(old)], number[len(old) :]


def _parse(data: bytes) -> _Table:
    rows = list(csv.reader(data.decode("utf-8").splitlines()))
    if not rows or not set(_NUMBERS) <= set(rows[0]):
        raise ValueError(f"not a node table: its first line should name {', '.join(_NUMBERS)}")
    header, body = rows[0], rows[1:]
    for number, row in enumerate(body, start=2):
        if len(row) != len(header):
            raise ValueError(f"line {number} has {len(row)} values, not {len(header)}")
    table = dict(zip(header, zip(*body, strict=True), strict=True)) if body else {name: () for name in header}
    u, v, x, y, z, shear = (_floats(table[name]) for name in _NUMBERS)
    if np.isnan(u).any() or np.isnan(v).any():
        raise ValueError("a node without u or v")
    status = np.array(table.get("status", [""] * len(u)), dtype=object)
    return _Table(np.column_stack([u, v]), np.column_stack([x, y, z]), shear, status)


def _floats(texts: tuple[str, ...]) -> np.ndarray:
    return np.array([float(text) if text else np.nan for text in texts], dtype=float)


def _at(uv: np.ndarray) -> str:
    return f"node u {uv[0]:.6g}, v {uv[1]:.6g}"


def _nodes(count: int) -> str:
    return f"{count} node" if count == 1 else f"{count} nodes"
