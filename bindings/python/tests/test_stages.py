# SPDX-License-Identifier: Apache-2.0
"""Each stage alone."""

from __future__ import annotations

import inspect
from dataclasses import replace

import numpy as np
import pytest
import scaleaxis
from conftest import box_mesh, distance_to_ring


@pytest.fixture(scope="module")
def solid(torus):
    return scaleaxis.mesh_solid(*torus)


@pytest.fixture(scope="module")
def samples(solid):
    return scaleaxis.sample(solid, 0.15)


@pytest.fixture(scope="module")
def medial(samples):
    return scaleaxis.medial_axis(scaleaxis.inner_balls(samples))


def test_stages_one_after_the_other_are_the_axis(solid):
    tolerance = scaleaxis.tolerance_of(0.02, solid.diagonal)
    samples = scaleaxis.sample(solid, tolerance)
    balls = scaleaxis.union_of(samples, solid, topology=solid.topology).balls
    medial = scaleaxis.medial_axis(scaleaxis.scaled(balls, 1.1))
    filtered = scaleaxis.filter(medial.complex, 30)
    sharp = scaleaxis.extend_to_sharp_edges(filtered.complex, solid, tolerance, angle=61, scale=1.1)
    cleaned = scaleaxis.clean(sharp.complex, 0.5 * tolerance)
    shrunk = scaleaxis.shrink(cleaned.complex, 1.1)
    smoothed = scaleaxis.smooth(shrunk, medial.ball_union, 2)
    centered = scaleaxis.center(smoothed, solid, tolerance)
    contracted = scaleaxis.contract_slivers(centered.complex, tolerance)
    wide = scaleaxis.filter(contracted, 30, measure="by_area").complex
    axis = scaleaxis.axis(solid, delta=0.02, smooth=2)
    assert np.array_equal(axis.balls, balls)
    assert np.array_equal(axis.vertices, wide.vertices)
    assert np.array_equal(axis.radii, wide.radii)
    assert np.array_equal(axis.polygons.indices, wide.faces.indices)
    with pytest.raises(scaleaxis.InvalidOption, match="tolerance"):
        scaleaxis.contract_slivers(centered.complex, 0.0)
    assert not np.array_equal(axis.vertices, smoothed.vertices)
    assert axis.statistics["axis"]["filter"] == filtered.statistics
    assert axis.statistics["axis"]["sharp_edges"] == sharp.statistics
    assert axis.statistics["axis"]["cleaning"] == cleaned.statistics
    assert axis.statistics["axis"]["centering"] == centered.statistics
    assert axis.statistics["axis"]["medial_complex"] == medial.statistics["medial_complex"]


def test_solid(solid):
    assert solid.bounds == pytest.approx(np.array([[-2.5, -2.5, -0.5], [2.5, 2.5, 0.5]]), abs=0.01)
    assert solid.topology == (1, 0, 1, 0)
    assert solid.knows_nearest and solid.batch_size >= 1 and solid.warnings == []
    places = np.array([[2.0, 0, 0], [0, 0, 0], [2.4, 0, 0]])
    assert solid.inside(places).tolist() == [True, False, True]
    assert solid.nearest(places)[2] == pytest.approx([2.5, 0, 0], abs=0.01)
    assert np.isnan(solid.nearest(places, 0.2)[:2]).all()  # all is farther than that
    assert np.isnan(solid.nearest(places, [1.0, 0.1, 0.0])).any(axis=1).tolist() == [False, True, True]
    assert solid.crossings([[2.0, 0, 0]], [[4.0, 0, 0]]) == pytest.approx(np.array([[2.5, 0, 0]]), abs=0.01)
    assert np.isnan(solid.crossings([[3.0, 0, 0]], [[4.0, 0, 0]])).all()
    seeds = solid.seeds(0.3)
    assert len(seeds) > 100 and np.abs(distance_to_ring(seeds) - 0.5).max() < 0.01
    assert "2.5" in repr(solid)
    with pytest.raises(TypeError, match="pickle"):
        __import__("pickle").dumps(solid)
    with pytest.raises(ValueError, match="as many"):
        solid.crossings([[2.0, 0, 0]], np.zeros((2, 3)))


def test_many_questions_are_answered_in_order(solid):
    places = np.random.default_rng(1).uniform(-3, 3, (200_000, 3))
    assert np.array_equal(solid.inside(places)[150_000:], solid.inside(places[150_000:]))
    expected = distance_to_ring(places) < 0.5
    assert (solid.inside(places) != expected).mean() < 1e-3


def test_samples(samples):
    assert samples.tolerance == 0.15
    assert len(samples) == len(samples.points) > 100
    assert np.abs(distance_to_ring(samples.points) - 0.5).max() < 0.01
    inside = samples.tetrahedra[samples.inside]
    assert samples.inside.dtype == bool and 0 < len(inside) < len(samples.tetrahedra)
    corners = samples.points[samples.tetrahedra[:, 0]]
    assert np.linalg.norm(corners - samples.centers, axis=1) == pytest.approx(samples.radii)
    assert scaleaxis.topology(samples) == (1, 0, 1, 0)
    assert samples.statistics["restricted_facets"] > 0
    assert f"{len(samples):,} points" in repr(samples)


