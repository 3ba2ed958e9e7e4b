# SPDX-License-Identifier: Apache-2.0
"""Skeletons as Neuroglancer reads them: https://github.com/google/neuroglancer, precomputed, skeletons."""

from __future__ import annotations

import json

import numpy as np

from ..batch.storage import Storage
from ..result import Skeleton


def write_precomputed(storage: Storage, skeleton: Skeleton, segment: int = 1) -> None:
    """`skeletons/info` and the skeleton of one segment, with radii. Lengths are taken for nanometres."""
    info = {
        "@type": "neuroglancer_skeletons",
        "transform": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0],
        "vertex_attributes": [{"id": "radius", "data_type": "float32", "num_components": 1}],
    }
    counts = np.array([len(skeleton.nodes), len(skeleton.edges)], "<u4")
    arrays = [skeleton.nodes.astype("<f4"), skeleton.edges.astype("<u4"), skeleton.radii.astype("<f4")]
    storage.write("skeletons/info", json.dumps(info).encode())
    storage.write(f"skeletons/{segment}", counts.tobytes() + b"".join(array.tobytes() for array in arrays))
