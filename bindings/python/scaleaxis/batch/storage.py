# SPDX-License-Identifier: Apache-2.0
"""Where results are: a folder, or any location of fsspec. Files appear there whole or not at all."""

from __future__ import annotations

import os
import shutil
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

from ..errors import InvalidOption


def is_url(path: str) -> bool:
    return "://" in path


def _fsspec() -> Any:
    try:
        import fsspec
    except ImportError:
        raise InvalidOption("locations with :// need fsspec: pip install 'scaleaxis[batch]'") from None
    return fsspec


@contextmanager
def opened(path: str) -> Iterator[IO[bytes]]:
    """A file to be read."""
    with _fsspec().open(path, "rb") if is_url(path) else open(path, "rb") as file:
        yield file


@dataclass(frozen=True)
class Storage:
    """Plain data, which goes to the workers with each model."""

    root: str
    options: dict[str, Any] = field(default_factory=dict)  #: of fsspec

    @property
    def is_local(self) -> bool:
        return not is_url(self.root)

    def _remote(self, name: str) -> tuple[Any, str]:
        # fsspec keeps the file systems that it has made.
        system, path = _fsspec().core.url_to_fs(self.root, **self.options)
        return system, f"{path.rstrip('/')}/{name}"

    def path(self, name: str) -> str:
        return os.path.join(self.root, name) if self.is_local else f"{self.root.rstrip('/')}/{name}"

    def write(self, name: str, data: bytes) -> None:
        """Under a temporary name, then renamed. Raises OSError."""
        temporary = f"{name}.{uuid.uuid4().hex}.part"
        if self.is_local:
            target, part = Path(self.path(name)), Path(self.path(temporary))
            target.parent.mkdir(parents=True, exist_ok=True)
            try:
                part.write_bytes(data)
                os.replace(part, target)
            finally:
                part.unlink(missing_ok=True)
            return
        system, target_path = self._remote(name)
        part_path = self._remote(temporary)[1]
        system.makedirs(target_path.rpartition("/")[0], exist_ok=True)
        try:
            system.pipe_file(part_path, data)
            system.mv(part_path, target_path)
        except Exception:
            if system.exists(part_path):
                system.rm_file(part_path)
            raise

    def read(self, name: str) -> bytes | None:
        """The content of a file, or None where there is none."""
        try:
            if self.is_local:
                return Path(self.path(name)).read_bytes()
            system, path = self._remote(name)
            content: bytes = system.cat_file(path)
            return content
        except FileNotFoundError:
            return None

    def exists(self, name: str) -> bool:
        if self.is_local:
            return os.path.exists(self.path(name))
        system, path = self._remote(name)
        return bool(system.exists(path))

    def open(self, name: str) -> IO[bytes]:
        if self.is_local:
            return open(self.path(name), "rb")
        system, path = self._remote(name)
        file: IO[bytes] = system.open(path, "rb")
        return file

    def remove(self, name: str) -> None:
        """A file, or a folder with all that is in it, if it is there."""
        if not self.is_local:
            system, path = self._remote(name)
            if system.exists(path):
                system.rm(path, recursive=True)
        elif os.path.isdir(self.path(name)):
            shutil.rmtree(self.path(name))
        else:
            Path(self.path(name)).unlink(missing_ok=True)

    def names(self, folder: str = "") -> Iterator[str]:
        """The files in a folder, without what is below it."""
        if self.is_local:
            try:
                with os.scandir(self.path(folder)) as entries:
                    yield from (entry.name for entry in entries if entry.is_file())
            except FileNotFoundError:
                pass
            return
        system, path = self._remote(folder)
        try:
            found = system.ls(path.rstrip("/"), detail=False, refresh=True)
        except FileNotFoundError:
            return
        yield from (name.rstrip("/").rpartition("/")[2] for name in found)