def test_samples_of_options(solid):
    plate = scaleaxis.mesh_solid(*box_mesh((4.0, 4.0, 0.2)))
    usual = scaleaxis.sample(plate, 0.4)
    for options in ({"sampling": "uniform"}, {"needs_manifold": True}, {"seed": 2}):
        assert not np.array_equal(scaleaxis.sample(plate, 0.4, **options).points, usual.points), options
    assert np.array_equal(scaleaxis.sample(plate, 0.4, sampling="adaptive").points, usual.points)
    usual, limited, close = (
        scaleaxis.sample(plate, 0.2, **options)
        for options in ({}, {"facet_distance": 0.01}, {"facet_distance": 0.01, "growth_limit": 8.0})
    )
    assert limited.statistics["is_growth_limited"] and not close.statistics["is_growth_limited"]
    assert len(usual) < len(limited) <= 2 * len(usual) < len(close)
    with pytest.raises(scaleaxis.UnusableInput):
        scaleaxis.sample(solid, 0.3, max_samples=10)
    with pytest.raises(scaleaxis.InvalidOption):
        scaleaxis.sample(solid, -1.0)
    with pytest.raises(scaleaxis.InvalidOption, match="sampling must be one of 'adaptive', 'uniform'"):
        scaleaxis.sample(solid, 0.3, sampling="dense")


def test_samples_are_as_dense_as_the_solid_needs(solid):
    adaptive, uniform = (scaleaxis.sample(solid, 0.05, sampling=sampling) for sampling in ("adaptive", "uniform"))
    assert len(uniform) > 2 * len(adaptive)
    for samples in (adaptive, uniform):
        statistics = samples.statistics
        counts = [statistics[f"{name}_facets"] for name in ("thickness", "gap", "dip", "bent")]
        assert any(counts) == (samples is adaptive) and statistics["far_samples"] >= 0
        assert sum(statistics["facet_sizes"]) == statistics["restricted_facets"]
        # They are known to the library too.
        assert scaleaxis.axis(samples, sharp=False).statistics["sampling"] == statistics
    assert len(uniform.statistics["facet_sizes"]) == 4  # none is larger than the tolerance


def test_samples_follow_creases():
    vertices, triangles = box_mesh((4.0, 2.0, 1.0))
    box = scaleaxis.mesh_solid(vertices, triangles)
    ends = [(a, b) for i, a in enumerate(vertices) for b in vertices[:i] if np.count_nonzero(a != b) == 1]
    assert len(ends) == 12

    def volume(**options):
        surface = scaleaxis.boundary_mesh(scaleaxis.sample(box, 0.3, needs_manifold=True, **options))
        a, b, c = np.moveaxis(surface.vertices[surface.triangles], 1, 0)
        return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0

    assert volume(creases=ends) == pytest.approx(8.0)
    assert volume() < 7.99
    for wrong in (ends[0], [[0.0, 1.0]], [[[0, 0, 0], [1, 0, np.nan]]]):
        with pytest.raises(ValueError, match="creases"):
            scaleaxis.sample(box, 0.3, creases=wrong)


def test_spoiled_samples_are_refused(samples):
    import dataclasses

    bad = dataclasses.replace(samples, tetrahedra=samples.tetrahedra + len(samples))
    with pytest.raises(scaleaxis.UnusableInput, match="out of range"):
        scaleaxis.inner_balls(bad)
    with pytest.raises(scaleaxis.UnusableInput, match="length"):
        scaleaxis.inner_balls(dataclasses.replace(samples, centers=samples.centers[1:]))
    with pytest.raises(TypeError, match="Samples"):
        scaleaxis.inner_balls(samples.points)


def test_balls(samples, solid):
    balls = scaleaxis.inner_balls(samples)
    assert balls.shape[1] == 4 and np.median(distance_to_ring(balls[:, :3])) < 0.1
    fitted = scaleaxis.fit(balls, solid, scaleaxis.DEFAULT_SLACK * samples.tolerance)
    assert np.array_equal(np.diff(fitted.given) > 0, np.ones(len(fitted.given) - 1, bool))
    gap = np.linalg.norm(fitted.contacts - fitted.balls[:, None, :3], axis=2) - fitted.balls[:, 3:]
    assert np.abs(gap).max() <= 1.01 * scaleaxis.DEFAULT_SLACK * samples.tolerance
    assert fitted.statistics["queries"] > 0
    repaired = scaleaxis.repair(fitted, samples, solid, topology=solid.topology)
    assert repaired.topology == solid.topology
    assert np.array_equal(repaired.balls[: len(fitted.balls)], fitted.balls)
    assert repaired.statistics["added"] == len(repaired.balls) - len(fitted.balls)
    whole = scaleaxis.union_of(samples, solid, topology=solid.topology, keeps_all=True)
    assert np.array_equal(whole.balls, repaired.balls) and whole.fit["repair"] == repaired.statistics
    assert len(scaleaxis.union_of(samples, solid, topology=solid.topology).balls) < len(whole.balls)
    polar = scaleaxis.union_of(samples, solid, kind="polar")
    assert np.array_equal(polar.balls, balls) and polar.fit is None and len(polar.contacts) == 0
    assert scaleaxis.default_union(solid) == "fitted"
    accuracy = scaleaxis.union_accuracy(fitted.balls, fitted.contacts, samples)
    assert 0 < accuracy["mean_distance"] < accuracy["largest_distance"] < samples.tolerance


