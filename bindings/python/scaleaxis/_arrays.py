# SPDX-License-Identifier: Apache-2.0
"""What users give → arrays of the one type and layout that the library takes. Those that have it are not copied."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]

_REAL = "iufb"


def _numbers(given: npt.ArrayLike, name: str) -> npt.NDArray[Any]:
    try:
        array = np.asarray(given)
    except ValueError as error:  # rows of different lengths
        raise ValueError(f"{name}: {error}") from None
    if array.dtype.kind not in _REAL:
        raise ValueError(f"{name} must hold real numbers, not {array.dtype}")
    return array


def _checked_rows(array: npt.NDArray[Any], name: str, shape: tuple[int, ...]) -> None:
    if array.ndim != len(shape) + 1 or array.shape[1:] != shape:
        wanted = " × ".join(["N", *map(str, shape)])
        raise ValueError(f"{name} must be {wanted}, but its shape is {array.shape}")


def _first_row_not_finite(array: Floats) -> int:
    return int(np.flatnonzero(~np.isfinite(array.reshape(len(array), -1)).all(axis=1))[0])


def floats(given: npt.ArrayLike, name: str, shape: tuple[int, ...], *, finite: bool = True) -> Floats:
    """N × shape numbers as contiguous float64."""
    array = _numbers(given, name)
    if array.size == 0 and array.ndim < 2:
        array = array.reshape(0, *shape)
    _checked_rows(array, name, shape)
    result = np.ascontiguousarray(array, dtype=np.float64)
    if finite and not np.isfinite(result).all():
        raise ValueError(f"{name} must be finite, but row {_first_row_not_finite(result)} is not")
    return result


def points(given: npt.ArrayLike, name: str = "points", *, empty: bool = True, finite: bool = True) -> Floats:
    array = floats(given, name, (3,), finite=finite)
    if not empty and len(array) == 0:
        raise ValueError(f"{name} is empty")
    return array


def balls(given: npt.ArrayLike, name: str = "balls") -> Floats:
    """N × 4: centre and radius. The library checks the radii."""
    return floats(given, name, (4,), finite=False)


def contacts(given: npt.ArrayLike, name: str = "contacts") -> Floats:
    return floats(given, name, (2, 3))


def scalars(given: npt.ArrayLike, name: str, count: int | None = None, *, finite: bool = True) -> Floats:
    """Numbers, one for each of `count` elements; one number is for all of them."""
    array = _numbers(given, name)
    if array.ndim == 0 and count is not None:
        array = np.full(count, array)
    result = floats(array, name, (), finite=finite)
    if count is not None and len(result) != count:
        raise ValueError(f"{name} must have {count} entries, not {len(result)}")
    return result


def indices(
    given: npt.ArrayLike, name: str, shape: tuple[int, ...] = (), end: int | None = None, least: int = 0
) -> Ints:
    """N × shape whole numbers from `least` to `end` - 1 as contiguous int32."""
    array = _numbers(given, name)
    if array.size == 0 and array.ndim < 2:
        array = array.reshape(0, *shape)
    _checked_rows(array, name, shape)
    if array.dtype.kind == "f" and array.size and not (np.isfinite(array).all() and (array == np.floor(array)).all()):
        raise ValueError(f"{name} must hold whole numbers")
    if array.dtype.kind == "b":
        raise ValueError(f"{name} must hold whole numbers, not {array.dtype}")
    if array.size:
        low, high = int(array.min()), int(array.max())
        limit = np.iinfo(np.int32).max + 1 if end is None else end
        if low < least or high >= limit:
            raise ValueError(f"{name} must lie from {least} to {limit - 1}, but they go from {low} to {high}")
    return np.ascontiguousarray(array, dtype=np.int32)


def mesh(vertices: npt.ArrayLike, faces: npt.ArrayLike) -> tuple[Floats, Ints]:
    """Vertices and triangles. Polygons of one size are cut into triangles."""
    given = points(vertices, "vertices")
    if len(given) == 0:
        raise ValueError("the mesh is empty: it has no vertices")
    array = _numbers(faces, "faces")
    if array.ndim == 2 and array.shape[1] > 3:
        polygons = indices(array, "faces", array.shape[1:], len(given))
        array = np.concatenate([polygons[:, [0, k, k + 1]] for k in range(1, array.shape[1] - 1)])
    triangles = indices(array, "faces", (3,), len(given))
    if len(triangles) == 0:
        raise ValueError("the mesh is empty: it has no faces")
    return given, triangles


def box(given: npt.ArrayLike, name: str = "bounds") -> Floats:
    """2 × 3: the least and the largest coordinates; six numbers are these one after the other."""
    array = _numbers(given, name)
    if array.size != 6:
        raise ValueError(f"{name} must be the least and the largest coordinates, 2 × 3, but its shape is {array.shape}")
    return floats(array.reshape(2, 3), name, (3,))


def place(
    spacing: float | npt.ArrayLike | None, origin: npt.ArrayLike | None, direction: npt.ArrayLike | None
) -> Floats:
    """4 × 3: the origin of an image, and its steps along each index."""
    lengths = scalars(1.0 if spacing is None else spacing, "spacing", 3)
    if not (lengths > 0).all():
        raise ValueError(f"spacing must be positive, not {lengths.tolist()}")
    given = np.eye(3) if direction is None else np.asarray(direction)
    if given.size != 9:
        raise ValueError(f"direction must be 3 × 3, but its shape is {given.shape}")
    axes = floats(given.reshape(3, 3), "direction", (3,))
    start = scalars(0.0 if origin is None else origin, "origin", 3)
    return np.ascontiguousarray(np.vstack([start, (axes * lengths).T]))


def voxels(given: npt.ArrayLike) -> npt.NDArray[np.float32]:
    """Values as the library has them: the last index is that of the image's first axis."""
    array = _numbers(given, "voxels")
    if array.ndim != 3:
        raise ValueError(f"voxels must have three dimensions, but their shape is {array.shape}")
    if array.size == 0:
        raise ValueError(f"the image is empty: its shape is {array.shape}")
    values = np.ascontiguousarray(array.T, dtype=np.float32)
    if values.dtype != array.dtype and array.dtype.kind in "fiu" and not np.isfinite(values).all():
        bad = np.argwhere(~np.isfinite(values))[0][::-1]
        raise ValueError(f"voxels must be finite in single precision, but {tuple(map(int, bad))} is not")
    return values


