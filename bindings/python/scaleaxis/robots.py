# SPDX-License-Identifier: Apache-2.0
"""Robots in spheres, and the files in which planners read those."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from . import _core
from ._arrays import Floats
from ._options import Seed, checked, length_of
from ._progress import Progress, telling
from .adapt import as_balls
from .covering import Clip, planes_of
from .errors import FileError, InvalidOption, warn, warnings_of
from .stages import Sizing

RobotFormat = Literal["curobo", "vamp", "ballpark", "srdf", "urdf"]

_DEFAULT_DELTA = 0.01
_DEFAULT_EFFORT = 1.0
_DEFAULT_LARGE = 1
_BY_EXTENSION: dict[str, RobotFormat] = {".urdf": "urdf", ".srdf": "srdf", ".yml": "curobo", ".json": "ballpark"}


@dataclass(frozen=True)
class RobotSpheres:
    """Spheres of a robot.

    balls: by link, N × 4, centres and radii in its frame. Change them, or add some, before they are written.
    statistics, scores: by link, as of `FewBalls`; empty for links of spheres alone.
    """

    balls: dict[str, Floats]
    statistics: dict[str, dict[str, Any]]
    scores: dict[str, dict[str, Any]]
    _core: Any = field(repr=False)

    @property
    def ignored(self) -> list[tuple[str, str, str]]:
        """Pairs of links whose collisions are not to be looked for, and why: "adjacent" or "touches at rest"."""
        pairs = self._core.ignored_pairs(self._rows())
        return [(first, second, "adjacent" if adjacent else "touches at rest") for first, second, adjacent in pairs]

    def write(
        self, file: str | os.PathLike[str], format: RobotFormat | None = None, *, large: int | None = None
    ) -> list[Path]:
        """Writes the complete files of a planner beside each other, and returns their names.

        format: by the extension if it is not given: .urdf, .srdf (MoveIt), .yml (cuRobo), .json (ballpark, pyroki).
            "vamp" writes NAME_spherized.urdf and .srdf, NAME_spherized_1.urdf and NAME.json.
        large: for VAMP, so many spheres of each link around the others (default 1).
        """
        path = Path(file)
        chosen = format or _BY_EXTENSION.get(path.suffix.lower())
        if chosen is None:
            raise InvalidOption(f"{path}: no format of a robot has this extension; choose one by format")
        if large is not None and chosen != "vamp":
            raise InvalidOption(f'large has no effect on the format "{chosen}": leave it out, or choose "vamp"')
        written = []
        for name, text in self._core.files(self._rows(), chosen, path.stem, _DEFAULT_LARGE if large is None else large):
            target = path.with_name(name) if chosen == "vamp" else path
            unfinished = target.with_name(target.name + ".part")
            try:
                unfinished.write_text(text, encoding="utf-8")
                unfinished.replace(target)
            except OSError as error:
                raise FileError(f"{target}: cannot be written: {error.strerror}") from None
            written.append(target)
        return written

    def _rows(self) -> dict[str, Floats]:
        return {link: as_balls(balls) for link, balls in self.balls.items()}


def _expanded(file: Path, arguments: Mapping[str, str]) -> str:
    if not file.is_file():
        raise FileError(f"{file}: cannot be opened")
    command = ["xacro", str(file.absolute()), *(f"{name}:={value}" for name, value in arguments.items())]
    try:
        made = subprocess.run(command, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        raise FileError(f"{file}: the program xacro expands it, and is not installed: pip install xacro") from None
    if made.returncode != 0:
        why = made.stderr.strip().splitlines()
        raise FileError(f"{file}: xacro does not expand it" + (f": {why[-1]}" if why else ""))
    return made.stdout


@checked
def robot_spheres(
    robot: str | os.PathLike[str],
    count: int | None = None,
    *,
    total: int | None = None,
    error: float | None = None,
    error_abs: float | None = None,
    inside: bool = False,
    clip_planes: Mapping[str, Sequence[Clip]] | None = None,
    packages: Sequence[Any] = (),
    rest: Mapping[str, float] | None = None,
    xacro: Mapping[str, str] | None = None,
    effort: float = _DEFAULT_EFFORT,
    delta: float = _DEFAULT_DELTA,
    sampling: Sizing = "adaptive",
    seed: Seed = 1,
    threads: int = 0,
    progress: Progress = None,
) -> RobotSpheres:
    """Spheres for the links of a robot, as `scaleaxis spheres robot.urdf`. Those that a link has already stay, and count.

    robot: a description, .urdf, or .xacro, which the program xacro expands.
    count: number of spheres of each link. total: of all links: each next one goes to the link that sticks out most.
    error, error_abs, inside, delta, sampling: as of `spheres`, for each link.
    clip_planes: by link, planes in its frame that no sphere reaches through: `{"base": [("z", 0.0)]}`.
    packages: folders of packages that `package://NAME/PATH` names, or that they are in.
    rest: positions of joints at rest; others are at 0, or in the middle of their limits where 0 lies outside.
    xacro: arguments for xacro.
    effort: how long the search goes on, relative to the default.

    Raises InvalidOption, UnusableInput, FileError, Cancelled.
    """
    length, is_length = length_of(error, error_abs, "error") or (None, True)
    if count is None and total is None and length is None:
        raise InvalidOption("count, total, error or error_abs is needed")
    if total is not None and (count is not None or length is not None):
        raise InvalidOption("total shares all spheres out: it goes with neither count nor an error")
    file = Path(robot)
    text = _expanded(file, xacro or {}) if file.suffix.lower() == ".xacro" else None
    core = _core.Robot(text, file, [Path(package) for package in packages], dict(rest or {}))
    planes = {link: planes_of(some) for link, some in (clip_planes or {}).items()}
    with telling(progress) as tell:
        links = _core.robot_spheres(
            core, inside, count, total, length, is_length, planes, effort, delta, sampling, seed, threads, tell
        )
    warn(warnings_of(core.warnings()))
    return RobotSpheres(
        {name: balls for name, balls, _, _ in links},
        {name: json.loads(statistics) for name, _, statistics, _ in links},
        {name: json.loads(scores) for name, _, _, scores in links},
        core,
    )


__all__ = ["RobotSpheres", "robot_spheres"]
