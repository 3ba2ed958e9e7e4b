# SPDX-License-Identifier: Apache-2.0
"""What the library throws and warns of. docs/diagnostics.md lists the codes."""

from __future__ import annotations

import json
import os
import re
import sys
import warnings
from typing import Any

_PACKAGE = os.path.dirname(__file__) + os.sep

Place = tuple[float, float, float]


# What the program calls by another name than Python. Flags that are not here have the same name in both.
_NAMES = {"solid": "triangles", "label": "labels", "each-label": "label_axes"}
_SWITCHES = ("nonzero", "clip")
_COMMANDS = {
    "scaleaxis info lists those that there are": 'those that there are: load(…, nonzero=True).report["labels"]',
    "scaleaxis filtration": "scaleaxis.filtration",
}
_VALUE = r"-?\d[\d.e+-]*\b|T\b|thicken\b|wrap\b"
_FLAG = re.compile(rf"(?<![\w-])--(?P<name>[a-z][a-z-]*)( (?P<value>{_VALUE}))?(?P<more> (?=--))?")


def _option_of(flag: re.Match[str]) -> str:
    name = _NAMES.get(flag["name"], flag["name"].replace("-", "_"))
    if flag["name"] in _SWITCHES:
        return f"{name}=True"
    if flag["value"] is None:
        return name
    value = f'"{flag["value"]}"' if flag["value"].islower() and flag["value"].isalpha() else flag["value"]
    return f"{name}={value}" + (", " if flag["more"] else "")


def in_words_of_python(message: str) -> str:
    """A message of the library, which names options as the program does, with the names that they have here."""
    for command, words in _COMMANDS.items():
        message = message.replace(command, words)
    return _FLAG.sub(_option_of, message)


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
            in_words_of_python(entry["message"]),
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
