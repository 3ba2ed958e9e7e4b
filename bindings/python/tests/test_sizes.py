# SPDX-License-Identifier: Apache-2.0
"""Sizes of elements, and the meshes that Gmsh and mmg make with them."""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import gmsh
import meshio
import mmgpy
import numpy as np
import pytest
import scaleaxis
from conftest import box_mesh

ACROSS = 4
# Walls of the part: box, thickness, axis across it. A rib, a block, and the plate below.
WALLS = [
    ((10, 2, 4), (11, 18, 11), 1.0, 0),
    ((25, 3, 4), (29, 17, 7), 4.0, 0),
    ((16, 3, 0), (20, 17, 2), 2.0, 2),
]
MMG = Path(mmgpy.__file__).parent / "bin"


@pytest.fixture
def part() -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """A plate with a rib, a block and a hole: in Gmsh, and its coarse triangles."""
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.model.add("part")
    occ = gmsh.model.occ
    plate = occ.addBox(0, 0, 0, 40, 20, 2)
    others = [(3, occ.addBox(10, 0, 2, 1, 20, 10)), (3, occ.addBox(25, 0, 2, 4, 20, 6))]
    body, _ = occ.fuse([(3, plate)], others)
    occ.cut(body, [(3, occ.addCylinder(34, 10, -1, 0, 0, 5, 3))])
    occ.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMax", 5)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 24)
    gmsh.model.mesh.generate(2)
    nodes, triangles = elements(2)
    gmsh.model.mesh.clear()
    gmsh.option.setNumber("Mesh.MeshSizeMax", 1e22)
    # As docs/sizes.md has it: sizes are those of the field alone.
    for name in ("FromPoints", "FromCurvature", "ExtendFromBoundary"):
        gmsh.option.setNumber(f"Mesh.MeshSize{name}", 0)
    yield nodes, triangles
    gmsh.finalize()


def elements(dim: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes, and the triangles or tetrahedra of the mesh in Gmsh."""
    tags, places, _ = gmsh.model.mesh.getNodes()
    index = np.zeros(int(tags.max()) + 1, dtype=np.int32)
    index[tags] = np.arange(len(tags))
    _, corners = gmsh.model.mesh.getElementsByType(2 if dim == 2 else 4)
    return places.reshape(-1, 3), index[corners.reshape(-1, dim + 1)]


def edges(nodes: np.ndarray, cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Length and middle of each edge."""
    count = cells.shape[1]
    pairs = np.vstack([cells[:, [i, j]] for i in range(count) for j in range(i)])
    ends = nodes[np.unique(np.sort(pairs, axis=1), axis=0)]
    return np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1), ends.mean(axis=1)


def elements_across(nodes: np.ndarray, cells: np.ndarray) -> list[float]:
    """The thickness of each wall by the mean length of the edges in it."""
    lengths, middles = edges(nodes, cells)
    found = []
    for low, high, thickness, _ in WALLS:
        inside = np.all((middles >= np.array(low) - 1e-6) & (middles <= np.array(high) + 1e-6), axis=1)
        assert inside.sum() > 50
        found.append(thickness / lengths[inside].mean())
    return found


def even_lengthening() -> float:
    """How much longer edges of Gmsh are, on average, than the size where it is the same everywhere."""
    gmsh.model.add("even")
    gmsh.model.occ.addBox(0, 0, 0, 1, 4, 4)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.setSizeCallback(lambda *_: 0.25)
    gmsh.model.mesh.generate(3)
    lengths, _ = edges(*elements(3))
    gmsh.model.mesh.removeSizeCallback()
    gmsh.model.remove()
    return float(lengths.mean() / 0.25)


def use_callback(field: scaleaxis.SizeField, folder: Path) -> None:
    gmsh.model.mesh.setSizeCallback(field.gmsh_callback)


def use_view(ending: str) -> Callable[[scaleaxis.SizeField, Path], None]:
    def use(field: scaleaxis.SizeField, folder: Path) -> None:
        field.save(folder / f"sizes{ending}")
        model = gmsh.model.getCurrent()
        if ending == ".msh":  # it has a mesh, which is to be none of the part's
            gmsh.model.add("background")
        gmsh.merge(str(folder / f"sizes{ending}"))
        gmsh.model.setCurrent(model)
        background = gmsh.model.mesh.field.add("PostView")
        gmsh.model.mesh.field.setNumber(background, "ViewTag", gmsh.view.getTags()[-1])
        gmsh.model.mesh.field.setAsBackgroundMesh(background)

    return use


