# SPDX-License-Identifier: Apache-2.0
"""A few balls in place of a solid."""

from __future__ import annotations

import numpy as np
import pytest
import scaleaxis
from conftest import box_mesh


def gaps(balls, points):
    return scaleaxis.BallUnion(balls).signed_distances(points)


def test_covering_balls_cover(torus):
    few = scaleaxis.spheres(torus, 8, delta=0.02)
    assert few.balls.shape == (8, 4)
    points = scaleaxis.mesh_solid(*torus).seeds(0.05, seed=9)
    assert gaps(few.balls, points).max() < 0.01
    assert few.scores["coverage"] > 0.999
    assert few.scores["largest_protrusion"] <= few.statistics["error"] + 1e-6
    assert few.scores["volume_ratio"] > 1


def test_inner_balls_are_inside(torus):
    few = scaleaxis.spheres(torus, 8, inside=True, delta=0.02)
    solid = scaleaxis.mesh_solid(*torus)
    assert solid.inside(few.balls[:, :3]).all()
    distances = np.linalg.norm(solid.nearest(few.balls[:, :3]) - few.balls[:, :3], axis=1)
    assert (few.balls[:, 3] <= distances * (1 + 1e-12)).all()
    assert few.scores["volume_ratio"] < 1


def test_as_few_as_the_error_allows():
    box = box_mesh()
    few = scaleaxis.spheres(box, error=0.3, delta=0.06)
    fewer = scaleaxis.spheres(box, error=0.05, delta=0.06)
    assert len(few.balls) < len(fewer.balls)
    diagonal = scaleaxis.mesh_solid(*box).diagonal
    assert fewer.statistics["error"] <= 0.05 * diagonal * 1.000001


def test_sampling_reaches_the_candidates(torus):
    usual, adaptive, uniform = (
        scaleaxis.spheres(torus, 8, delta=0.04, **options).balls
        for options in ({}, {"sampling": "adaptive"}, {"sampling": "uniform"})
    )
    assert np.array_equal(usual, adaptive) and not np.array_equal(usual, uniform)


def test_scores_count_sheets_that_were_left_out():
    """An open plate beside a box has no inside, and no ball covers it."""
    vertices, faces = box_mesh()
    plate = np.array([[0, 0, 5], [1, 0, 5], [1, 1, 5], [0, 1, 5]]) + vertices.max(axis=0) * [0, 0, 1]
    both = (
        np.concatenate([vertices, plate]),
        np.concatenate([faces, [[4, 5, 6], [4, 6, 7]] + np.array(len(vertices) - 4)]),
    )
    with pytest.warns(scaleaxis.ScaleAxisWarning, match="sheets left out"):
        scores = scaleaxis.spheres(both, 4, delta=0.05).scores
    alone = scaleaxis.spheres((vertices, faces), 4, delta=0.05).scores
    # The box has an area of 52, the plate of 1.
    assert scores["surface_coverage"] == pytest.approx(52 / 53 * alone["surface_coverage"], abs=0.003)
    assert scores["largest_gap"] > 3
    assert alone["largest_gap"] < 0.1


def test_wrong_options(torus):
    with pytest.raises(scaleaxis.InvalidOption, match="not both"):
        scaleaxis.spheres(torus, 3, error=0.1, inside=True, delta=0.04)
    with pytest.raises(scaleaxis.InvalidOption, match="count is needed"):
        scaleaxis.spheres(torus)
    with pytest.raises(scaleaxis.InvalidOption, match="error and error_abs are the same option"):
        scaleaxis.spheres(torus, error=0.1, error_abs=0.1)


def test_so_many_that_stick_out_no_farther(torus):
    few = scaleaxis.spheres(torus, 6, error_abs=0.05, delta=0.04)
    assert len(few.balls) == 6 and few.statistics["error"] <= 0.05 * (1 + 1e-9)
    assert few.scores["coverage"] < 0.99


def test_none_reaches_through_a_plane(torus):
    balls = scaleaxis.spheres(torus, 8, clip_planes=[("-z", -0.1)], delta=0.04).balls
    assert (balls[:, 2] + balls[:, 3] <= 0.1 + 1e-9).all()


def test_progress_of_spheres(ball):
    """Of the whole of it, and it cancels."""
    told = []
    scaleaxis.spheres(ball, 8, progress=lambda stage, part: told.append((stage, part)))
    parts = [part for _, part in told]
    assert parts == sorted(parts) and parts[0] < 0.2 and parts[-1] == pytest.approx(1.0)
    assert len({stage for stage, _ in told}) > 2
    with pytest.raises(scaleaxis.Cancelled):
        scaleaxis.spheres(ball, 8, progress=lambda stage, part: part < 0.4)
