# SPDX-License-Identifier: Apache-2.0
"""Which models: a file, folder, glob or table, or a list of these; and a share of them."""

from __future__ import annotations

import csv
import glob
import os
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple, TypeAlias

from .. import _core
from ..errors import FileError, InvalidOption
from .options import Options, checked_scales

Path: TypeAlias = "str | os.PathLike[str]"
One: TypeAlias = "Path | tuple[Path, Mapping[str, Any]]"
Models: TypeAlias = "One | Iterable[One]"
"""A file, folder, glob or table; (file, options); or a list of these."""

_TABLES = (".csv", ".parquet")
# What is taken of a folder: neither tables nor axes, and no texts, which may be anything.
EXTENSIONS = tuple(set(_core.input_extensions()) - {*_TABLES, ".ma", ".txt"})


class Model(NamedTuple):
    """A file and the options of one axis, with one scale."""

    path: str
    options: Options


def _rows_of_csv(path: str) -> Iterator[dict[str, Any]]:
    with open(path, encoding="utf-8-sig", newline="") as file:
        for row in csv.DictReader(file):
            if None in row:
                raise FileError(f"{path}: a line has more cells than the head", "file.format")
            yield {name: None if value == "" else value for name, value in row.items()}


def _rows_of_parquet(path: str) -> Iterator[dict[str, Any]]:
    try:
        import pyarrow.parquet
    except ImportError:
        raise InvalidOption(f"{path}: Parquet needs pyarrow: pip install 'scaleaxis[batch]'") from None
    with pyarrow.parquet.ParquetFile(path) as file:
        for batch in file.iter_batches():
            yield from batch.to_pylist()


def _of_table(path: str, shared: Mapping[str, Any]) -> Iterator[Model]:
    rows = _rows_of_csv(path) if path.lower().endswith(".csv") else _rows_of_parquet(path)
    known: dict[str, list[Options]] = {}  # most rows have the options of another
    try:
        for number, row in enumerate(rows, 1):
            place = row.pop("path", None)
            if not place:
                raise InvalidOption(f"{path}: row {number} has no 'path'")
            given = {**shared, **{name: value for name, value in row.items() if value is not None}}
            text = repr(sorted(given.items()))
            if text not in known:
                try:
                    known[text] = checked_scales(given)
                except InvalidOption as error:
                    raise InvalidOption(f"{path}: row {number}: {error}") from None
            for options in known[text]:
                yield Model(_absolute(place, os.path.dirname(path)), options)
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise FileError(f"{path}: cannot be read: {error}", "file.read") from None


def _absolute(path: Any, folder: str = "") -> str:
    text = os.fspath(path)
    return text if "://" in text else os.path.abspath(os.path.join(folder, text))


def _of_one(given: One, shared: Mapping[str, Any], options: list[Options]) -> Iterator[Model]:
    if isinstance(given, tuple):
        if len(given) != 2 or not isinstance(given[1], Mapping):
            raise InvalidOption(f"a model is a path, or (path, options), not {given!r}")
        for own in checked_scales({**shared, **given[1]}):
            yield Model(_absolute(given[0]), own)
        return
    path = os.fspath(given)
    if path.lower().endswith(_TABLES):
        yield from _of_table(path, shared)
        return
    if os.path.isdir(path):
        names = [name for name in os.listdir(path) if name.lower().removesuffix(".gz").endswith(EXTENSIONS)]
        found = sorted(os.path.join(path, name) for name in names)
        if not found:
            raise FileError(f"{path}: there are no models in this folder", "file.open")
    elif glob.has_magic(path) and not os.path.exists(path) and "://" not in path:
        found = sorted(glob.glob(path, recursive=True))
        if not found:
            raise FileError(f"{path}: there are no such files", "file.open")
    else:
        found = [path]  # one that is not there is a model that fails, as others do
    for file in found:
        for one in options:
            yield Model(_absolute(file), one)


def list_models(given: Models, shared: Mapping[str, Any]) -> list[Model]:
    """All models, with their options checked. `shared`: options of those that have none of their own."""
    options = checked_scales(shared)
    is_one = isinstance(given, (str, os.PathLike)) or (
        isinstance(given, tuple) and len(given) == 2 and isinstance(given[1], Mapping)
    )
    listed: Iterable[Any] = [given] if is_one else given  # type: ignore[assignment]
    models = [model for one in listed for model in _of_one(one, shared, options)]
    # The same model twice with the same options is one model.
    distinct = {(model.path, repr(model.options)): model for model in models}
    if not distinct:
        raise InvalidOption("there are no models")
    return list(distinct.values())


def runs_of(models: list[Model]) -> list[list[Model]]:
    """Models that share a sampling: those of a file whose options differ in the scale alone."""
    runs: dict[tuple[str, str], list[Model]] = {}
    for model in models:
        others = {name: value for name, value in model.options.items() if name != "scale"}
        runs.setdefault((model.path, repr(others)), []).append(model)
    return list(runs.values())


def share_of(runs: list[list[Model]], index: int, count: int) -> list[list[Model]]:
    """Every count-th run from the index on: of sorted lists, neighbours, which are often as large, part."""
    return runs[index::count]
