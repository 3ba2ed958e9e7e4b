# SPDX-License-Identifier: Apache-2.0
"""Maps that keep balls round: rotation, reflection, one factor for all directions, shift."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from . import _arrays
from ._arrays import Floats
from .errors import InvalidOption

_TOLERANCE = 1e-5  # of the factor; matrices in single precision are no better


class Similarity(NamedTuple):
    """x → linear @ x + shift."""

    linear: Floats  #: 3 × 3: a rotation or reflection, times the factor
    shift: Floats  #: 3
    factor: float  #: of all lengths

    @property
    def is_mirror(self) -> bool:
        """Does it turn right hands into left ones?"""
        return bool(np.linalg.det(self.linear) < 0)

    def points(self, given: Floats) -> Floats:
        """Of arrays whose last axis has the three coordinates."""
        moved: Floats = given @ self.linear.T + self.shift
        return moved

    def balls(self, given: Floats) -> Floats:
        """N × 4: centres and radii."""
        return np.column_stack([self.points(given[:, :3]), given[:, 3] * self.factor])


def similarity_of(matrix: npt.ArrayLike) -> Similarity:
    """Of a matrix, 3 × 4, or 4 × 4 with 0, 0, 0, 1 as last row. Raises ValueError, or InvalidOption if balls would not
    stay balls.
    """
    given = np.asarray(matrix)
    if given.shape not in ((3, 4), (4, 4)):
        raise ValueError(f"matrix must be 3 × 4 or 4 × 4, but its shape is {given.shape}")
    affine = _arrays.floats(given, "matrix", (4,))
    if len(affine) == 4 and affine[3].tolist() != [0, 0, 0, 1]:
        raise ValueError(f"the last row of matrix must be 0, 0, 0, 1, not {affine[3].tolist()}")
    linear, shift = affine[:3, :3], affine[:3, 3]
    stretch = np.linalg.svd(linear, compute_uv=False)
    if not stretch[0] > 0 or stretch[0] - stretch[2] > _TOLERANCE * stretch[0]:
        raise InvalidOption(
            f"matrix stretches by {stretch[0]:.6g} in one direction and by {stretch[2]:.6g} in another, so that balls "
            "would become ellipsoids: give one factor for all directions, with rotations, reflections and shifts, or "
            "compute the axis of the stretched input",
        )
    return Similarity(linear, shift, float(np.cbrt(stretch.prod())))
