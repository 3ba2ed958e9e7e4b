# SPDX-License-Identifier: Apache-2.0
"""What the library throws and warns of. docs/diagnostics.md lists the codes."""

from __future__ import annotations

import json
import os
import sys
import warnings
from collections.abc import Iterable
from typing import Any

_PACKAGE = os.path.dirname(__file__) + os.sep

Place = tuple[float, float, float]


# Options of hints that have another name here.
_NAMES = {"solid": "triangles", "label": "labels", "each-label": "label_axes"}


def with_hints(message: str, hints: Iterable[tuple[str, str | None]]) -> str:
    """A message of the library, and the options that would help."""
    options = []
    for option, value in hints:
        name = _NAMES.get(option, option.replace("-", "_"))
        options.append(name + (f"={value!r}" if value and value.isalpha() else f"={value}" if value else ""))
    return message + (f" ({', '.join(options)})" if options else "")


class Diagnostic(Exception):
    """What errors and warnings have in common.

    code: stable name for programs, as "mesh.sheet".
    element, index: what it is about ("triangle", 17), or None.
    place: where that lies, in units of the input, or None.
    """

    _default_code = ""
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
        self.code = code or self._default_code
        self.element = element
        self.index = index
        self.place = place

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.code, self.element, self.index, self.place)


class Error(Diagnostic):
    """Base of all errors of the library; members as those of `Diagnostic`."""


class InvalidOption(Error, ValueError):
    """An option lies outside its documented range, or would have no effect."""

    _default_code = "option"


class FileError(Error, OSError):
    """A file cannot be opened, read or written, or is not what its format demands."""


class UnusableInput(Error, ValueError):
    """The data describe nothing that the method can take (an open mesh, no volume, a ball of radius 0…)."""


class InconsistentResult(Error, RuntimeError):
    """The computation found its own result inconsistent."""


class Cancelled(Error):
    """The function that is told the progress has returned False."""


class ScaleAxisWarning(Diagnostic, UserWarning):
    """What was repaired in an input, or is odd about a result; members as those of `Diagnostic`."""


Warning = ScaleAxisWarning


def warnings_of(diagnostics: str) -> list[Warning]:
    """The warnings in JSON of the library."""
    return [
        Warning(
            with_hints(entry["message"], [(hint["option"], hint["value"]) for hint in entry["hints"]]),
            entry["code"],
            entry["element"],
            entry["index"],
            entry["place"] and tuple(entry["place"]),
        )
        for entry in json.loads(diagnostics)
    ]


def warn(found: list[Warning]) -> None:
    """Python warnings, for the line outside of the package that called it."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_PACKAGE):
        level, frame = level + 1, frame.f_back
    for warning in found:
        warnings.warn(warning, stacklevel=level)
