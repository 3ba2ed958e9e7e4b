# SPDX-License-Identifier: Apache-2.0
"""Results as a page that any browser shows."""

from __future__ import annotations

import html
import json
import os
import tempfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path as _Path
from typing import Any, Protocol, runtime_checkable

import numpy as np

from . import _core
from ._arrays import Floats
from ._options import checked
from .data import MedialComplex, Mesh, core_of
from .files import Path
from .surfaces import mesh

NO_MESH = Mesh(np.empty((0, 3)), np.empty((0, 3), dtype=np.int32))
_MOST_SIDE_BY_SIDE = 6  # more models become a contact sheet


@runtime_checkable
class AxisLike(Protocol):
    """What pages and measures need of an `Axis`."""

    @property
    def name(self) -> str: ...
    @property
    def scale(self) -> float: ...
    @property
    def complex(self) -> MedialComplex: ...
    @property
    def boundary(self) -> Mesh | None: ...
    @property
    def balls(self) -> Floats: ...
    @property
    def tolerance(self) -> float: ...
    @property
    def statistics(self) -> Mapping[str, Any]: ...
    @property
    def transform(self) -> Floats: ...
    @property
    def is_mask(self) -> bool: ...


@dataclass(frozen=True)
class Page:
    """A page that was written to `path`: one HTML file, which needs nothing else. Jupyter shows it inline."""

    path: _Path
    height: int = 600

    @property
    def html(self) -> str:
        """The page itself."""
        return self.path.read_text(encoding="utf-8")

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{html.escape(self.html)}" width="100%" height="{self.height}" '
            'style="border: 0" allowfullscreen></iframe>'
        )


def boundary_of(axis: AxisLike) -> Mesh:
    """The input if it was a mesh, or else the boundary of its balls."""
    return axis.boundary or mesh(axis.balls, delta_abs=axis.tolerance).mesh


def viewed_axis(complex: dict[str, Any], statistics: Any = None) -> dict[str, Any]:
    """As the core takes them for a page."""
    return {"complex": complex, "statistics": "" if statistics is None else json.dumps(statistics)}


def _model(axes: list[AxisLike]) -> bytes:
    first = axes[0]
    about = {key: value for key, value in first.statistics.items() if key != "axis"}
    viewed = [viewed_axis(core_of(axis.complex), axis.statistics["axis"]) for axis in axes]
    return _core.view_data(first.name, *boundary_of(first), viewed, json.dumps({"input": first.name, **about}), None)


def page_path(path: Path | None, name: str) -> Path:
    """Where a page can be written; by default a new file in the folder for temporary files."""
    if path is None:
        handle, path = tempfile.mkstemp(prefix=f"{name}-", suffix=".html")
        os.close(handle)
    _core.check_view_output(path)
    return path


def write_page(path: Path, title: str, models: list[bytes]) -> Page:
    """Models as the core has packed them."""
    _core.write_view(path, title, len(models) > _MOST_SIDE_BY_SIDE, models)
    return Page(_Path(path))


@checked
def view(axes: AxisLike | Iterable[AxisLike], path: Path | None = None, title: str | None = None) -> Page:
    """One page of one or several results. Those of one run at several scales share a model, with a slider.

    path: where to write it, .html; default: a new file in the folder for temporary files.
    """
    every = [axes] if isinstance(axes, AxisLike) else list(axes)
    if not every:
        raise ValueError("there is no axis to show")
    path = page_path(path, every[0].name)
    runs: dict[int, list[AxisLike]] = {}
    for axis in every:
        runs.setdefault(id(axis.balls), []).append(axis)
    names = dict.fromkeys(run[0].name for run in runs.values())
    return write_page(path, title or ", ".join(names), [_model(run) for run in runs.values()])
