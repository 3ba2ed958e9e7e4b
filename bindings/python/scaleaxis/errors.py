# SPDX-License-Identifier: Apache-2.0
"""What the library throws and warns of. docs/diagnostics.md lists the codes."""

from __future__ import annotations

import json
import warnings
from typing import Any

Place = tuple[float, float, float]


class Diagnostic(Exception):
    """What errors and warnings have in common.

    code: stable name for programs, as "mesh.sheet".
    element, index: what it is about ("triangle", 17), or None.
    place: where that lies, in units of the input, or None.
    """

    code: str
    element: str | None
    index: int | None
    place: Place | None

    def __init__(
        self,
        message: str,
        code: str = "",
        element: str | None = None,
        index: int | None = None,
        place: Place | None = None,
    ) -> None:
        super().__init__(message)
        self.code = code
        self.element = element
        self.index = index
        self.place = place

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.code, self.element, self.index, self.place)


class Error(Diagnostic):
    """Base of all errors of the library; members as those of `Diagnostic`."""


class InvalidOption(Error, ValueError):
    """An option lies outside its documented range, or would have no effect."""


class FileError(Error, OSError):
    """A file cannot be opened, read or written, or is not what its format demands."""


class UnusableInput(Error, ValueError):
    """The data describe nothing that the method can take (an open mesh, no volume, a ball of radius 0…)."""


class InconsistentResult(Error, RuntimeError):
    """The computation found its own result inconsistent."""


class Cancelled(Error):
    """The function that is told the progress has returned False."""


class Warning(Diagnostic, UserWarning):
    """What was repaired in an input, or is odd about a result; members as those of `Diagnostic`."""


def warnings_of(diagnostics: str) -> list[Warning]:
    """The warnings in JSON of the library."""
    return [
        Warning(
            entry["message"], entry["code"], entry["element"], entry["index"], entry["place"] and tuple(entry["place"])
        )
        for entry in json.loads(diagnostics)
    ]


def warn(found: list[Warning], stacklevel: int = 3) -> None:
    """Python warnings, for the line that called a public function."""
    for warning in found:
        warnings.warn(warning, stacklevel=stacklevel)
