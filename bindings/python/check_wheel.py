#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fails if a wheel is large, or needs libraries that are neither in it nor in SYSTEM: check_wheel.py WHEEL..."""

import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

MOST_BYTES = 6_000_000
# The last ones are linked as the system has them; wheels for others get them by auditwheel.
SYSTEM = ("libc.so", "libm.so", "libstdc++.so", "libgcc_s.so", "ld-linux", "libpthread.so", "libdl.so", "librt.so",
          "libbz2.so", "libtiff.so", "libz.so")


def needed(library: Path) -> list[str]:
    """The shared libraries that a shared library names."""
    text = subprocess.run(["readelf", "--dynamic", library], capture_output=True, text=True, check=True).stdout
    return [line.split("[")[1].rstrip("]") for line in text.splitlines() if "(NEEDED)" in line]


def faults(wheel: Path) -> list[str]:
    found = []
    if wheel.stat().st_size > MOST_BYTES:
        found.append(f"{wheel.stat().st_size} bytes, at most {MOST_BYTES} are wanted")
    with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
        names = {Path(name).name for name in archive.namelist()}
        found += [f"{name} is missing" for name in ("py.typed", "_core.pyi", "LICENSE", "NOTICE") if name not in names]
        for library in Path(folder).rglob("*.so*"):
            for name in needed(library):
                if name not in names and not name.startswith(SYSTEM):
                    found.append(f"{library.name} needs {name}, which is not in the wheel")
    return found


all_faults = [f"{wheel}: {fault}" for wheel in sys.argv[1:] for fault in faults(Path(wheel))]
print(*all_faults, sep="\n", end="")
sys.exit(1 if all_faults else 0)
