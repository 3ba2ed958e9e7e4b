# SPDX-License-Identifier: Apache-2.0
"""Why an axis has another Euler characteristic than its solid: kinds of places, and how to mend them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product

import numpy as np
import numpy.typing as npt

from .. import _core

Mask = npt.NDArray[np.bool_]

CAUSES = {
    "growing": "growing closes a gap",
    "contact": "voxels touch in an edge or a corner alone",
    "thin": "a part or a gap is one voxel thick",
}
_WIDEST = 64  # voxels: of gaps that are looked for; one that is closed and wider has balls of 320 beside it at s = 1.1


def _corners(mask: Mask) -> npt.NDArray[np.bool_]:
    """Of each 2 x 2 x 2 voxels the eight, in three axes before those of the array."""
    parts = [mask[tuple(slice(a, n - 1 + a) for a, n in zip(at, mask.shape))] for at in product((0, 1), repeat=3)]
    return np.stack(parts).reshape(2, 2, 2, *parts[0].shape)


def _spread(cells: Mask) -> Mask:
    """The voxels of 2 x 2 x 2 cells."""
    mask = np.zeros(tuple(n + 1 for n in cells.shape), bool)
    for at in product((0, 1), repeat=3):
        mask[tuple(slice(a, n + a) for a, n in zip(at, cells.shape))] |= cells
    return mask


def _is_thin(mask: Mask) -> Mask:
    """In no 2 x 2 x 2 voxels of the mask."""
    return mask & ~_spread(np.logical_and.reduce(_corners(mask), (0, 1, 2)))


def _contacts(inside: Mask) -> Mask:
    """What fills the cells in which two voxels inside touch, or two outside, in an edge or a corner alone, until there are
    none.
    """
    whole = inside.copy()
    while True:
        corners = _corners(whole)
        crosses = (corners == corners[::-1, ::-1, ::-1]).all((0, 1, 2)) & np.isin(corners.sum((0, 1, 2)), (2, 6))
        for axis in range(3):
            for end in range(2):
                (a, b), (c, d) = np.moveaxis(corners, axis, 0)[end]
                crosses |= (a == d) & (b == c) & (a != b)
        more = _spread(crosses) & ~whole
        for axis in range(3):  # the rim is outside, and stays so
            np.moveaxis(more, axis, 0)[[0, -1]] = False
        if not more.any():
            return whole & ~inside
        whole |= more


def _gaps(inside: Mask, scale: float, threads: int) -> Mask:
    """Between voxels along an axis whose largest balls together grow by as much as they are apart."""
    sizes = list(inside.shape[::-1])
    place = [[0] * 3, [0] * 3, sizes, sizes, [0] * 3, [0] * 3]
    diameters = _core.thickness_of_block(inside.astype(np.uint8), place, threads).reshape(inside.shape)
    grown = (scale - 1.0) * np.maximum(diameters / 2 - 0.5, 0.0)  # depths are those to the centre of a voxel outside
    gaps = np.zeros(inside.shape, bool)
    for axis in range(3):
        at, found = np.moveaxis(inside, axis, 0), np.moveaxis(gaps, axis, 0)
        reach = np.moveaxis(grown, axis, 0)
        is_empty = np.ones(at.shape, bool)
        for width in range(1, min(_WIDEST, math.floor(2 * float(grown.max()))) + 1):
            is_empty = ~at[width:-1] & is_empty[: len(at) - width - 1]  # of the voxels after one
            closed = at[: -width - 1] & at[width + 1 :] & is_empty & (reach[: -width - 1] + reach[width + 1 :] >= width)
            for step in range(1, width + 1):
                found[step : step + len(closed)] |= closed
    return gaps


def _thin(inside: Mask) -> Mask:
    """What makes thin parts thicker, and fills thin gaps."""
    parts = np.pad(_is_thin(inside), 1)
    around = np.zeros(inside.shape, bool)
    for at in product(range(3), repeat=3):
        around |= parts[tuple(slice(a, n + a) for a, n in zip(at, inside.shape))]
    found = (around | _is_thin(~inside)) & ~inside
    for axis in range(3):
        np.moveaxis(found, axis, 0)[[0, -1]] = False
    return found


def repairs(inside: Mask, scale: float, threads: int) -> Iterator[tuple[str, Mask]]:
    """Of each kind the voxels that mend its places if they are made inside. The rim is outside."""
    yield "growing", _gaps(inside, scale, threads)
    yield "contact", _contacts(inside)
    yield "thin", _thin(inside)
