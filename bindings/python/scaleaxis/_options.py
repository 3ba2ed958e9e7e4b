# SPDX-License-Identifier: Apache-2.0
"""One check of the options of every public function: their names and types are those of its signature."""

from __future__ import annotations

import collections.abc
import difflib
import inspect
import math
import operator
import os
import re
import reprlib
import sys
import types
from collections.abc import Callable, Iterable, Mapping
from functools import cache, wraps
from typing import Annotated, Any, Literal, NamedTuple, TypeVar, Union, cast, get_args, get_origin, get_type_hints, overload

import numpy as np

from .errors import InvalidOption

Seed = Annotated[int, range(2**64)]
"""Of the random choices."""


class Interval(NamedTuple):
    """What a number has to lie in."""

    least: float
    most: float
    words: str


Length = Annotated[float, Interval(sys.float_info.min, sys.float_info.max, "a positive length")]
Share = Annotated[float, Interval(0.0, 1.0, "a number between 0 and 1")]
Number = Annotated[float, Interval(-math.inf, math.inf, "a number")]

_COUNTS = range(-(2**31), 2**31)  # the library's counts and indices have 32 bits
_CHECKED = (bool, str, bytes, os.PathLike, types.NoneType, collections.abc.Callable, np.ndarray)
_LISTS = (collections.abc.Sequence, collections.abc.Iterable)
RETIRED = ("features", "tight")

_Function = TypeVar("_Function", bound=Callable[..., Any])


def length_of(relative: float | None, absolute: float | None, name: str) -> tuple[float, bool] | None:
    """A length of two options, `name` and `name_abs`, and whether it is absolute; None if neither is given. Raises
    InvalidOption for both.
    """
    if relative is not None and absolute is not None:
        raise InvalidOption(f"{name} and {name.removesuffix('_')}_abs are the same option: leave one of them out")
    if absolute is not None:
        return absolute, True
    return None if relative is None else (relative, False)


def stood_for(given: Any) -> Any:
    """What a result of this package stands for as an input: its complex, mesh, balls or solid. Others: themselves."""
    while hasattr(type(given), "_stands_for"):
        given = given._stands_for
    return given


class _Unpack:
    """`Unpack` of typing_extensions, which only type checkers import: stands for what it unpacks."""

    def __class_getitem__(cls, item: Any) -> Any:
        return item


class _Unfit(Exception):
    """The value is of another type."""


class _OutOfRange(_Unfit):
    """A number beyond what the option takes."""


def _number(value: Any) -> float:
    array = np.asarray(value) if isinstance(value, (int, float, np.generic, np.ndarray)) else None
    if array is None or array.ndim > 0 or array.dtype.kind not in "iuf":
        raise _Unfit
    return float(value)


def _number_in(value: Any, allowed: Interval) -> float:
    number = _number(value)
    if not allowed.least <= number <= allowed.most:
        raise _OutOfRange
    return number


def _whole_number(value: Any, allowed: range) -> int:
    if isinstance(value, (bool, np.bool_)):
        raise _Unfit
    try:
        number = operator.index(value)
    except TypeError:
        raise _Unfit from None
    if number not in allowed:
        raise _OutOfRange
    return number


def _items(value: Any, kind: Any) -> list[Any]:
    if isinstance(value, (str, bytes, Mapping)) or not isinstance(value, Iterable) or getattr(value, "ndim", 1) == 0:
        raise _Unfit
    return [_fitted(one, kind) for one in value]


def _fitted(value: Any, kind: Any) -> Any:
    """The value as its annotation has it; numbers of NumPy become those of Python."""
    origin, arguments = get_origin(kind), get_args(kind)
    if origin in (Union, types.UnionType):
        return _fitted_to_any(value, arguments)
    if origin is Annotated:
        return _whole_number(value, arguments[1]) if arguments[0] is int else _number_in(value, arguments[1])
    if origin is Literal:
        if isinstance(value, str) and value in arguments:
            return value
        raise _Unfit
    if origin is tuple:
        items = _items(value, arguments[0])
        if len(items) != len(arguments):
            raise _Unfit
        return tuple(items)
    if origin in _LISTS:
        return _items(value, arguments[0])
    if kind is int:
        return _whole_number(value, _COUNTS)
    if kind is float:
        return _number(value)
    if kind is bool and isinstance(value, np.bool_):
        return bool(value)
    known = origin or kind
    is_own = inspect.isclass(kind) and kind.__module__.startswith("scaleaxis.")
    if is_own and not isinstance(value, kind):
        value = stood_for(value)
    if known in _CHECKED or is_own:
        if isinstance(value, known):
            return value
        raise _Unfit
    return value  # arrays, files and solids are checked by those who know them


def _fitted_to_any(value: Any, kinds: tuple[Any, ...]) -> Any:
    is_out_of_range = False
    for kind in kinds:
        try:
            return _fitted(value, kind)
        except _OutOfRange:
            is_out_of_range = True
        except _Unfit:
            pass
    raise _OutOfRange if is_out_of_range else _Unfit