def test_gaps_that_growing_closes():
    # A ring of balls, open at one place: growing closes it.
    angles = np.linspace(0.25, 2 * np.pi - 0.25, 60)
    balls = np.column_stack([2 * np.cos(angles), 2 * np.sin(angles), 0 * angles, np.full(60, 0.4)])
    solid = scaleaxis.union_solid(balls)
    samples = scaleaxis.sample(solid, 0.08)
    fitted = scaleaxis.fit(scaleaxis.inner_balls(samples), solid, 1e-3)
    gaps = scaleaxis.repair(fitted, samples, solid, topology=solid.topology).gaps
    assert gaps[0].place == pytest.approx((2.0, 0.0, 0.0), abs=0.2)
    assert 1.0 < gaps[0].scale < 2.0 and 0.0 < gaps[0].width < 1.0


def test_operations_on_balls():
    balls = np.array([[0, 0, 0, 1.0], [3, 0, 0, 2.0], [0, 0, 0, 1.0]])
    assert scaleaxis.scaled(balls, 2)[:, 3].tolist() == [2, 4, 2]
    moved = scaleaxis.perturbed(balls, 0.01, seed=3)
    assert 0 < np.abs(moved - balls).max() <= 0.02
    assert scaleaxis.distinct_positions(balls).tolist() == [0, 1]
    assert np.array_equal(scaleaxis.distinct_balls(balls), balls[:2])
    scaleaxis.check_balls(balls)
    with pytest.raises(scaleaxis.UnusableInput) as caught:
        scaleaxis.check_balls([[0, 0, 0, 1], [1, 2, 3, -1]])
    assert (caught.value.element, caught.value.index) == ("ball", 2)


def test_ball_union():
    union = scaleaxis.BallUnion([[0, 0, 0, 1], [1.5, 0, 0, 1], [5, 0, 0, 1]])
    assert union.topology() == (2, 2, 0, 0)
    assert [list(ones) for ones in union.neighbors()] == [[1], [0], []]
    assert union.bounds.tolist() == [[-1, -1, -1], [6, 1, 1]]
    assert len(union) == 3 and repr(union) == "BallUnion(3 balls)"
    places = [[0, 0, 0], [3, 0, 0], [5, 0, 2]]
    assert union.signed_distances(places).tolist() == [-1, 0.5, 1]
    which, distance = union.nearest_balls(places)
    assert which.tolist() == [0, 1, 2] and distance.tolist() == [-1, 0.5, 1]
    assert union.inside(places).tolist() == [True, False, False]
    assert union.distances_to_boundary(places) == pytest.approx([1, 0.5, 1])
    corner = scaleaxis.BallUnion([[0, 0, 0, 1], [1, 0, 0, 1], [0, 1, 0, 1]])
    points, balls, pairs = corner.boundary_vertices()
    assert points == pytest.approx(
        np.array([[0.5, 0.5, -(0.5**0.5)], [0.5, 0.5, 0.5**0.5]])
    ) or points == pytest.approx(np.array([[0.5, 0.5, 0.5**0.5], [0.5, 0.5, -(0.5**0.5)]]))
    assert balls.tolist() == [[0, 1, 2]] * 2 and sorted(pairs[0]) == [0, 1]
    with pytest.raises(scaleaxis.UnusableInput):
        scaleaxis.BallUnion(np.empty((0, 4)))


def test_medial_axis_of_two_balls_is_the_segment_between_them():
    medial = scaleaxis.medial_axis([[0, 0, 0, 1.0], [1.5, 0, 0, 1.0]])
    assert sorted(medial.complex.vertices[:, 0]) == pytest.approx([0, 1.5], abs=1e-3)
    assert len(medial.complex.edges) == 1 and len(medial.complex.faces) == 0
    assert medial.complex.radii == pytest.approx(1.0, abs=1e-3)
    again = scaleaxis.medial_axis(medial.ball_union)
    assert len(again.complex.edges) == 1


