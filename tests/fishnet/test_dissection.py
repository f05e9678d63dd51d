"""Nested dissection against a dense solution of the same system."""

import numpy as np
import pytest

from geomdrap.fishnet.dissection import AFTER, FURTHER, dissect
from geomdrap.fishnet.multifrontal import solve


def net(shape, missing, seed, after=AFTER):
    """Numbers of nodes (nu, nv), some without, and random symmetric blocks, with what makes them positive."""
    rng = np.random.default_rng(seed)
    here = rng.random(shape) >= missing
    number = np.full(shape, -1)
    number[here] = np.arange(here.sum())
    blocks = rng.normal(size=(here.sum(), len(after), 2, 2))
    blocks[:, 0] = blocks[:, 0] + blocks[:, 0].swapaxes(1, 2) + 20.0 * np.eye(2)
    return np.nonzero(here), number, blocks, rng


def dense(nodes, number, blocks):
    """The whole matrix (2n, 2n)."""
    n = len(blocks)
    matrix = np.zeros((n, 2, n, 2))
    for node, (i, j) in enumerate(zip(*nodes, strict=True)):
        for k, (di, dj) in enumerate(FURTHER[: blocks.shape[1]]):
            if i + di < number.shape[0] and 0 <= j + dj < number.shape[1] and number[i + di, j + dj] >= 0:
                other = number[i + di, j + dj]
                matrix[other, :, node] = blocks[node, k].T
                matrix[node, :, other] = blocks[node, k]
    return matrix.reshape(2 * n, 2 * n)


@pytest.mark.parametrize("shape", [(1, 2), (4, 4), (3, 40), (17, 5), (13, 14)], ids=str)
@pytest.mark.parametrize("missing", [0.0, 0.4])
@pytest.mark.parametrize("shift", [0.0, -19.0], ids=["positive", "indefinite"])
@pytest.mark.parametrize("reach", [1, 2])
def test_the_solution_is_that_of_the_dense_matrix(shape, missing, shift, reach):
    nodes, number, blocks, rng = net(shape, missing, 1, FURTHER if reach == 2 else AFTER)
    blocks[:, 0] += shift * np.eye(2)
    right = rng.normal(size=2 * len(blocks))
    none = np.zeros((2, len(right)))
    found = solve(dissect(number, len(blocks), False, reach), nodes, number, blocks, none, 0.0, right)
    np.testing.assert_allclose(dense(nodes, number, blocks) @ found, right, atol=1e-12 if shift == 0.0 else 1e-9)


@pytest.mark.parametrize("shape", [(5, 4), (3, 30), (12, 13)], ids=str)
@pytest.mark.parametrize("stiffness", [0.1, 1e4])
def test_the_stiffness_of_whole_yarns_is_added(shape, stiffness):
    nodes, number, blocks, rng = net(shape, 0.2, 2)
    n = len(blocks)
    slopes, right = rng.normal(size=(2, 2 * n)), rng.normal(size=2 * n)
    yarns = np.zeros((sum(shape), 2 * n))
    for family, yarn in enumerate((nodes[1], shape[1] + nodes[0])):
        yarns[np.repeat(yarn, 2), np.arange(2 * n)] = slopes[family]
    matrix = dense(nodes, number, blocks) + stiffness * yarns.T @ yarns
    fronts = dissect(number, n, True)
    found = solve(fronts, nodes, number, blocks, slopes, 1.0 / stiffness, right)
    np.testing.assert_allclose(found, np.linalg.solve(matrix, right), rtol=1e-8, atol=1e-10)


@pytest.mark.parametrize("reach", [1, 2])
def test_every_unknown_is_eliminated_once_and_meets_only_later_ones(reach):
    _, number, blocks, _ = net((20, 11), 0.3, 4)
    fronts = dissect(number, len(blocks), True, reach)
    spans = [fronts.unknowns[a:b] for a, b in zip(fronts.start[:-1], fronts.start[1:], strict=True)]
    eliminated = np.concatenate([span[:own] for span, own in zip(spans, fronts.own, strict=True)])
    np.testing.assert_array_equal(np.sort(eliminated), np.arange(2 * len(blocks) + 31))
    for f, (span, own) in enumerate(zip(spans, fronts.own, strict=True)):
        assert (fronts.home[span[:own]] == f).all()
        assert (fronts.home[span[own:]] > f).all()