def _alternatives(kind: Any) -> list[str]:
    """What a kind takes, in words."""
    origin, arguments = get_origin(kind), get_args(kind)
    if origin in (Union, types.UnionType):
        return list(dict.fromkeys(words for one in arguments for words in _alternatives(one)))
    if origin is Literal:
        return [("one of " if len(arguments) > 1 else "") + ", ".join(map(repr, arguments))]
    if origin is Annotated:
        if isinstance(arguments[1], Interval):
            return [arguments[1].words]
        least = arguments[1].start
        return ["a whole number" + (f" of at least {least}" if least >= 0 else "")]
    if origin is tuple:
        return [f"{len(arguments)} numbers"]
    if origin in _LISTS:
        return ["a list of such"]
    if origin is collections.abc.Callable:
        return ["a function"]
    names = {int: "a whole number", float: "a number", bool: "True or False", str: "text", types.NoneType: "None"}
    names |= {bytes: "bytes", os.PathLike: "a path", np.ndarray: "an array"}
    return [names.get(origin or kind, getattr(kind, "__name__", "an array"))]


def _one_of(words: list[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} or {words[-1]}"


def _suggestion(given: str, known: Iterable[str]) -> str:
    by_lower = {name.lower(): name for name in known}
    close = difflib.get_close_matches(given.lower(), by_lower, n=1)
    return f": did you mean {by_lower[close[0]]}?" if close else ""


def _checked_value(name: str, value: Any, kind: Any) -> Any:
    try:
        return _fitted(value, kind)
    except _Unfit as unfit:
        expected = _one_of(_alternatives(kind))
        names = re.findall("'[^']+'", expected) if isinstance(value, str) else []
        message = f"{name} must be {expected}, not {reprlib.repr(value)}{_suggestion(repr(value), names)}"
        if isinstance(unfit, _OutOfRange) or names:
            raise InvalidOption(message) from None
        raise TypeError(message) from None


def refuse_unknown(given: Iterable[str], known: Iterable[str], owner: str) -> None:
    """Raises TypeError for an option that there is not, with the one that may be meant; InvalidOption for one that is
    gone.
    """
    names = list(known)
    for name in given:
        if name in RETIRED:
            raise InvalidOption(
                f"{name} is gone: samples are as dense as the solid needs by default "
                '(sampling="adaptive"); leave it out'
            )
        if name not in names:
            raise TypeError(
                f"{owner} has no option {name}{_suggestion(name, names) or '.'} Its options are {', '.join(names)}"
            )


def _expanded(signature: inspect.Signature, options: Any, defaults: Mapping[str, Any]) -> inspect.Signature:
    """With each of the options that are passed on under its own name, as `help` shows it."""
    several = [p for p in signature.parameters.values() if p.kind is not inspect.Parameter.VAR_KEYWORD]
    for name, kind in options.__annotations__.items():
        text = getattr(kind, "__forward_arg__", kind)
        default = defaults.get(name)
        several.append(inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=text))
    return signature.replace(parameters=several)


@overload
def checked(function: _Function) -> _Function: ...
@overload
def checked(*, defaults: Mapping[str, Any]) -> Callable[[_Function], _Function]: ...
def checked(function: Any = None, *, defaults: Mapping[str, Any] | None = None) -> Any:
    """A public function that takes arguments of the names and types in its signature alone.

    defaults: of what it passes on as `**options: Unpack[…]`, where these are not None.
    """
    if function is None:
        return lambda decorated: _checking(decorated, defaults or {})
    return _checking(function, {})


def _checking(function: _Function, defaults: Mapping[str, Any]) -> _Function:
    def evaluated(annotation: str) -> Any:
        return eval(annotation, function.__globals__, {"Unpack": _Unpack})

    owner = function.__qualname__.removesuffix(".__init__") + "()"
    signature = inspect.signature(function)
    positional = [name for name, p in signature.parameters.items() if p.kind is p.POSITIONAL_OR_KEYWORD]
    rest = next((p for p in signature.parameters.values() if p.kind is p.VAR_KEYWORD), None)
    passed_on = rest and evaluated(rest.annotation)

    @cache
    def kinds() -> dict[str, Any]:
        own = {
            name: Any if p.annotation is p.empty else evaluated(p.annotation)
            for name, p in signature.parameters.items()
            if p is not rest
        }
        return own | (get_type_hints(passed_on, include_extras=True) if passed_on else {})

    @wraps(function)
    def call(*arguments: Any, **options: Any) -> Any:
        known = kinds()
        refuse_unknown(options, [name for name in known if name != "self"], owner)
        places = [_checked_value(name, value, known[name]) for name, value in zip(positional, arguments)]
        named = {name: _checked_value(name, value, known[name]) for name, value in options.items()}
        return function(*places, *arguments[len(places) :], **named)

    call.__signature__ = _expanded(signature, passed_on, defaults) if passed_on else signature  # type: ignore[attr-defined]
    return cast(_Function, call)