def test_medial_axis_and_filters(medial):
    complex = medial.complex
    scaleaxis.check(complex)
    assert scaleaxis.topology(complex) == (1, 0, 1, 0)
    assert complex.contacts.shape == (len(complex.faces), 2, 3)
    face = complex.faces[0]
    to_contacts = np.linalg.norm(complex.vertices[face][:, None] - complex.contacts[0], axis=2)
    assert to_contacts == pytest.approx(np.repeat(complex.radii[face, None], 2, axis=1), abs=1e-6)
    kept = scaleaxis.filter(complex, 60).complex
    assert len(kept.faces) < len(complex.faces)
    assert scaleaxis.topology(kept) == scaleaxis.topology(complex)
    steep = scaleaxis.thresholded(complex, "object_angle", 60.0)
    assert np.all(steep.complex.face_angles >= 60.0)
    assert steep.statistics["sheets_before"] == complex.sheets
    assert len(scaleaxis.thresholded(complex, "circumradius", 0.49).complex.faces) < len(complex.faces)
    with pytest.raises(scaleaxis.InvalidOption, match="'object_angle', 'circumradius'"):
        scaleaxis.thresholded(complex, "size", 1.0)
    with pytest.raises(scaleaxis.InvalidOption):
        scaleaxis.filter(complex, 91.0)


def test_erosion_thickness_and_cleaning(medial):
    # A strip of 4 × 1, two squares wide, with balls of radius 2: the fire burns from its border.
    x, y = np.meshgrid(np.arange(0, 4.25, 0.5), [0.0, 0.5, 1.0], indexing="ij")
    vertices = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    corners = [[3 * i + j, 3 * i + j + 3, 3 * i + j + 4, 3 * i + j + 1] for i in range(8) for j in range(2)]
    strip = scaleaxis.MedialComplex.from_polygons(vertices, np.full(len(vertices), 2.0), corners)
    fire = scaleaxis.erosion_thickness(strip)
    expected = np.minimum.reduce([vertices[:, 0], 4 - vertices[:, 0], vertices[:, 1], 1 - vertices[:, 1]])
    assert fire.thickness == pytest.approx(expected) and fire.burn_times == pytest.approx(expected + 2)
    assert fire.corner_burn_times == pytest.approx(expected[strip.faces.indices] + 2)
    curve = scaleaxis.clean(strip, 1.0)
    assert len(curve.complex.faces) == 0 and len(curve.complex.edges) == len(curve.complex.vertices) - 1
    assert curve.statistics["curves"] == 1 and curve.statistics["area_removed"] == pytest.approx(4.0)
    assert np.all(np.abs(curve.complex.vertices[2:-2, 1] - 0.5) < 1e-12)  # the middle, but for its ends
    complex = scaleaxis.filter(medial.complex).complex
    assert scaleaxis.topology(scaleaxis.clean(complex, 0.05).complex) == scaleaxis.topology(complex)
    with pytest.raises(scaleaxis.InvalidOption):
        scaleaxis.clean(complex, -1.0)


def test_cleaning_finds_ridges_between_vertices():
    # A strip of 4 × 1, one square wide: its fire ends between the vertices, at a depth of 0.5.
    x, y = np.meshgrid(np.arange(5.0), [0.0, 1.0], indexing="ij")
    vertices = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    corners = [[2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1] for i in range(4)]
    strip = scaleaxis.MedialComplex.from_polygons(vertices, np.full(len(vertices), 2.0), corners)
    assert len(scaleaxis.clean(strip, 0.4).complex.faces) > 0
    assert len(scaleaxis.clean(strip, 0.4, finds_ridges=False).complex.faces) == 0
    assert len(scaleaxis.clean(strip, 0.6).complex.faces) == 0


def test_axes_are_cleaned_unless_told_otherwise(box):
    cleaned, ragged = scaleaxis.axis(box, delta=0.05), scaleaxis.axis(box, delta=0.05, clean=0.0)
    assert len(cleaned.curves) == 0 < len(ragged.curves)  # hairs
    assert cleaned.statistics["axis"]["cleaning"]["thickness"] == pytest.approx(0.5 * cleaned.tolerance)
    assert ragged.statistics["axis"]["cleaning"] is None
    assert scaleaxis.topology(cleaned.complex) == scaleaxis.topology(ragged.complex)
    with pytest.raises(scaleaxis.InvalidOption, match="clean"):
        scaleaxis.axis(box, clean=0.01, clean_abs=0.1)


