# SPDX-License-Identifier: Apache-2.0
"""The table of results: JSON Lines as they come, Parquet at the end."""

from __future__ import annotations

import hashlib
import io
import json
import os
import time
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from typing import IO, Any, NamedTuple

from .storage import Storage
from .worker import Row

PARQUET = "rows.parquet"

_TEXTS = ("path", "status", "reason", "error", "code", "key", "result", "options", "host", "version", "ended")
_COUNTS = ("vertices", "edges", "polygons", "sheets", "balls", "samples", "peak_memory")
_TOPOLOGY = ("components", "euler", "tunnels", "voids")
_NUMBERS = ("scale", "diagonal", "tolerance", "seconds")

Identity = bytes


class Known(NamedTuple):
    """What earlier calls have found of a model."""

    key: bytes
    status: str
    ended: str


def identity_of(path: str, options: str) -> Identity:
    """Of a model with options, whatever the file held."""
    return hashlib.blake2b(f"{path}\n{options}".encode(errors="surrogatepass"), digest_size=16).digest()


def identity_of_row(row: Row) -> Identity:
    return identity_of(row["path"], row["options"])


def short(key: str | None) -> bytes:
    return bytes.fromhex(key) if key else b""


def read_rows(storage: Storage) -> Iterator[Row]:
    """All rows of all calls. Lines that a killed process, or a full disk, has torn are passed over."""
    for name in sorted(storage.names()):
        if not (name.startswith("rows") and name.endswith(".jsonl")):
            continue
        with storage.open(name) as file:
            for line in file:
                try:
                    row = json.loads(line)
                except ValueError:
                    continue
                if isinstance(row, dict) and {"path", "status", "options", "ended"} <= row.keys():
                    yield row


def known_rows(storage: Storage) -> dict[Identity, Known]:
    """The last row of each model."""
    known: dict[Identity, Known] = {}
    for row in read_rows(storage):
        identity = identity_of_row(row)
        if identity not in known or known[identity].ended <= row["ended"]:
            known[identity] = Known(short(row.get("key")), row["status"], row["ended"])
    return known


class Journal:
    """Appends rows. Where files cannot be appended to, as in object stores, each few seconds make a file."""

    SECONDS = 10.0

    def __init__(self, storage: Storage, name: str) -> None:
        self._storage = storage
        self._name = name
        self._file: IO[bytes] | None = None
        self._lines: list[str] = []
        self._run = f"{time.strftime('%Y%m%dT%H%M%S', time.gmtime())}-{uuid.uuid4().hex[:6]}"
        self._parts = 0
        self._flushed = time.monotonic()
        if storage.is_local:
            os.makedirs(storage.root, exist_ok=True)
            self._file = open(storage.path(f"{name}.jsonl"), "ab+", buffering=0)
            end = self._file.seek(0, os.SEEK_END)
            if end > 0:
                self._file.seek(end - 1)
                if self._file.read(1) != b"\n":
                    self._file.write(b"\n")  # ends a torn line

    def add(self, row: Row) -> None:
        self._lines.append(json.dumps(row) + "\n")
        if self._file is not None or time.monotonic() - self._flushed > self.SECONDS:
            self.flush()

    def flush(self) -> None:
        """Raises OSError."""
        text = "".join(self._lines).encode()
        if text and self._file is not None:
            if self._file.write(text) != len(text):  # the disk is full in the middle of the line
                os.fsync(self._file.fileno())
                raise OSError("a row was written in part")
        elif text:
            self._storage.write(f"{self._name}-{self._run}-{self._parts:05}.jsonl", text)
            self._parts += 1
        self._lines = []
        self._flushed = time.monotonic()

    def close(self) -> None:
        if self._file is not None:
            self._file.close()


@contextmanager
def journal(storage: Storage, name: str) -> Iterator[Journal]:
    opened = Journal(storage, name)
    try:
        yield opened
        opened.flush()
    except BaseException:
        try:
            opened.flush()  # rows that are known must not be lost with what went wrong
        except OSError:
            pass
        raise
    finally:
        opened.close()


def _schema() -> Any:
    import pyarrow

    fields = [(name, pyarrow.string()) for name in _TEXTS]
    fields += [(name, pyarrow.int64()) for name in _COUNTS + _TOPOLOGY]
    fields += [(f"solid_{name}", pyarrow.int64()) for name in _TOPOLOGY]
    fields += [(name, pyarrow.float64()) for name in _NUMBERS]
    return pyarrow.schema([*fields, ("warnings", pyarrow.list_(pyarrow.string()))])


def write_parquet(storage: Storage, batch_rows: int = 10_000) -> bool:
    """Writes the last row of each model as a table; nothing where pyarrow is not installed."""
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        return False
    known = known_rows(storage)
    schema = _schema()
    written = io.BytesIO()
    with pyarrow.parquet.ParquetWriter(written, schema) as writer:
        rows: list[Row] = []
        for row in read_rows(storage):
            identity = identity_of_row(row)
            if identity in known and known[identity].ended == row["ended"]:
                del known[identity]
                rows.append(row)
            if len(rows) == batch_rows:
                writer.write_table(pyarrow.Table.from_pylist(rows, schema))
                rows = []
        writer.write_table(pyarrow.Table.from_pylist(rows, schema))
    storage.write(PARQUET, written.getvalue())
    return True
