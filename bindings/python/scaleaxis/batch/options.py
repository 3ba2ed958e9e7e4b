# SPDX-License-Identifier: Apache-2.0
"""The options of `scaleaxis.axis` that files can have: from keywords, tables and the command line."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from .._options import refuse_unknown
from ..errors import Error, InvalidOption
from ..pipeline import axis
from ..solids import Solid, mesh_solid

Options = dict[str, Any]


def _number(value: Any) -> float:
    number = float(value)
    if isinstance(value, bool) or not math.isfinite(number):
        raise ValueError
    return number


def _count(value: Any) -> int:
    if isinstance(value, bool) or int(value) != float(value) or not 0 <= int(value) < 2**63:
        raise ValueError
    return int(value)


def _numbers(value: Any) -> list[float]:
    values = value.split(",") if isinstance(value, str) else list(value) if hasattr(value, "__iter__") else [value]
    if not values:
        raise ValueError
    return [_number(one) for one in values]


def _counts(value: Any) -> list[int]:
    return [_count(one) for one in _numbers(value)]


def _truth(value: Any) -> bool:
    known = {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}
    return known[str(value).strip().lower().removesuffix(".0")]


def _one_of(*names: str) -> Callable[[Any], str]:
    def choice(value: Any) -> str:
        if value not in names:
            raise ValueError
        return str(value)

    return choice


class Option(NamedTuple):
    """How a value is read, whatever it comes from."""

    parse: Callable[[Any], Any]
    expected: str
    help: str
    flag: str = ""  #: of the command line, where it is not the name
    is_of_input: bool = False  #: says what the file means, not what is computed


KNOWN: dict[str, Option] = {
    "delta": Option(_number, "a number", "tolerance of the sampling, relative to the diagonal; default 0.01"),
    "delta_abs": Option(_number, "a number", "the same as a length"),
    "scale": Option(_number, "a number, or several", "factors by which balls are grown; default 1.1"),
    "angle": Option(_number, "a number", "object angle below which sheets are removed, degrees; default 30"),
    "method": Option(_one_of("scale", "angle", "lambda"), "scale, angle or lambda", "what is kept; default scale"),
    "lambda_": Option(_number, "a number", "of the method lambda, relative to the diagonal", "--lambda"),
    "lambda_abs": Option(_number, "a number", "the same as a length"),
    "sharp": Option(_truth, "true or false", "whether sheets end on sharp edges of the solid; default true"),
    "sharp_angle": Option(_number, "a number", "least angle between the normals at a sharp edge"),
    "clean": Option(_number, "a number", "erosion thickness to clean by, relative to the diagonal; 0: none"),
    "clean_abs": Option(_number, "a number", "the same as a length"),
    "union": Option(_one_of("polar", "fitted"), "polar or fitted", "which balls stand for the solid"),
    "dense": Option(_truth, "true or false", "sample the axis until its balls overlap well"),
    "smooth": Option(_count, "a number of rounds", "rounds of smoothing of the sheets' boundaries and of curves"),
    "center": Option(_truth, "true or false", "make the balls of the axis touch the solid; default true"),
    "sampling": Option(
        _one_of("adaptive", "uniform"), "adaptive or uniform", "how far apart samples are; default adaptive"
    ),
    "seed": Option(_count, "a whole number", "of the random choices; default 1"),
    "kind": Option(
        _one_of("mesh", "points", "balls", "image"), "mesh, points, balls or image", "what the files are", "--as", True
    ),
    "triangles": Option(
        _one_of("auto", "winding", "wrap", "thicken"),
        "auto, winding, wrap or thicken",
        "what triangles make solid",
        "--solid",
        True,
    ),
    "opening": Option(_number, "a number", "of wrap: the diameter of the ball", "", True),
    "thickness": Option(_number, "a number", "of thicken: twice the distance from the triangles", "", True),
    "objects": Option(_counts, "numbers from 1 with commas between them", "of a file with several", "--object", True),
    "points": Option(_one_of("mls", "crust"), "mls or crust", "how points become a solid", "", True),
    "kernel": Option(_number, "a number", "radius of moving least squares, in spacings of the points", "", True),
    "iso": Option(_number, "a number", "level of a grey image", "", True),
    "below": Option(_truth, "true or false", "with iso: what is below it", "", True),
    "labels": Option(_numbers, "numbers with commas between them", "of a label image", "--label", True),
    "nonzero": Option(_truth, "true or false", "all voxels that are not 0", "", True),
    "mask_smoothing": Option(_number, "a number", "width of the Gaussian that smooths masks, in voxels", "", True),
    "fill_voids": Option(_truth, "true or false", "fills the voids of masks and labels", "", True),
}


def _parsed(name: str, value: Any) -> Any:
    try:
        refuse_unknown([name], KNOWN, "batch")
    except TypeError as error:  # the name may be that of a column
        raise InvalidOption(str(error)) from None
    option = KNOWN[name]
    try:
        return option.parse(value)
    except (ValueError, TypeError, KeyError, OverflowError):
        raise InvalidOption(f"{name} must be {option.expected}, not {value!r}") from None


@cache
def _smallest_solid() -> Solid:
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    return mesh_solid(np.array(corners, dtype=float), np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]), threads=1)


def _check_ranges(options: Options) -> None:
    # The ranges are known to the library alone, which checks them before it asks whether it is cancelled.
    # Lengths, and a δ that is too fine for a model, depend on the model.
    asked = {name: value for name, value in options.items() if not KNOWN[name].is_of_input}
    for name, length in (("delta_abs", 0.1), ("lambda_abs", 0.1)):
        if name in asked:
            if asked[name] <= 0:
                raise InvalidOption(f"{name} must be positive, not {asked[name]:g}")
            asked[name] = length
    if asked.get("delta", 0.0) >= 1e-5:
        asked["delta"] = max(asked["delta"], 0.01)  # a finer one is slow, or too fine for this solid
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            axis(_smallest_solid(), threads=1, progress=lambda stage, part: False, **asked)
    except InvalidOption:
        raise
    except Error:  # cancelled, or what is wrong with this solid
        pass


def scale_of(options: Options) -> float:
    """The factor, also where it is the one that `axis` takes anyway."""
    scale: float = options.get("scale", 1.1 if options.get("method", "scale") == "scale" else 1.0)
    return scale


def checked_scales(given: Mapping[str, Any]) -> list[Options]:
    """`checked` for each of the scales, which are numbers with commas between them, or a list."""
    if given.get("scale") is None:
        return [checked(given)]
    try:
        scales = _numbers(given["scale"])
    except (ValueError, TypeError, OverflowError):
        raise InvalidOption(f"scale must be {KNOWN['scale'].expected}, not {given['scale']!r}") from None
    return [checked({**given, "scale": scale}) for scale in scales]


def checked(given: Mapping[str, Any]) -> Options:
    """Options by name, as `axis` takes them, with one scale; those that are None or what `axis` takes anyway are left
    out, so that equal runs have equal options. Raises InvalidOption.
    """
    options = {name: _parsed(name, value) for name, value in given.items() if value is not None}
    _check_ranges(options)
    # What `axis` takes without being told.
    usual: Options = {name: False for name, option in KNOWN.items() if option.parse is _truth}
    usual |= {"sharp": True, "center": True, "delta": 0.01, "method": "scale", "sampling": "adaptive", "seed": 1}
    if options.get("method", "scale") == "scale":
        usual |= {"scale": scale_of({})}
    return {name: options[name] for name in sorted(options) if options[name] != usual.get(name)}
