# SPDX-License-Identifier: Apache-2.0
"""Shapes of CAD programs → meshes. Their packages are imported where a shape or a STEP file needs them."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from .data import Mesh

#: How far triangles may be from the shape, in diagonals of its bounding box: a hundredth of the default δ.
LINEAR = 1e-4
#: Between normals along an edge of the triangles, in radians: for curves that are small beside the shape.
ANGULAR = 0.1


def is_shape(given: Any) -> bool:
    """Of build123d or CadQuery (`tessellate`), a workplane of CadQuery (`vals`), or of OCP (`TShape`)."""
    return any(callable(getattr(given, name, None)) for name in ("tessellate", "TShape")) or (
        callable(getattr(given, "vals", None)) and callable(getattr(given, "val", None))
    )


def is_step(path: str | os.PathLike[str]) -> bool:
    return os.fspath(path).lower().endswith((".step", ".stp"))


def _diagonal_of(shape: Any) -> float:
    if hasattr(shape, "BoundingBox"):  # CadQuery
        return float(shape.BoundingBox().DiagonalLength)
    return float(shape.bounding_box().diagonal)


def _coordinates(place: Any) -> tuple[float, float, float]:
    for name in ("toTuple", "to_tuple"):
        if hasattr(place, name):
            return tuple(getattr(place, name)())
    return tuple(place)


def _joined(meshes: list[Mesh]) -> Mesh:
    """One mesh, in which faces share the vertices at the same place."""
    starts = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes[:-1]])
    triangles = np.concatenate([mesh.triangles + start for mesh, start in zip(meshes, starts)])
    vertices, numbers = np.unique(np.concatenate([mesh.vertices for mesh in meshes]), axis=0, return_inverse=True)
    return Mesh(vertices, numbers.reshape(-1)[triangles].astype(np.int32))


def mesh_of_shape(shape: Any) -> Mesh:
    """Triangles within `LINEAR` of a shape."""
    if callable(getattr(shape, "vals", None)):
        return _joined([mesh_of_shape(one) for one in shape.vals()])
    if callable(getattr(shape, "tessellate", None)):
        places, triangles = shape.tessellate(LINEAR * _diagonal_of(shape), ANGULAR)
        vertices = np.array([_coordinates(p) for p in places], dtype=np.float64).reshape(-1, 3)
        return _joined([Mesh(vertices, np.array(triangles, dtype=np.int32).reshape(-1, 3))])
    return _mesh_of_topods(shape)


def _mesh_of_topods(shape: Any) -> Mesh:
    from OCP.Bnd import Bnd_Box
    from OCP.BRep import BRep_Tool
    from OCP.BRepBndLib import BRepBndLib
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.TopAbs import TopAbs_FACE, TopAbs_REVERSED
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS

    box = Bnd_Box()
    BRepBndLib.Add_s(shape, box)
    BRepMesh_IncrementalMesh(shape, LINEAR * box.SquareExtent() ** 0.5, False, ANGULAR, True)
    as_face = getattr(TopoDS, "Face_s", None) or TopoDS.Face
    meshes = []
    faces = TopExp_Explorer(shape, TopAbs_FACE)
    while faces.More():
        face = as_face(faces.Current())
        location = TopLoc_Location()
        found = BRep_Tool.Triangulation_s(face, location)
        if found is not None:
            move = location.Transformation()
            nodes = [found.Node(i + 1).Transformed(move) for i in range(found.NbNodes())]
            triangles = np.array([found.Triangle(i + 1).Get() for i in range(found.NbTriangles())], dtype=np.int32) - 1
            if face.Orientation() == TopAbs_REVERSED:
                triangles = triangles[:, ::-1]
            meshes.append(Mesh(np.array([(p.X(), p.Y(), p.Z()) for p in nodes]), triangles))
        faces.Next()
    if not meshes:
        raise ValueError("the shape has no faces")
    return _joined(meshes)


def mesh_of_step(path: Any) -> Mesh:
    """What a STEP file holds, by OCP (package `cadquery-ocp`)."""
    try:
        from OCP.IFSelect import IFSelect_RetDone
        from OCP.STEPControl import STEPControl_Reader
    except ImportError as error:
        raise ImportError("STEP files are read by OCP: pip install cadquery-ocp") from error
    reader = STEPControl_Reader()
    if reader.ReadFile(os.fspath(path)) != IFSelect_RetDone:
        from .errors import FileError

        raise FileError(f"{os.fspath(path)}: it is no STEP file, or damaged")
    reader.TransferRoots()
    return _mesh_of_topods(reader.OneShape())