@pytest.mark.parametrize("use", [use_callback, use_view(".pos"), use_view(".msh")], ids=["callback", "pos", "msh"])
def test_gmsh_follows_the_field(part, tmp_path: Path, use) -> None:
    field = scaleaxis.size_field(part, elements_across=ACROSS, gradation=0.3)
    use(field, tmp_path)
    gmsh.model.mesh.generate(3)
    nodes, triangles = elements(2)
    lengths, middles = edges(nodes, triangles)
    # On the surface edges are as long as asked for; near where sizes change they are shorter.
    ratio = lengths / field(middles)
    assert np.median(ratio) == pytest.approx(1, abs=0.05)
    assert np.percentile(ratio, 95) < 1.4 and np.percentile(ratio, 5) > 0.6
    found = elements_across(*elements(3))
    gmsh.model.mesh.removeSizeCallback()
    # In the solid Gmsh makes edges longer, at an even size as well.
    assert np.array(found) * even_lengthening() == pytest.approx(ACROSS, rel=0.15)


def test_mmg_follows_the_field(part, tmp_path: Path) -> None:
    field = scaleaxis.size_field(part, elements_across=ACROSS)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 3)
    gmsh.model.mesh.generate(3)
    gmsh.write(str(tmp_path / "coarse.mesh"))
    field.save(tmp_path / "coarse.sol", mesh=tmp_path / "coarse.mesh")
    coarse = meshio.read(tmp_path / "coarse.mesh")
    sizes = np.loadtxt((tmp_path / "coarse.sol").read_text().splitlines()[5:-1])
    assert sizes == pytest.approx(field(coarse.points), rel=1e-12)
    subprocess.run([MMG / "mmg3d_O3", "coarse.mesh", "fine.mesh"], cwd=tmp_path, check=True, capture_output=True)
    fine = meshio.read(tmp_path / "fine.mesh")
    assert elements_across(fine.points, fine.get_cells_type("tetra")) == pytest.approx([ACROSS] * 3, rel=0.1)

    field.save(tmp_path / "part.sol")
    surface = meshio.read(tmp_path / "part.mesh")
    assert surface.points == pytest.approx(field.surface.vertices)
    subprocess.run([MMG / "mmgs_O3", "part.mesh", "fine.mesh"], cwd=tmp_path, check=True, capture_output=True)
    fine = meshio.read(tmp_path / "fine.mesh")
    lengths, middles = edges(fine.points, fine.get_cells_type("triangle"))
    assert np.median(lengths / field(middles)) == pytest.approx(1, abs=0.1)


def test_fields_of_shapes_and_images() -> None:
    field = scaleaxis.size_field(box_mesh((20, 10, 0.5)), elements_across=2, max_size=1)
    assert field.sizes.min() == pytest.approx(0.25, rel=3e-3)
    assert field([[10, 5, 0.2], [10, 5, 100]]) == pytest.approx([0.25, 1], rel=0.1)
    assert field.gmsh_callback(3, 1, 10, 5, 0.25, 0.1) == 0.1
    assert len(field.surface.vertices) == len(field.sizes)
    background = field.background()
    assert background.sizes == pytest.approx(np.minimum(field(background.vertices), 1), rel=1e-12)
    voxels = np.zeros((24, 24, 10), dtype=np.uint8)
    voxels[2:-2, 2:-2, 3:7] = 1
    assert scaleaxis.size_field(voxels, elements_across=2).sizes.min() == pytest.approx(2, abs=0.3)
    slot = scaleaxis.size_field(box_mesh((20, 10, 2)), of="feature-size", min_size=0.4)
    assert slot.sizes.min() == pytest.approx(2 / 3, rel=3e-3)


def test_what_cannot_be_written(tmp_path: Path) -> None:
    field = scaleaxis.size_field(box_mesh((2, 1, 1)))
    with pytest.raises(scaleaxis.FileError, match="cannot write"):
        field.save(tmp_path / "sizes.stl")
    (tmp_path / "bad.mesh").write_text("MeshVersionFormatted 2\nDimension 3\nVertices\n3\n0 0 0 0\n")
    with pytest.raises(scaleaxis.FileError):
        field.save(tmp_path / "sizes.sol", mesh=tmp_path / "bad.mesh")
    assert not (tmp_path / "sizes.sol").exists()
    with pytest.raises(scaleaxis.InvalidOption):
        scaleaxis.size_field(box_mesh((2, 1, 1)), gradation=0.0)