# Beyond it not all whole numbers have a float32 of their own.
MOST_LABEL = 2**24


def numbered(values: npt.NDArray[Any]) -> tuple[npt.NDArray[Any], npt.NDArray[Any] | None]:
    """Labels that float32 would merge as numbers from 1 in their order, 0 as 0, and the label of each number; other
    values as they are, and None.
    """
    if values.size == 0 or values.dtype.kind not in "iuf" or np.can_cast(values.dtype, np.float32):
        return values, None
    largest = max(values.max().item(), -values.min().item())
    if not MOST_LABEL < largest < np.inf or (values.dtype.kind == "f" and (values != np.floor(values)).any()):
        return values, None
    labels = np.unique(values[values != 0])
    if len(labels) >= MOST_LABEL:
        raise ValueError(f"{len(labels)} labels are more than the {MOST_LABEL} that are told apart")
    numbers = np.where(values == 0, 0, np.searchsorted(labels, values) + 1).astype(np.float32)
    return numbers, np.concatenate([np.zeros(1, labels.dtype), labels])


def check_kept(values: npt.NDArray[Any]) -> None:
    """Raises ValueError for whole numbers that a file of 32-bit floats merges."""
    if values.dtype.kind not in "iu" or np.can_cast(values.dtype, np.float32) or values.size == 0:
        return
    if max(values.max().item(), -values.min().item()) > MOST_LABEL:
        raise ValueError(
            "files get 32-bit floats, which hold whole numbers up to 2^24, and voxels have larger ones: number labels "
            "anew, as by numpy.unique with return_inverse, or give levels of grey as float32"
        )


def scales(given: float | Sequence[float] | npt.ArrayLike) -> list[float]:
    values: list[float] = np.atleast_1d(floats(np.atleast_1d(_numbers(given, "scale")), "scale", ())).tolist()
    if not values:
        raise ValueError("scale is empty: at least one factor is needed")
    return values
