# SPDX-License-Identifier: Apache-2.0
"""The whole pipeline against shapes whose axes are known, and against the program."""

from __future__ import annotations

import json
import subprocess
import warnings
from pathlib import Path

import numpy as np
import pytest
import scaleaxis
from conftest import distance_to_ring


def test_axis_of_a_ball_is_its_centre(ball):
    axis = scaleaxis.axis(ball, delta=0.02, scale=1.1)
    assert np.linalg.norm(axis.vertices, axis=1).max() < 0.05
    assert axis.radii.max() == pytest.approx(1.0, abs=0.01)
    assert axis.topology == (1, 1, 0, 0)


def test_axis_of_a_torus_is_its_ring(torus):
    axis = scaleaxis.axis(torus, delta=0.01, scale=1.1)
    assert axis.topology == scaleaxis.Topology(components=1, euler=0, tunnels=1, voids=0)
    assert distance_to_ring(axis.vertices).max() < 0.05
    assert axis.radii == pytest.approx(0.5, abs=0.02)
    around = np.sort(np.arctan2(axis.vertices[:, 1], axis.vertices[:, 0]))
    assert np.diff(around).max() < 0.3  # all around


def test_axis_of_a_box_has_the_ball_between_its_nearest_sides(box):
    axis = scaleaxis.axis(box, delta=0.02, scale=1.0)
    assert axis.radii.max() == pytest.approx(1.0, abs=0.01)
    deepest = axis.vertices[axis.radii > 0.99]
    assert deepest[:, 0] == pytest.approx(1.0, abs=0.02)
    assert np.allclose(axis.balls[:, 3], np.minimum(axis.balls[:, :3], [2, 3, 4] - axis.balls[:, :3]).min(axis=1))


def test_several_scales_share_one_sampling(box):
    one, two = scaleaxis.axis(box, delta=0.03, scale=[1.0, 1.5])
    assert (one.scale, two.scale) == (1.0, 1.5)
    assert one.balls is two.balls
    assert len(two.vertices) < len(one.vertices)
    alone = scaleaxis.axis(box, delta=0.03, scale=1.5)
    assert np.array_equal(alone.vertices, two.vertices)
    assert isinstance(scaleaxis.axis(box, delta=0.03, scale=(1.2,)), list)
    assert isinstance(scaleaxis.axis(box, delta=0.03, scale=np.array([1.2])), list)


def test_delta_is_chosen(box):
    chosen = scaleaxis.axis(box, delta="auto", delta_range=(0.06, 0.03))
    choice = chosen.statistics["delta_choice"]
    tolerances = [each["tolerance"] for each in choice["attempts"] if each["delta"] == choice["chosen"]]
    assert tolerances == [chosen.tolerance]
    assert 0.03 <= chosen.tolerance / chosen.diagonal <= 0.06
    same = scaleaxis.axis(box, delta_abs=chosen.tolerance)
    assert same.statistics["delta_choice"] is None
    np.testing.assert_array_equal(same.vertices, chosen.vertices)
    with pytest.raises(scaleaxis.InvalidOption, match="delta"):
        scaleaxis.axis(box, delta="auto", delta_range=(0.01, 0.02))
    with pytest.raises(scaleaxis.InvalidOption, match="delta"):
        scaleaxis.axis(box, delta="auto", delta_abs=0.1)


@pytest.mark.parametrize("options", [{}, {"delta": 0.05}, {"delta_abs": 0.2}])
def test_a_range_of_deltas_without_auto_is_refused(box, options):
    with pytest.raises(scaleaxis.InvalidOption, match='delta_range has no effect without delta="auto"'):
        scaleaxis.axis(box, delta_range=(0.06, 0.03), **options)
    with pytest.raises(scaleaxis.InvalidOption, match="delta_range"):
        scaleaxis.axis(scaleaxis.mesh_solid(*box), delta_range=scaleaxis.DEFAULT_DELTA_RANGE, **options)


def test_default_range_of_deltas_is_that_of_the_library(ball):
    chosen = scaleaxis.axis(ball, delta="auto")
    given = scaleaxis.axis(ball, delta="auto", delta_range=scaleaxis.DEFAULT_DELTA_RANGE)
    assert chosen.tolerance == given.tolerance
    coarsest, finest = scaleaxis.DEFAULT_DELTA_RANGE
    assert chosen.statistics["delta_choice"]["attempts"][0]["delta"] == coarsest > finest


def test_delta_as_a_length(box):
    diagonal = float(np.linalg.norm([2, 3, 4]))
    relative = scaleaxis.axis(box, delta=0.03)
    absolute = scaleaxis.axis(box, delta_abs=0.03 * diagonal)
    assert relative.tolerance == pytest.approx(absolute.tolerance)
    assert np.array_equal(relative.vertices, absolute.vertices)
    with pytest.raises(scaleaxis.InvalidOption, match="delta_abs"):
        scaleaxis.axis(box, delta=0.03, delta_abs=0.1)