def test_stages_on_complexes_from_elsewhere(solid):
    # With faces so small that radii are linear in all of them.
    samples = scaleaxis.sample(solid, 0.15, sampling="uniform")
    medial = scaleaxis.medial_axis(scaleaxis.inner_balls(samples))
    # A roof of slope 1/2: the radius falls from the ridge to the eaves, so that cos(angle) = 1/2.
    roof = scaleaxis.with_linear_radii(
        scaleaxis.MedialComplex.from_polygons(
            [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [1.0, 1.0, 0.5, 0.5], [[0, 1, 2, 3]]
        )
    )
    assert roof.face_angles.tolist() == [0.0]
    assert scaleaxis.with_object_angles(roof).face_angles == pytest.approx([60.0])
    assert scaleaxis.with_object_angles(replace(roof, scale=1.5)).face_angles == pytest.approx([np.degrees(np.arccos(0.75))])
    with pytest.raises(scaleaxis.UnusableInput):
        scaleaxis.filter(roof, 30)
    assert len(scaleaxis.filter(scaleaxis.with_object_angles(roof), 30).complex.faces) == 1
    assert len(scaleaxis.filter(scaleaxis.with_object_angles(roof), 70).complex.faces) == 0
    # Two balls far apart: a cone in a medial mesh of another program, two balls and a neck else.
    bar = scaleaxis.MedialComplex.from_polygons([[0, 0, 0], [4, 0, 0]], [1.0, 0.5], edges=[[0, 1]])
    cone = scaleaxis.densify(scaleaxis.with_linear_radii(bar))
    assert cone.radii == pytest.approx(1 - cone.vertices[:, 0] / 8)
    bare = replace(medial.complex, face_angles=np.zeros(len(medial.complex.faces)))
    difference = np.abs(scaleaxis.with_object_angles(bare).face_angles - medial.complex.face_angles)
    assert np.quantile(difference, 0.95) < 0.01  # degrees
    complex = scaleaxis.filter(medial.complex).complex
    smoothed = scaleaxis.smooth(complex, None, 10)
    other = scaleaxis.smooth(complex, medial.ball_union, 10)
    assert np.array_equal(smoothed.edges, complex.edges) and (smoothed.vertex_balls == -2).any()
    moved = (smoothed.vertex_balls == -2) & (other.vertex_balls == -2)
    assert np.array_equal(smoothed.vertices[moved], other.vertices[moved])
    assert np.abs(smoothed.radii[moved] - other.radii[moved]).max() < 0.02 * other.radii.max()


def test_shrink_and_densify(medial):
    shrunk = scaleaxis.shrink(medial.complex, 1.25)
    assert shrunk.radii == pytest.approx(medial.complex.radii / 1.25)
    bar = scaleaxis.shrink(scaleaxis.medial_axis([[0, 0, 0, 1.3], [1.5, 0, 0, 1.3]]).complex, 1.3)
    assert bar.scale == 1.3
    dense = scaleaxis.densify(bar)
    assert dense.scale == 1.3
    assert len(dense.vertices) > 2 and len(dense.edges) == len(dense.vertices) - 1
    assert len(scaleaxis.densify(bar, meeting_angle=170).vertices) > len(dense.vertices)
    with pytest.raises(scaleaxis.UnusableInput):
        scaleaxis.densify(bar, meeting_angle=170, most_vertices=2)
    with pytest.raises(scaleaxis.InvalidOption):
        scaleaxis.shrink(medial.complex, 0.5)


def test_complex_of_ones_own():
    square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0]]
    complex = scaleaxis.MedialComplex.from_polygons(square, 0.1, [[0, 1, 2, 3]], edges=[[4, 1]])
    scaleaxis.check(complex)
    assert complex.edges.tolist() == [[0, 1], [0, 3], [1, 2], [1, 4], [2, 3]]
    assert complex.sheets == 1 and complex.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert scaleaxis.topology(complex) == (1, 1, 0, 0)
    bare = scaleaxis.MedialComplex.from_polygons(square, [0.1] * 5)
    assert scaleaxis.topology(bare).components == 5
    with pytest.raises(ValueError, match="from 0 to 4"):
        scaleaxis.MedialComplex.from_polygons(square, 0.1, [[0, 1, 7]])
    spoiled = scaleaxis.MedialComplex(**{**complex.__dict__, "edges": complex.edges[::-1] + 9})
    with pytest.raises(scaleaxis.UnusableInput) as caught:
        scaleaxis.check(spoiled)
    assert caught.value.code.startswith("complex.")
    with pytest.raises(TypeError, match="MedialComplex"):
        scaleaxis.filter(square)  # type: ignore[arg-type]
    assert scaleaxis.label_sheets(complex).sheets == 1


def test_polygons():
    lists = scaleaxis.polygons_of([0, 3, 3, 7], [5, 6, 7, 1, 2, 3, 4])
    assert [list(one) for one in lists] == [[5, 6, 7], [], [1, 2, 3, 4]]
    assert lists[-1].tolist() == [1, 2, 3, 4] and lists.sizes.tolist() == [3, 0, 4]
    triangles, owner = lists.triangulated()
    assert triangles.tolist() == [[5, 6, 7], [1, 2, 3], [1, 3, 4]] and owner.tolist() == [0, 2, 2]
    with pytest.raises(IndexError):
        lists[3]
    for bad in ([1, 2], [0, 3], [0, 2, 1, 7], []):
        with pytest.raises(ValueError, match="offsets"):
            scaleaxis.polygons_of(bad, range(7))


