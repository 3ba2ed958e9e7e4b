# SPDX-License-Identifier: Apache-2.0
"""The axes of whole data sets: many models in, a file and a row of a table out for each (docs/batch.md).

    from scaleaxis.batch import batch
    batch("models/*.off", "results", delta=0.01, scale=1.1)

The same call again computes what is missing.
"""

from .call import batch
from .models import Model, Models
from .progress import Counts

__all__ = ["Counts", "Model", "Models", "batch"]
