"""Hold-out by blocks, against refitting without each of them."""

import numpy as np
import pytest

from geomdrap.criticism.holdout import blocks_of, held_out_error


def test_blocks_are_compact_and_of_like_size():
    at = np.random.default_rng(0).uniform(0.0, 1.0, (403, 2)) * [200.0, 100.0]
    block = blocks_of(at)
    counts = np.bincount(block)
    assert len(counts) == 8
    assert counts.max() - counts.min() <= 4
    assert max(np.ptp(at[block == k], axis=0).max() for k in range(8)) < 80.0


def test_the_order_of_the_points_does_not_matter():
    at = np.random.default_rng(0).uniform(0.0, 100.0, (60, 2))
    order = np.random.default_rng(1).permutation(60)
    block, other = blocks_of(at), blocks_of(at[order])
    assert len(set(zip(block[order], other, strict=True))) == 8


def test_it_is_the_error_of_a_model_refitted_without_the_block():
    rng = np.random.default_rng(0)
    a, noise = rng.normal(size=(80, 3)), rng.uniform(0.5, 2.0, 80)
    y = a @ [1.0, 2.0, 3.0] + noise * rng.normal(size=80)
    block = np.repeat(np.arange(8), 10)
    fitted = np.linalg.lstsq(a / noise[:, None], y / noise, rcond=None)[0]
    total = 0.0
    for k in range(8):
        out = block == k
        there = np.linalg.lstsq(a[~out] / noise[~out, None], y[~out] / noise[~out], rcond=None)[0]
        total += (((y[out] - a[out] @ there) / noise[out]) ** 2).sum()
    assert held_out_error(y - a @ fitted, a, noise, block) == pytest.approx(np.sqrt(total / 80), rel=1e-9)
    assert held_out_error(y, np.zeros((80, 0)), noise, block) == pytest.approx(np.sqrt(np.mean((y / noise) ** 2)))