def test_meshes(samples, torus):
    boundary = scaleaxis.boundary_mesh(samples)
    euler = len(boundary.vertices) - len(boundary.triangles) / 2
    assert euler == 0 and boundary.mesh.triangles is boundary.triangles
    mesh = scaleaxis.mesh(scaleaxis.inner_balls(samples), 0.02)
    assert mesh.statistics["mesh"]["genus"] == 1 and mesh.faces is mesh.triangles
    finer = scaleaxis.mesh(scaleaxis.inner_balls(samples), delta_abs=0.06)
    assert len(finer.vertices) > len(mesh.vertices)
    distance = scaleaxis.compare(mesh, torus, 0.01)
    assert 0 < distance.max < 0.2 and distance.a_to_b.mean < 0.05
    repaired, report = scaleaxis.repair_mesh(torus[0], torus[1][:, ::-1])
    assert report["repaired"]["reversed_components"] == 1 and report["fault"] is None
    closed, report = scaleaxis.repair_mesh(torus[0], torus[1][1:])
    assert report["fault"] is None and report["holes"][0]["edges"] == 3 and len(closed.triangles) == len(torus[1])
    assert scaleaxis.repair_mesh(torus[0], torus[1][:1])[1]["fault"]["code"] == "mesh.sheet"
    assert len(repaired.triangles) == len(torus[1])


def test_compare_of_shifted_balls(tmp_path):
    one, two = np.array([[0, 0, 0, 1.0]]), np.array([[0.25, 0, 0, 1.0]])
    distance = scaleaxis.compare(one, scaleaxis.BallUnion(two), 0.02)
    assert distance.max == pytest.approx(0.25, abs=0.01) and distance.error >= 0
    assert abs(distance.a_to_b.farthest[0]) == pytest.approx(1.0, abs=0.05)
    scaleaxis.write_balls(tmp_path / "two.ply", two)
    assert scaleaxis.compare(one, tmp_path / "two.ply", 0.02) == distance
    assert scaleaxis.compare(one, two, spacing_abs=0.5).a_to_b.samples < distance.a_to_b.samples


def test_field_and_images():
    field = scaleaxis.sample_field([[1, 2, 3, 1.0]], 32)
    assert max(field.values.shape) == 32 and field.values.dtype == np.float32
    places = field.origin + np.indices(field.values.shape).reshape(3, -1).T @ field.steps
    expected = np.linalg.norm(places - [1, 2, 3], axis=1) - 1
    assert field.values.ravel() == pytest.approx(expected, abs=1e-5)
    assert field.direction == pytest.approx(np.eye(3)) and "32" in repr(field)
    solid = scaleaxis.image_solid(field, 0.0, is_below=True)
    assert solid.inside([[1, 2, 3], [1, 2, 4.5]]).tolist() == [True, False]
    assert scaleaxis.image_topology(field, 0.0, True) == (1, 1, 0, 0)
    mask = np.zeros((12, 10, 8))
    mask[3:9, 2:8, 1:7] = 1
    smooth = scaleaxis.smoothed_mask(mask)
    assert 0 < (smooth.values > 0.5).sum() and len(np.unique(smooth.values)) > 2
    assert scaleaxis.image_topology(scaleaxis.Image(mask)).components == 1


def test_solids_of_clouds_and_functions(ball):
    solid = scaleaxis.cloud_solid(ball[0], normals=ball[0])
    assert solid.inside([[0, 0, 0], [0, 0, 1.2]]).tolist() == [True, False]
    assert scaleaxis.cloud_solid(ball[0], kernel=5.0).bounds == pytest.approx(solid.bounds, abs=0.05)
    crust = scaleaxis.crust(ball[0])
    assert scaleaxis.topology(crust) == (1, 1, 0, 0)
    function = scaleaxis.function_solid(lambda p: np.linalg.norm(p, axis=1) - 1, [[-2] * 3, [2] * 3], 0.2)
    assert function.nearest([[0.9, 0, 0]])[0] == pytest.approx([1, 0, 0], abs=1e-3)
    with pytest.raises(TypeError, match="function"):
        scaleaxis.function_solid(3, [[-2] * 3, [2] * 3])  # type: ignore[arg-type]


def test_everything_public_is_documented_and_named_once():
    for name in scaleaxis.__all__:
        thing = getattr(scaleaxis, name)
        if inspect.isfunction(thing) or inspect.isclass(thing):
            assert thing.__doc__, name
    assert scaleaxis.union_mesh is scaleaxis.mesh and scaleaxis.surface_distance is scaleaxis.compare
    assert scaleaxis.__version__.count(".") == 2 and scaleaxis.peak_memory() > 1e6