@pytest.mark.parametrize(
    ("options", "differs"),
    [
        ({"angle": 0.0}, True),
        ({"union": "polar"}, True),
        ({"dense": True}, True),
        ({"smooth": 3}, False),  # all borders of a box lie on its edges
        ({"sharp": False}, True),
        ({"sharp": False, "smooth": 3}, True),
        ({"sharp_angle": 30.0}, False),
        ({"sharp_angle": 120.0}, True),
        ({"sampling": "uniform"}, True),
        ({"sampling": "adaptive"}, False),
        ({"seed": 7}, True),
        ({"method": "angle"}, True),
        ({"method": "lambda", "lambda_": 0.1}, True),
        ({"threads": 1}, False),
        ({"angle": 30.0, "union": "fitted"}, False),
    ],
)
def test_options_reach_the_library(box, options, differs):
    usual = scaleaxis.axis(box, delta=0.03)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", scaleaxis.Warning)  # of the local methods, which change the topology
        other = scaleaxis.axis(box, delta=0.03, **options)
    assert np.array_equal(usual.vertices, other.vertices) != differs


def test_smoothing_moves_borders(box):
    smooth, rough = (scaleaxis.axis(box, delta=0.03, sharp=False, smooth=rounds) for rounds in (40, 0))
    assert not np.array_equal(smooth.vertices, rough.vertices)


def test_sheets_end_on_sharp_edges(box):
    axis = scaleaxis.axis(box, delta=0.02)
    on_edges = axis.vertices[axis.radii == 0]
    low, high = np.asarray(box[0]).min(axis=0), np.asarray(box[0]).max(axis=0)
    sides = np.isclose(on_edges, low, atol=1e-9) | np.isclose(on_edges, high, atol=1e-9)
    assert len(on_edges) > 12 and np.all(sides.sum(axis=1) >= 2)
    assert np.count_nonzero(sides.all(axis=1)) == 8
    edges = axis.statistics["axis"]["sharp_edges"]
    assert edges["corners"] == 8 and edges["points"] == len(on_edges)
    assert scaleaxis.axis(box, delta=0.02, sharp=False).statistics["axis"]["sharp_edges"] is None
    assert axis.mesh().statistics is not None  # balls of radius 0 are left out
    with pytest.raises(scaleaxis.InvalidOption, match="sharp edges"):
        scaleaxis.axis(box, delta=0.02, sharp=False, sharp_angle=40)


@pytest.mark.program
@pytest.mark.parametrize(
    ("flags", "options"),
    [
        ([], {}),
        (["--union", "polar", "--dense"], {"union": "polar", "dense": True}),
        (["--smooth", "2", "--angle", "45", "--seed", "3"], {"smooth": 2, "angle": 45, "seed": 3}),
        (["--no-sharp"], {"sharp": False}),
        (["--sharp-angle", "50"], {"sharp_angle": 50}),
        (["--sampling", "uniform"], {"sampling": "uniform"}),
    ],
)
def test_same_bytes_as_the_program(program: Path, cat: Path, tmp_path: Path, flags, options):
    files = tmp_path / "program.ply", tmp_path / "statistics.json"
    command = [program, "axis", cat, "--delta", "0.02", "-o", files[0], "--stats", files[1], "--quiet", *flags]
    subprocess.run(command, check=True)
    axis = scaleaxis.axis(cat, delta=0.02, **options)
    axis.save(tmp_path / "python.ply")
    assert (tmp_path / "python.ply").read_bytes() == files[0].read_bytes()

    entry = json.loads(files[1].read_text())["results"][0]
    for key in ("mesh", "solid", "tolerance", "diagonal", "samples", "sampling", "balls", "fit"):
        assert axis.statistics[key] == entry[key], key
    for key in ("scale", "dual_complex", "medial_complex", "filter", "result", "agreement", "closed_gaps"):
        assert axis.statistics["axis"][key] == entry["axes"][0][key], key


def test_options_that_are_gone_say_what_takes_their_place(box, tmp_path):
    image = np.pad(np.ones((4, 4, 4), np.uint8), 2)
    for name in ("features", "tight"):
        for call, given in (
            (scaleaxis.axis, box),
            (scaleaxis.skeleton, box),
            (scaleaxis.midsurface, box),
            (scaleaxis.label_axes, image),
            (lambda solid, **options: scaleaxis.spheres(solid, 5, **options), box),
        ):
            with pytest.raises(scaleaxis.InvalidOption, match=f'{name} is gone: .*sampling="adaptive"'):
                call(given, **{name: True})
    with pytest.raises(TypeError, match="no option tightness"):
        scaleaxis.axis(box, tightness=True)


def test_unknown_samplings_are_refused(box):
    for call in (scaleaxis.axis, scaleaxis.skeleton, scaleaxis.midsurface):
        with pytest.raises(scaleaxis.InvalidOption, match="sampling must be one of 'adaptive', 'uniform', not 'dense'"):
            call(box, sampling="dense")


def test_a_solid_and_what_it_was_made_of_have_one_axis(box):
    (axis,) = scaleaxis.axis(scaleaxis.mesh_solid(*box), 0.03, [1.2], angle=20, keep_samples=True)
    assert np.array_equal(axis.vertices, scaleaxis.axis(box, 0.03, 1.2, angle=20).vertices)
    assert axis.samples is not None and len(axis.samples) == axis.statistics["samples"]
