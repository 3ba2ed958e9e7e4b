# SPDX-License-Identifier: Apache-2.0
"""Shapes whose axes are known, and where the repository's program lies."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

# Background shells start their commands with SIGINT ignored, and child processes inherit that.
signal.signal(signal.SIGINT, signal.default_int_handler)

ROOT = Path(__file__).resolve().parents[3]
Mesh = tuple[np.ndarray, np.ndarray]


def grid_mesh(place: Callable[[np.ndarray, np.ndarray], np.ndarray], m: int, n: int) -> Mesh:
    """A surface that closes in both directions, of m × n places."""
    i, j = np.meshgrid(np.arange(m), np.arange(n), indexing="ij")
    vertices = place(2 * np.pi * i.ravel() / m, 2 * np.pi * j.ravel() / n)

    def number(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return ((a % m) * n + b % n).ravel()

    a, b, c, d = number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)
    return vertices, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]).astype(np.int32)


def torus_mesh(large: float = 2.0, small: float = 0.5, m: int = 96, n: int = 48) -> Mesh:
    def place(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        ring = large + small * np.cos(v)
        return np.stack([ring * np.cos(u), ring * np.sin(u), small * np.sin(v)], axis=1)

    return grid_mesh(place, m, n)


def box_mesh(sides: tuple[float, float, float] = (2.0, 3.0, 4.0)) -> Mesh:
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float) * sides
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    faces = [[q[0], q[k], q[k + 1]] for q in quads for k in (1, 2)]
    return corners, np.array(faces, dtype=np.int32)


def ball_mesh(radius: float = 1.0, rounds: int = 4) -> Mesh:
    """An octahedron, refined on the sphere."""
    vertices = [np.array(v, dtype=float) for v in [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]]
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    for _ in range(rounds):
        middles: dict[tuple[int, int], int] = {}

        def middle(a: int, b: int, known: dict[tuple[int, int], int] = middles) -> int:
            key = (min(a, b), max(a, b))
            if key not in known:
                known[key] = len(vertices)
                point = vertices[a] + vertices[b]
                vertices.append(point / np.linalg.norm(point))
            return known[key]

        faces = [
            small
            for a, b, c in faces
            for ab, bc, ca in [(middle(a, b), middle(b, c), middle(c, a))]
            for small in [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        ]
    return radius * np.array(vertices), np.array(faces, dtype=np.int32)


def distance_to_ring(points: np.ndarray, large: float = 2.0) -> np.ndarray:
    """From the circle in the middle of the torus."""
    return np.hypot(np.hypot(points[:, 0], points[:, 1]) - large, points[:, 2])


@pytest.fixture(scope="session")
def torus() -> Mesh:
    return torus_mesh()


@pytest.fixture(scope="session")
def box() -> Mesh:
    return box_mesh()


@pytest.fixture(scope="session")
def ball() -> Mesh:
    return ball_mesh()


@pytest.fixture(scope="session")
def cat() -> Path:
    return ROOT / "data" / "cat.obj"


@pytest.fixture(scope="session")
def program() -> Path:
    """The command line of the same library."""
    path = Path(os.environ.get("SCALEAXIS", ROOT / "build/release/bin/scaleaxis"))
    if not path.exists():
        pytest.fail(f"{path} is not there: build it, name it by SCALEAXIS, or leave these tests out: -m 'not program'")
    return path


def seconds_to_interrupt(code: str, after: float) -> float:
    """How long code goes on that is interrupted so many seconds after it has printed "ready", until it prints "interrupted"
    and the time. It must end well.
    """
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None and process.stdout.readline() == "ready\n"
            time.sleep(after)
            sent = time.time()
            process.send_signal(signal.SIGINT)
            output = process.stdout.readline().split()
            process.wait(10)
        finally:
            process.kill()
    assert output[0] == "interrupted" and process.returncode == 0
    return float(output[1]) - sent