def test_compact_axes_and_their_envelopes(box):
    fine, compact = scaleaxis.axis(box, delta=0.05), scaleaxis.axis(box, delta=0.05, error=0.02)
    assert len(compact.vertices) < 0.5 * len(fine.vertices)
    statistics = compact.statistics["axis"]
    assert statistics["simplification"]["error"] == pytest.approx(0.02 * fine.diagonal)
    assert statistics["simplification"]["largest_gap"] <= statistics["simplification"]["error"]
    assert statistics["agreement"]["compact_and_before"] is True and compact.complex.sheets == fine.complex.sheets
    assert statistics["envelope_accuracy"]["envelope_to_solid"] < 0.05 * fine.diagonal
    # By hand nothing is fitted to the solid after that.
    fine, compact = (scaleaxis.axis(box, delta=0.05, error=error, center=False) for error in (None, 0.02))
    by_hand = scaleaxis.simplify(fine.complex, 0.02 * fine.diagonal)
    assert np.array_equal(by_hand.complex.vertices, compact.vertices)
    assert len(scaleaxis.simplify(fine.complex, vertices=100, anchors=[7]).complex.vertices) == 100
    assert len(scaleaxis.axis(box, delta=0.05, vertices=100).vertices) == 100
    with pytest.raises(scaleaxis.InvalidOption, match="error"):
        scaleaxis.simplify(fine.complex)
    with pytest.raises(scaleaxis.InvalidOption, match="dense"):
        scaleaxis.axis(box, delta=0.05, compact=True, dense=True)

    envelope = scaleaxis.Envelope(compact)
    assert envelope.topology == scaleaxis.topology(compact.complex)
    assert np.all(envelope.inside(compact.vertices)) and not envelope.inside([envelope.bounds[1] + 1.0])[0]
    assert np.all(envelope.signed_distances(compact.vertices) <= 1e-9 - compact.radii)
    assert scaleaxis.compare(box, envelope, 0.02).max < 0.05 * fine.diagonal
    mesh = scaleaxis.mesh(envelope, 0.05)
    assert mesh.statistics["mesh"]["euler"] == 2 and not mesh.warnings
    assert scaleaxis.sample_field(envelope, 16).values.min() == pytest.approx(-compact.radii.max(), abs=0.2)
    # Two balls of a cone: everywhere the cone, not a neck as between balls of a union.
    bar = scaleaxis.MedialComplex.from_polygons([[0, 0, 0], [4, 0, 0]], [1.0, 0.5], edges=[[0, 1]])
    cone = scaleaxis.Envelope(scaleaxis.with_linear_radii(bar))
    assert cone.signed_distances([[2, 0, 3]]) == pytest.approx([3 * np.sqrt(1 - 1 / 64) - 0.75])


def test_filtration(box, tmp_path):
    axis = scaleaxis.axis(box, delta=0.05, scale=1)
    with pytest.warns(scaleaxis.Warning, match="the axis is of s = 1.5"):
        scaleaxis.filtration(scaleaxis.axis(box, delta=0.05, scale=1.5))
    nested = scaleaxis.filtration(axis)
    assert np.array_equal(nested.complex.vertices, axis.complex.vertices)
    assert np.all(nested.vertex_scales >= nested.ball_scales) and np.isinf(nested.vertex_scales).any()
    sizes = [len(nested.cut(s).faces) for s in (1.0, 1.3, 1.6, 3.0)]
    assert sizes == sorted(sizes, reverse=True) and sizes[0] > sizes[-1]
    assert {scaleaxis.topology(nested.cut(s)) for s in (1.0, 1.5, 3.0)} == {scaleaxis.topology(nested.complex)}
    levels, plateau = nested.profile(3.0, 31)
    assert levels[0].volume > levels[-1].volume > 0
    nested.plot(tmp_path / "plot.svg", title="box")
    assert (tmp_path / "plot.svg").read_text().startswith("<svg")
    nested.plot(tmp_path / "plot.csv", largest_scale=3.0, count=31)
    lines = (tmp_path / "plot.csv").read_text().splitlines()
    assert lines[0].split(",") == list(scaleaxis.FiltrationLevel._fields) and len(lines) == 32
    with pytest.raises(scaleaxis.InvalidOption, match=r"written to \.svg;.*rsvg-convert"):
        nested.plot(tmp_path / "plot.png")
    with pytest.raises(scaleaxis.InvalidOption, match=r"written to \.svg, and"):
        nested.plot(tmp_path / "plot.jpg")
    with pytest.warns(scaleaxis.Warning, match="up to s = 10"):
        nested.cut(11)
    assert len(levels) == 31 and levels[-1].scale == pytest.approx(3.0) and levels[0].area >= levels[-1].area
    assert plateau.begin <= plateau.middle <= plateau.end
    for polygons in (False, True):
        scaleaxis.write_filtration(tmp_path / "nested.ply", nested, polygons=polygons)
        read = scaleaxis.read_filtration(tmp_path / "nested.ply")
        assert np.array_equal(read.edge_scales, nested.edge_scales)
        assert np.array_equal(read.cut(1.5).vertices, nested.cut(1.5).vertices)
    with pytest.raises(scaleaxis.InvalidOption, match="scale"):
        nested.cut(0.5)


