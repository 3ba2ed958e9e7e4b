# SPDX-License-Identifier: Apache-2.0
"""Plain data that the stages pass to each other: arrays with names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any, NamedTuple, cast, overload

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._arrays import Floats, Ints
from ._options import checked, stood_for
from .errors import InvalidOption
from .objects import pyvista_of
from .similarity import Similarity, similarity_of

if TYPE_CHECKING:
    import pyvista


class Topology(NamedTuple):
    """Betti numbers and the Euler characteristic: euler = components - tunnels + voids. None: not known."""

    components: int
    euler: int
    tunnels: int | None
    voids: int | None


class Mesh(NamedTuple):
    """A triangle mesh; `vertices, triangles = mesh` and `trimesh.Trimesh(*mesh)` take it apart."""

    vertices: Floats  #: V × 3
    triangles: Ints  #: F × 3, counter-clockwise as seen from outside

    @property
    def faces(self) -> Ints:
        """The triangles, under the name that trimesh has for them."""
        return self.triangles


class MeshObject(NamedTuple):
    """One of the things that a file holds."""

    name: str  #: as the file has it
    mesh: Mesh

    @property
    def _stands_for(self) -> Mesh:
        return self.mesh


class PointCloud(NamedTuple):
    """Points, and as many normals or none."""

    points: Floats
    normals: Floats


def mesh_after(mesh: Mesh, similarity: Similarity) -> Mesh:
    """The mesh after a similarity; its triangles stay oriented outward."""
    order = [0, 2, 1] if similarity.is_mirror else [0, 1, 2]
    return Mesh(similarity.points(mesh.vertices), np.ascontiguousarray(mesh.triangles[:, order]))


@dataclass(frozen=True, eq=False)
class Polygons:
    """Lists of indices in one flat array: list i is `indices[offsets[i]:offsets[i + 1]]`, or `polygons[i]`."""

    offsets: Ints  #: F + 1
    indices: Ints

    def __len__(self) -> int:
        return len(self.offsets) - 1

    @overload
    def __getitem__(self, i: int) -> Ints: ...
    @overload
    def __getitem__(self, i: slice) -> Polygons: ...
    def __getitem__(self, i: int | slice) -> Ints | Polygons:
        if isinstance(i, slice):
            lists = [self[k] for k in range(*i.indices(len(self)))]
            ends = np.cumsum([0, *map(len, lists)]).astype(np.int32)
            return Polygons(ends, np.concatenate([_empty(), *lists]))
        if not -len(self) <= i < len(self):
            raise IndexError(i)
        i %= len(self)
        return self.indices[self.offsets[i] : self.offsets[i + 1]]

    def __iter__(self) -> Iterator[Ints]:
        return (self[i] for i in range(len(self)))

    @property
    def sizes(self) -> Ints:
        """How many corners each polygon has."""
        return np.diff(self.offsets)

    def triangulated(self) -> tuple[Ints, Ints]:
        """Triangles of convex polygons as a fan from the first corner, T × 3, and the polygon of each, T."""
        counts = np.maximum(self.sizes - 2, 0)
        owner = np.repeat(np.arange(len(self), dtype=np.int32), counts)
        ends = np.cumsum(counts)
        place = np.arange(len(owner)) - np.repeat(ends - counts, counts)  # in the fan
        start = self.offsets[owner]
        corners = [self.indices[start], self.indices[start + place + 1], self.indices[start + place + 2]]
        return np.stack(corners, axis=1).astype(np.int32, copy=False), owner


def _empty(*shape: int, dtype: type = np.int32) -> npt.NDArray[Any]:
    return np.empty((0, *shape), dtype=dtype)


@checked
def polygons_of(offsets: npt.ArrayLike, indices: npt.ArrayLike) -> Polygons:
    """Lists from arrays of any type."""
    checked = Polygons(_arrays.indices(offsets, "offsets"), _arrays.indices(indices, "indices"))
    if len(checked.offsets) == 0 or checked.offsets[0] != 0 or checked.offsets[-1] != len(checked.indices):
        raise ValueError("offsets must begin with 0 and end with the number of indices")
    if (checked.sizes < 0).any():
        raise ValueError("offsets must not decrease")
    return checked


@dataclass(frozen=True, eq=False, repr=False)
class MedialComplex:
    """A medial axis as a polygonal complex: vertices with the radius of their maximal ball, edges, convex polygons.

    An edge without a face is a curve of the axis, a vertex without an edge an isolated ball. `check` says whether the
    arrays fit together.
    """

    vertices: Floats  #: V × 3
    radii: Floats  #: V
    edges: Ints  #: E × 2: all edges, those of faces too; ends ascending
    faces: Polygons  #: F polygons: vertices in cyclic order
    face_edges: Ints  #: as long as `faces.indices`: the edge from each corner to the next
    face_angles: Floats  #: F; object angle in degrees: the largest on the face; 0: unknown
    face_sheets: Ints  #: F; sheet, 0 … sheets - 1
    sheets: int  #: number of sheets (maximal parts without a seam inside)
    vertex_balls: Ints  #: V; the input ball whose centre the vertex is, -1: none, -2: moved, or on a sharp edge
    face_contacts: Ints = field(default_factory=lambda: _empty(2))  #: F × 2: boundary vertices; or empty
    boundary_vertices: Floats = field(default_factory=lambda: _empty(3, dtype=np.float64))  #: B × 3
    boundary_vertex_balls: Ints = field(default_factory=lambda: _empty(3))  #: B × 3: the balls of the three spheres
    scale: float = 1.0  #: by which radii have been divided (`shrink`): times it they are those of the union

    @staticmethod
    @checked
    def from_polygons(
        vertices: npt.ArrayLike,
        radii: npt.ArrayLike,
        faces: Polygons | list[Any] | npt.ArrayLike = (),
        edges: npt.ArrayLike = (),
        scale: float | None = None,
    ) -> MedialComplex:
        """A complex of one's own: the sides of the faces are added to the edges, and sheets are found.

        `scale`: by which the balls of a union had been grown, and their radii divided. Without it, radii are linear
        between vertices.
        """
        places = _arrays.points(vertices, "vertices")
        given = faces if isinstance(faces, Polygons) else _polygons_of_lists(faces)
        lists = Polygons(given.offsets, _arrays.indices(given.indices, "faces", (), len(places)))
        following = np.arange(1, len(lists.indices) + 1)
        following[lists.offsets[1:] - 1] = lists.offsets[:-1]
        sides = np.stack([lists.indices, lists.indices[following]], axis=1) if len(lists.indices) else _empty(2)
        every = np.sort(np.concatenate([sides, _arrays.indices(edges, "edges", (2,), len(places))]), axis=1)
        # Pairs in one number: rows take numpy ten times as long.
        pairs = every[:, 0].astype(np.int64) << 32 | every[:, 1]
        unique, number = np.unique(pairs, return_inverse=True)
        count = len(lists)
        return label_sheets(
            MedialComplex(
                vertices=places,
                radii=_arrays.scalars(radii, "radii", len(places)),
                edges=np.stack([unique >> 32, unique & 0xFFFFFFFF], axis=1).astype(np.int32),
                faces=lists,
                face_edges=number.reshape(-1)[: len(sides)].astype(np.int32),
                face_angles=np.zeros(count),
                face_sheets=np.zeros(count, dtype=np.int32),
                sheets=0,
                vertex_balls=np.full(len(places), -2 if scale is None else -1, dtype=np.int32),
                scale=1.0 if scale is None else scale,
            )
        )

    @property
    def balls(self) -> Floats:
        """V × 4: the balls at the vertices."""
        return np.column_stack([self.vertices, self.radii])

    @property
    def triangles(self) -> Ints:
        """T × 3: the faces cut into triangles."""
        return self.faces.triangulated()[0]

    @property
    def contacts(self) -> Floats:
        """F × 2 × 3: the two points of the boundary of the union that are closest to each face; empty if not known."""
        return self.boundary_vertices[self.face_contacts]

    @property
    def curves(self) -> Ints:
        """C × 2: the edges without a face."""
        is_side = np.zeros(len(self.edges), dtype=bool)
        is_side[self.face_edges] = True
        return self.edges[~is_side]

    def to_pyvista(self) -> pyvista.PolyData:
        """Isolated balls, curves and faces as cells of a pyvista.PolyData, in this order, with "radius" of points,
        "sheet" and "angle" of cells; a copy.
        """
        of_faces: dict[str, npt.NDArray[Any]] = {"sheet": self.face_sheets, "angle": self.face_angles}
        return pyvista_of(self.vertices, self.faces, self.curves, {"radius": self.radii}, of_faces)

    def transformed(self, matrix: npt.ArrayLike) -> MedialComplex:
        """The complex after a similarity, 3 × 4 or 4 × 4; others are refused, since balls would not stay balls."""
        similarity = similarity_of(matrix)
        return replace(
            self,
            vertices=similarity.points(self.vertices),
            radii=self.radii * similarity.factor,
            boundary_vertices=similarity.points(self.boundary_vertices),
        )

    def __repr__(self) -> str:
        return (
            f"MedialComplex({len(self.vertices):,} vertices, {len(self.edges):,} edges, "
            f"{len(self.faces):,} faces, {self.sheets:,} sheets)"
        )


def _polygons_of_lists(faces: Any) -> Polygons:
    lists = [_arrays.indices(face, "faces") for face in faces]
    sizes = np.cumsum([0, *(len(face) for face in lists)])
    return Polygons(sizes.astype(np.int32), np.concatenate([_empty(), *lists]).astype(np.int32))


def complex_of(core: Mapping[str, Any]) -> MedialComplex:
    """From the fields of the C++ part."""
    rest = {name: value for name, value in core.items() if name not in ("face_offsets", "face_vertices")}
    return MedialComplex(faces=Polygons(core["face_offsets"], core["face_vertices"]), **rest)


def core_of(given: Any) -> dict[str, Any]:
    """The fields that the C++ part takes."""
    given = stood_for(given)
    if not isinstance(given, MedialComplex):
        raise TypeError(f"a MedialComplex is needed, not {type(given).__name__}")
    count = np.iinfo(np.int32).max
    return {
        "vertices": _arrays.floats(given.vertices, "vertices", (3,), finite=False),
        "radii": _arrays.floats(given.radii, "radii", (), finite=False),
        "edges": _arrays.indices(given.edges, "edges", (2,), count, -count),
        "face_offsets": _arrays.indices(given.faces.offsets, "offsets of faces", (), count, -count),
        "face_vertices": _arrays.indices(given.faces.indices, "faces", (), count, -count),
        "face_edges": _arrays.indices(given.face_edges, "face_edges", (), count, -count),
        "face_angles": _arrays.floats(given.face_angles, "face_angles", (), finite=False),
        "face_sheets": _arrays.indices(given.face_sheets, "face_sheets", (), count, -count),
        "face_contacts": _arrays.indices(given.face_contacts, "face_contacts", (2,), count, -count),
        "boundary_vertices": _arrays.floats(given.boundary_vertices, "boundary_vertices", (3,), finite=False),
        "boundary_vertex_balls": _arrays.indices(
            given.boundary_vertex_balls, "boundary_vertex_balls", (3,), count, -count
        ),
        "vertex_balls": _arrays.indices(given.vertex_balls, "vertex_balls", (), count, -count),
        "sheets": int(given.sheets),
        "scale": float(given.scale),
    }


@checked
def check(given: MedialComplex) -> None:
    """Raises UnusableInput, naming the fault, if a complex is not what `MedialComplex` says."""
    _core.check_complex(core_of(given))


@checked
def label_sheets(given: MedialComplex) -> MedialComplex:
    """The complex with its faces split into sheets, which are connected across edges with exactly two faces."""
    return complex_of(_core.label_sheets(core_of(given)))


@dataclass(frozen=True, eq=False, repr=False)
class Samples:
    """A loose δ-sample of the boundary of a solid, with its Delaunay tetrahedra."""

    points: Floats  #: P × 3
    tetrahedra: Ints  #: T × 4
    neighbors: Ints  #: T × 4; [t, k] lies opposite to corner k; -1 at the hull
    centers: Floats  #: T × 3: circumcentres
    radii: Floats  #: T: circumradii
    inside: npt.NDArray[np.bool_]  #: T: does the circumcentre lie in the solid?
    tolerance: float  #: the bound on the radius of surface Delaunay balls that was asked for
    statistics: dict[str, Any]

    def __len__(self) -> int:
        return len(self.points)

    def transformed(self, matrix: npt.ArrayLike) -> Samples:
        """The samples after a similarity, 3 × 4 or 4 × 4."""
        similarity = similarity_of(matrix)
        order = [1, 0, 2, 3] if similarity.is_mirror else [0, 1, 2, 3]  # tetrahedra stay oriented
        return replace(
            self,
            points=similarity.points(self.points),
            tetrahedra=np.ascontiguousarray(self.tetrahedra[:, order]),
            neighbors=np.ascontiguousarray(self.neighbors[:, order]),
            centers=similarity.points(self.centers),
            radii=self.radii * similarity.factor,
            tolerance=self.tolerance * similarity.factor,
        )

    def __repr__(self) -> str:
        return (
            f"Samples({len(self.points):,} points, {len(self.tetrahedra):,} tetrahedra, tolerance {self.tolerance:.4g})"
        )


def core_of_samples(given: Samples) -> dict[str, Any]:
    if not isinstance(given, Samples):
        raise TypeError(f"Samples are needed, not {type(given).__name__}")
    core = {entry.name: getattr(given, entry.name) for entry in fields(Samples)}
    core["inside"] = np.ascontiguousarray(given.inside, dtype=np.bool_).view(np.uint8)
    return core


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Image:
    """Values at the points of a grid: `values[i, j, k]` is that at `origin + i steps[0] + j steps[1] + k steps[2]`."""

    values: npt.NDArray[Any]
    origin: Floats
    steps: Floats  #: one row for each index
    unit: str  #: of lengths, as "mm"; empty where it is not known
    space: str  #: where x, y and z point, as "right-anterior-superior"; empty where it is not known

    def __init__(
        self,
        values: npt.ArrayLike,
        origin: npt.ArrayLike | None = None,
        steps: npt.ArrayLike | None = None,
        unit: str = "",
        space: str = "",
        *,
        spacing: float | npt.ArrayLike | None = None,
        direction: npt.ArrayLike | None = None,
    ) -> None:
        """spacing, direction: in place of steps, their lengths, one or three, and their directions, a column each."""
        if steps is not None and not (spacing is None and direction is None):
            raise InvalidOption("steps have no effect beside spacing and direction: leave one of them out")
        if np.ma.is_masked(values):
            raise ValueError("values must not be masked: fill them first, as by values.filled(0)")
        for name, text in (("unit", unit), ("space", space)):
            if not isinstance(text, str):
                raise TypeError(f"{name} must be text, not {text!r}")
        place = _arrays.place(spacing, origin, direction)
        known = place[1:] if steps is None else _arrays.floats(steps, "steps", (3,))
        if known.shape != (3, 3):
            raise ValueError(f"steps must be 3 × 3, but their shape is {np.shape(known)}")
        for name, value in zip(("values", "origin", "steps"), (np.asanyarray(values), place[0], known)):
            object.__setattr__(self, name, value)
        object.__setattr__(self, "unit", unit)
        object.__setattr__(self, "space", space)

    @property
    def spacing(self) -> Floats:
        """The lengths of the steps."""
        return cast(Floats, np.linalg.norm(self.steps, axis=1))

    @property
    def direction(self) -> Floats:
        """3 × 3: the directions of the steps, one column each."""
        return (self.steps / self.spacing[:, None]).T

    def __repr__(self) -> str:
        shape = " × ".join(map(str, self.values.shape))
        return f"Image({shape}, spacing {self.spacing.round(6).tolist()})"


def image_of(core: Mapping[str, Any]) -> Image:
    values = core["values"].reshape(core["sizes"][::-1]).T
    return Image(values, core["place"][0].copy(), core["place"][1:].copy(), core["unit"], core["space"])
