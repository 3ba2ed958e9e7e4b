# SPDX-License-Identifier: Apache-2.0
"""Which blocks there are, how much around each matters, and how much memory that takes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import _core
from ..errors import InvalidOption
from .blocks import CELL, blocks_of, box_of
from .sources import Triple

# Bytes, measured with bench/bench_volumes and rounded up: of a process; of each voxel of an array while its values are
# made, and after that; of each crossing of a lattice edge in it (Delaunay triangulations and the axis).
_PROCESS = 120_000_000
_VOXEL = 16
_VALUE = 5
_CROSSING = 4500
_THICKNESS = 12  # of each voxel of an array where the thickness alone is wanted
_DEPTHS = 10  # and where depths are found
_CHOICES = (512, 384, 256, 192, 128, 96, 64, 32)  # sizes of blocks, in voxels
_ROUND = 1e-9
_MARGIN = 6  # voxels: what 4 passes of smoothing look at, and one for the layer around the solid


class Block(NamedTuple):
    low: Triple
    high: Triple
    halo: int
    largest_depth: float  #: of what it depends on
    memory: int
    content: tuple[Triple, Triple]  #: with this halo, all that is inside


@dataclass(frozen=True)
class DepthMap:
    """Of each cell of CELL voxels: voxels inside, the largest depth, crossings of lattice edges. Arrays have x first."""

    sizes: Triple
    voxels: npt.NDArray[np.int64]
    depths: npt.NDArray[np.float64]
    crossings: npt.NDArray[np.int64]

    @staticmethod
    def of(sizes: Triple, rows: list[dict[str, Any]]) -> DepthMap:
        shape = tuple(-(-size // CELL) for size in sizes)
        voxels, crossings = np.zeros(shape, np.int64), np.zeros(shape, np.int64)
        depths = np.zeros(shape)
        for row in rows:
            for x, y, z, inside, depth, sides in row["cells"]:
                voxels[x, y, z], crossings[x, y, z], depths[x, y, z] = inside, sides, math.sqrt(depth)
        return DepthMap(sizes, voxels, depths, crossings)

    def _at(self, low: Triple, high: Triple, halo: float) -> tuple[slice, ...]:
        return tuple(
            slice(max(0, int((a - halo) // CELL)), min(n, int(-(-(b + halo) // CELL))))
            for a, b, n in zip(low, high, self.depths.shape)
        )

    def block(self, low: Triple, high: Triple, scale: float | None) -> Block | None:
        """None where nothing is inside. The halo and the largest depth within it depend on each other: both grow until
        they agree. Without a scale no axis is wanted, but the thickness alone.
        """
        core = self._at(low, high, 0)
        if not self.voxels[core].any():
            return None
        core_depth = float(self.depths[core].max())
        depth, halo = core_depth, 0
        while True:
            # A ball that reaches the core has its centre within its radius; how deep that is needs as much again.
            if scale is None:
                halo = halo_of_thickness(depth)
            else:
                halo = math.ceil(_core.halo_of_axis(core_depth, depth, scale)) + 1
            around = float(self.depths[self._at(low, high, depth if scale is None else halo)].max())
            if around <= depth + _ROUND:
                break
            depth = around
        content = self._content(low, high, halo + _MARGIN)
        extents = [min(b, d + halo) - max(a, c - halo) + 2 for a, b, c, d in zip(*content, low, high)]
        voxels = math.prod(extents)
        if scale is None:
            return Block(low, high, halo, depth, _PROCESS + _THICKNESS * voxels, content)
        crossings = int(self.crossings[self._at(low, high, halo)].sum())
        memory = _PROCESS + max(_VOXEL * voxels, _VALUE * voxels + _CROSSING * crossings)
        return Block(low, high, halo, depth, memory, content)

    def _content(self, low: Triple, high: Triple, halo: int) -> tuple[Triple, Triple]:
        """The voxels of the cells around all that is inside."""
        at = self._at(low, high, halo)
        box = box_of(self.voxels[at])
        assert box is not None
        cells = [(a.start + b.start, a.start + b.stop) for a, b in zip(at, box)]
        x, y, z = ((a * CELL, min(b * CELL, n)) for (a, b), n in zip(cells, self.sizes))
        return (x[0], y[0], z[0]), (x[1], y[1], z[1])

    def plan(self, scale: float | None, memory: int, edge: int | None) -> tuple[int, list[Block]]:
        """The size of blocks and those that are not empty. Raises InvalidOption if one needs more than `memory`."""
        for size in (edge,) if edge else _CHOICES:
            found = (self.block(low, high, scale) for low, high in blocks_of((0, 0, 0), self.sizes, size))
            blocks = [block for block in found if block is not None]
            most = max((block.memory for block in blocks), default=0)
            if most <= memory:
                return size, blocks
        at = next(block for block in blocks if block.memory == most)
        raise InvalidOption(
            f"the block at voxel {', '.join(map(str, at.low))} of {size} voxels takes about {most / 1e9:.2g} GB with what "
            f"is around it, where the solid is {at.largest_depth:.3g} voxels deep; a worker may have {memory / 1e9:.2g} GB: "
            "give more memory, use fewer workers or smaller blocks, or take a coarser level of the volume"
        )


def halo_of_thickness(depth: float) -> int:
    return 2 * math.ceil(depth) + 2


def first_edge(memory: int) -> int:
    """Of the blocks whose depths are found: arrays may have to grow by a halo, so that four times as much is left."""
    return max(CELL, min(_CHOICES[0], int((memory / (4 * _DEPTHS)) ** (1 / 3)) // CELL * CELL))
