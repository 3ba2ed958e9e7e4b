# SPDX-License-Identifier: Apache-2.0
"""Volumes larger than memory, in blocks that give what the whole would give (docs/volumes.md).

    from scaleaxis.volumes import volume
    volume("scan.zarr", "results", memory="4GB", label=3)

The same call again computes what is missing.
"""

from .call import Report, volume
from .sources import Source

__all__ = ["Report", "Source", "volume"]
