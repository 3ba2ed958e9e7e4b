# SPDX-License-Identifier: Apache-2.0
"""Walls and gaps, and shapes of CAD programs."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
import scaleaxis
from conftest import box_mesh

PLATE = (20.0, 10.0, 0.5)


def test_walls_have_their_places() -> None:
    vertices, faces = box_mesh(PLATE)
    found = scaleaxis.walls((vertices, faces), min_wall=0.8, min_gap=0.5)
    (finding,) = found
    assert finding.kind == "thin_wall" and finding.limit == 0.8
    assert finding.value == pytest.approx(0.5, rel=2e-3) and finding.radius == pytest.approx(finding.value / 2)
    assert finding.place[2] == pytest.approx(0.25, abs=2e-3)
    assert abs(finding.direction[2]) == pytest.approx(1.0, abs=1e-3)
    assert finding.area == pytest.approx(2 * 200 + 30, rel=0.01)
    assert found.wall is not None and found.gap is not None and found.wall_findings is not None
    assert len(found.wall) == len(found.surface.vertices) == len(found.gap)
    assert np.count_nonzero(found.wall_findings == 0) == finding.vertices
    assert not scaleaxis.walls((vertices, faces), min_wall=0.5).findings


def test_thickness_and_gap_at_points() -> None:
    solid = scaleaxis.mesh_solid(box_mesh((20, 10, 2)))
    assert scaleaxis.thickness_at(solid, [[5, 5, 2], [5, 5, 0.3]]) == pytest.approx([2, 2], rel=3e-3)
    assert math.isinf(scaleaxis.gap_at(solid, [[5, 5, 2]])[0])
    ring = scaleaxis.function_solid(
        lambda p: np.abs(np.hypot(p[:, 0], p[:, 1]) - 3) - 1 + 1e3 * (np.abs(p[:, 2]) > 2), [[-5, -5, -3], [5, 5, 3]]
    )
    assert scaleaxis.gap_at(ring, [[2, 0, 0]]) == pytest.approx([4], rel=0.02)


def test_walls_of_an_image_and_without_limits() -> None:
    voxels = np.zeros((24, 24, 10), dtype=np.uint8)
    voxels[2:-2, 2:-2, 3:7] = 1
    (finding,) = scaleaxis.walls(voxels, min_wall=6)
    assert finding.value == pytest.approx(4, abs=0.5)
    with pytest.raises(scaleaxis.InvalidOption):
        scaleaxis.walls(voxels)
    with pytest.raises(scaleaxis.InvalidOption):
        scaleaxis.walls(voxels, min_wall=-1.0)


class Shape:
    """As CadQuery and build123d have them."""

    def __init__(self, is_cadquery: bool) -> None:
        self.vertices, self.faces = box_mesh(PLATE)
        self.is_cadquery = is_cadquery
        self.tolerances: list[float] = []
        if is_cadquery:
            self.BoundingBox = lambda: SimpleNamespace(DiagonalLength=22.4)
        else:
            self.bounding_box = lambda: SimpleNamespace(diagonal=22.4)

    def tessellate(self, tolerance: float, angular: float) -> tuple:
        self.tolerances.append(tolerance)
        name = "toTuple" if self.is_cadquery else "to_tuple"
        places = [SimpleNamespace(**{name: lambda p=p: tuple(p.tolist())}) for p in self.vertices]
        return places, [tuple(t) for t in np.asarray(self.faces).tolist()]


@pytest.mark.parametrize("is_cadquery", [True, False])
def test_shapes_are_tessellated(is_cadquery: bool) -> None:
    shape = Shape(is_cadquery)
    assert scaleaxis.walls(shape, min_wall=0.8)[0].value == pytest.approx(0.5, rel=2e-3)
    assert 0 < shape.tolerances[0] < 0.01 * 22.4  # below the default δ
    workplane = SimpleNamespace(vals=lambda: [shape], val=lambda: shape)
    assert scaleaxis.load(workplane).report["euler"] == 2


def test_step_files_and_shapes_of_ocp(tmp_path) -> None:
    prim = pytest.importorskip("OCP.BRepPrimAPI")
    from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer

    shape = prim.BRepPrimAPI_MakeBox(20.0, 10.0, 0.5).Shape()
    writer = STEPControl_Writer()
    writer.Transfer(shape, STEPControl_AsIs)
    writer.Write(str(tmp_path / "plate.step"))
    for solid in (shape, tmp_path / "plate.step"):
        (finding,) = scaleaxis.walls(solid, min_wall=0.8)
        assert finding.value == pytest.approx(0.5, rel=2e-3)
    (tmp_path / "no.step").write_text("nothing")
    with pytest.raises(scaleaxis.FileError):
        scaleaxis.walls(tmp_path / "no.step", min_wall=0.8)


def test_walls_are_shown_on_a_page(tmp_path) -> None:
    found = scaleaxis.walls(box_mesh(PLATE), min_wall=0.8)
    found.view(tmp_path / "walls.html")
    assert (tmp_path / "walls.html").stat().st_size > 100_000
