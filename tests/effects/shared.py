"""Nets with effects, and the measurements of the hidden-effect cases."""

from __future__ import annotations

import json
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

import geomdrap as gd
from geomdrap.fishnet.relax import placed, relax

ABOVE = Path(__file__).resolve().parents[3:]  # folders that may hold shared/ beside the checkout


def drape(surface, *effects, origin=(0.0, 0.0, 0.0), angle=0.0, pitch=5.0, **more):
    """A net with effects written as on the command line; a name alone is the effect at its neutral values."""
    acting = [gd.effects.parse(e) if ":" in e else gd.effects.make(e) for e in effects]
    return gd.drape(surface, origin, angle, pitch, effects=acting, project=True, **more)


def assert_the_same_from_another_start(net, problem, within, of_energy):
    """A net moves, and comes to rest ``within`` as many mm from the geometric net and from one that was shaken."""
    one = relax(problem, problem.footing)
    noise = 0.03 * net.pitch * np.random.default_rng(1).normal(size=net.lattice.shape)
    other = relax(problem, placed(problem, net.lattice + noise))
    assert max(one.unrest, other.unrest) < 1e-6
    moves = problem.number >= 0
    assert abs(one.x - problem.x0)[moves].max() > 0.3
    assert abs(one.x - other.x)[moves].max() < within
    assert one.energy == pytest.approx(other.energy, rel=of_energy)


def grid_of(net):
    """Fabric coordinates (nu, nv) of the nodes."""
    return np.meshgrid(net.u, net.v, indexing="ij")


@dataclass(frozen=True)
class Case:
    """A measurement with a hidden effect: part, what was believed, marks, the answer."""

    surface: gd.Surface
    setup: dict
    marks: np.ndarray
    truth: dict

    def residuals(self, pose, effects, pitch):
        """Misses of positions (n, 3) mm and shear (n,) degrees, NaN where the net has no node."""
        placement = gd.effects.make("placement", du=pose[0], dv=pose[1], dangle=pose[2])
        at, angle = self.setup["origin"], self.setup["angle"]
        net = gd.drape(self.surface, at, angle, pitch, effects=[*effects, placement], project=True)
        points, shear = net.interpolate(self.marks[:, 0], self.marks[:, 1])
        return points - self.marks[:, 2:5], shear - self.marks[:, 5]

    def fitted(self, effects, pitch, rounds=3, step=0.05):
        """Root mean squares of position (mm, per coordinate) and shear with the placement fitted, and marks lost."""

        def weighted(pose):
            away, shear = self.residuals(pose, effects, pitch)
            return np.nan_to_num(np.append(away / self.setup["sigma_xyz"], shear / self.setup["sigma_shear"]))

        pose = np.zeros(3)
        for _ in range(rounds):
            now = weighted(pose)
            slopes = [(weighted(pose + way) - now) / step for way in step * np.eye(3)]
            pose = pose - np.linalg.lstsq(np.column_stack(slopes), now, rcond=None)[0]
        away, shear = self.residuals(pose, effects, pitch)
        lost = np.isnan(shear).mean()
        return np.sqrt(np.nanmean(away**2)), np.sqrt(np.nanmean(shear**2)), lost, pose


def case(name):
    """A case by name; skips the test where the cases are not there."""
    places = [above / "shared" / "hidden-effect" / name for above in ABOVE]
    folder = next((place for place in places if place.is_dir()), None)
    if folder is None:
        pytest.skip(f"the measurements of {name} are not beside this checkout")
    return Case(
        gd.read_surface(folder / "part.stl"),
        tomllib.loads((folder / "setup.toml").read_text()),
        np.loadtxt(folder / "measured.csv", delimiter=",", skiprows=1),
        json.loads((folder / "truth.json").read_text()),
    )
