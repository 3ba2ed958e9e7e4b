# SPDX-License-Identifier: Apache-2.0
"""The order of the gallery."""

ORDER = (
    "first_axis",
    "scale",
    "delta",
    "round_trip",
    "vessel",
    "point_scan",
    "implicit",
    "data_set",
    "large_volume",
    "with_pyvista",
    "blender",
    "jupyter",
)


def key(file: str) -> int:
    """The place of an example; one that is not listed is an error."""
    return ORDER.index(file.removesuffix(".py"))
