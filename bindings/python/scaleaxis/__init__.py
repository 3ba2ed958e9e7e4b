# SPDX-License-Identifier: Apache-2.0
"""Stable medial axis of solid shapes: the discrete scale axis.

    import scaleaxis
    axis = scaleaxis.axis("cat.obj", delta=0.01, scale=1.1)
    axis.vertices, axis.radii, axis.triangles

`axis` does everything; the stages that it consists of are functions under their names in C++.
"""

from . import errors
from ._core import peak_memory
from ._core import version as __version__
from ._progress import Progress
from .data import Image, MedialComplex, Mesh, Polygons, Samples, Topology, check, label_sheets, polygons_of
from .errors import (
    Cancelled,
    Error,
    FileError,
    InconsistentResult,
    InvalidOption,
    UnusableInput,
    Warning,
)
from .files import (
    PointCloud,
    check_axis_output,
    check_balls_output,
    check_image_output,
    check_mesh_output,
    file_kind,
    read_axis,
    read_balls,
    read_image,
    read_mesh,
    read_points,
    write_axis,
    write_balls,
    write_image,
    write_mesh,
)
from .loading import LoadedSolid, load
from .page import Page, view
from .pipeline import axis, scale_axis
from .result import Axis
from .solids import (
    BallUnion,
    Solid,
    cloud_solid,
    function_solid,
    image_solid,
    mesh_solid,
    repair_mesh,
    union_solid,
)
from .stages import (
    DEFAULT_SLACK,
    BoundaryMesh,
    FilteredComplex,
    FittedBalls,
    Gap,
    MedialAxis,
    RepairedBalls,
    SolidUnion,
    boundary_mesh,
    check_balls,
    crust,
    default_union,
    densify,
    distinct_balls,
    distinct_positions,
    filter,
    fit,
    inner_balls,
    medial_axis,
    perturbed,
    repair,
    sample,
    scaled,
    shrink,
    smooth,
    thresholded,
    tolerance_of,
    topology,
    union_accuracy,
    union_of,
)
from .surfaces import (
    OneSidedDistance,
    SurfaceDistance,
    UnionMesh,
    compare,
    image_topology,
    mesh,
    sample_field,
    smoothed_mask,
)

# The names in C++ of what the program calls otherwise.
union_mesh = mesh
surface_distance = compare
signed_distance_image = sample_field
load_solid = load

__all__ = [name for name in dir() if not name.startswith("_")]
