# SPDX-License-Identifier: Apache-2.0
"""Skeletons as Neuroglancer reads them: https://github.com/google/neuroglancer, precomputed, skeletons."""

from __future__ import annotations

import json

import numpy as np

from ..batch.storage import Storage
from ..result import Skeleton
from .formats import NANOMETRES


def write_precomputed(storage: Storage, skeleton: Skeleton, segment: int, unit: str) -> None:
    """`skeletons/info` and the skeleton of one segment, with radii, in nanometres: an unknown unit is these."""
    size = NANOMETRES.get(unit, 1.0)
    info = {
        "@type": "neuroglancer_skeletons",
        "transform": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0],
        "vertex_attributes": [{"id": "radius", "data_type": "float32", "num_components": 1}],
    }
    counts = np.array([len(skeleton.nodes), len(skeleton.edges)], "<u4")
    nodes, radii = (size * skeleton.nodes).astype("<f4"), (size * skeleton.radii).astype("<f4")
    storage.write("skeletons/info", json.dumps(info).encode())
    storage.write(
        f"skeletons/{segment}",
        counts.tobytes() + nodes.tobytes() + skeleton.edges.astype("<u4").tobytes() + radii.tobytes(),
    )