def test_vanishing_scales():
    scales = scaleaxis.vanishing_scales([[0, 0, 0, 1.5], [2, 0, 0, 0.5], [40, 0, 0, 0.5]])
    assert np.isinf(scales[[0, 2]]).all() and scales[1] == pytest.approx(2.0, rel=1e-3)


def test_thickness_of_a_cube_is_its_side() -> None:
    corners = np.array([(x, y, z) for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    axis = scaleaxis.axis((corners, faces), delta=0.02)
    rng = np.random.default_rng(5)
    points = rng.random((200, 3))
    points[np.arange(200), np.arange(200) % 3] = np.arange(200) % 2
    found = axis.thickness(points)
    np.testing.assert_allclose(found.local, 1.0, atol=0.02)
    np.testing.assert_allclose(found.local, 2.0 * found.balls[:, 3])
    assert found.foot.mean() < 0.6  # half of a ball is near an edge
    exact = scaleaxis.thickness(axis, points, angle=0.0)
    assert exact.local.mean() < 0.6
    with pytest.raises(scaleaxis.InvalidOption, match="angle"):
        scaleaxis.thickness(axis, points, angle=180.0)

    grid = np.zeros((12, 12, 12), dtype=np.float32)
    grid[1:11, 1:11, 1:11] = 1.0
    mask = scaleaxis.Image(grid, origin=np.full(3, -0.05), steps=0.1 * np.eye(3))
    image = scaleaxis.thickness_image(axis, mask)
    assert image.values[0, 0, 0] == 0.0
    is_side = np.abs(image.values[1:11, 1:11, 1:11] - 1.0) < 0.02
    assert is_side.mean() > 0.99  # a ball in a corner may still count

    values = corners[:, 2] + 0.5
    with pytest.warns(scaleaxis.Warning, match="with_short_edges"):
        thin = scaleaxis.thin_regions(corners, faces, values, 1.0)
    assert len(thin.areas) == 1
    assert thin.minima[0] == 0.5
    assert thin.areas[0] == pytest.approx(3.0)
    np.testing.assert_array_equal(thin.vertex_regions, np.where(values < 1.0, 0, -1))


def test_no_corner_of_a_profile_is_thinner_than_its_walls() -> None:
    outline = np.array([(0.0, 0.0), (5.0, 0.0), (5.0, 0.4), (0.4, 0.4), (0.4, 6.0), (0.0, 6.0)])
    corners = np.concatenate([np.column_stack([outline, np.full(6, z)]) for z in (0.0, 2.0)])
    cap = [(0, k, k + 1) for k in range(1, 5)]
    sides = [t for k in range(6) for t in ((k, (k + 1) % 6, (k + 1) % 6 + 6), (k, (k + 1) % 6 + 6, k + 6))]
    faces = np.array([(a, c, b) for a, b, c in cap] + [(a + 6, b + 6, c + 6) for a, b, c in cap] + sides)
    axis = scaleaxis.axis((corners, faces))
    assert axis.thickness().local.min() > 0.99 * 0.4
    assert axis.thickness().surface is not None
    assert axis.thickness(angle=0.0).local.min() < 0.2  # in the edges


def test_midsurface_of_a_plate(tmp_path):
    corners = np.array([(x, y, z) for x in (0.0, 10.0) for y in (0.0, 6.0) for z in (0.0, 1.0)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    plate = (corners, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]))
    surface = scaleaxis.midsurface(plate, delta=0.015)
    assert surface.areas == pytest.approx([60.0], rel=0.02)
    assert (surface.means, surface.maxima) == (pytest.approx([1.0], abs=0.01), pytest.approx([1.0], abs=0.01))
    assert surface.minima == pytest.approx([1.0], abs=0.02)  # where the balls touch the rim too
    assert surface.seams == 0 and not surface.triangle_sheets.any()
    np.testing.assert_allclose(surface.thickness, 1.0, atol=0.02)
    assert repr(surface) == f"Midsurface({len(surface.triangles):,} triangles, 1 sheets, 0 seams)"
    again = scaleaxis.midsurface(surface.axis, extend=False)
    assert np.array_equal(surface.axis.midsurface(extend=False).vertices, again.vertices)
    assert again.areas == pytest.approx([45.0], rel=0.02)
    assert scaleaxis.midsurface(surface.axis.complex).areas == pytest.approx([60.0], rel=0.02)
    for name in ("plate.ply", "plate.vtp", "plate.obj", "plate.glb", "plate.stl", "plate.off"):
        surface.save(tmp_path / name)
    np.testing.assert_array_equal(2.0 * scaleaxis.read_axis(tmp_path / "plate.ply").radii, surface.thickness)
    with pytest.raises(scaleaxis.InvalidOption, match="angle"):
        scaleaxis.midsurface(surface.axis, angle=91.0)


def test_midsurface_of_a_ball_is_empty(ball):
    surface = scaleaxis.midsurface(ball, delta=0.05)
    assert len(surface.triangles) == len(surface.vertices) == len(surface.areas) == 0
