# SPDX-License-Identifier: Apache-2.0
"""The command scaleaxis-batch."""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Sequence

from .. import __version__
from .._options import RETIRED
from ..errors import InvalidOption
from .call import FORMATS, batch
from .exits import CANCELLED, DONE, FAILED, USAGE, Parser, bytes_of, status_of
from .options import KNOWN
from .progress import clock

_EXIT = f"""exit status:
  {DONE}  every model has a result
  {FAILED}  some have none, or something else went wrong
  {USAGE}  an option is wrong
  {CANCELLED}  stopped by Ctrl-C or SIGTERM
What is done stays: the same command computes the rest."""


def _bytes(text: str) -> int:
    size = bytes_of(text)
    if size is None:
        raise argparse.ArgumentTypeError(f"'{text}' is no size as 500M or 4G")
    return size


def _share(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d+)/(\d+)", text)
    if not found:
        raise argparse.ArgumentTypeError(f"'{text}' is not I/N")
    return int(found[1]), int(found[2])


def _share_of_slurm() -> tuple[int, int]:
    """The place of this task in a Slurm array, whatever its numbers begin with and step by."""
    try:
        index, count = (int(os.environ[f"SLURM_ARRAY_TASK_{name}"]) for name in ("ID", "COUNT"))
        first = int(os.environ.get("SLURM_ARRAY_TASK_MIN", "1"))
        step = int(os.environ.get("SLURM_ARRAY_TASK_STEP", "1"))
    except (KeyError, ValueError):
        raise InvalidOption(
            "--shard without I/N takes them from SLURM_ARRAY_TASK_ID and SLURM_ARRAY_TASK_COUNT, which are not set",
        ) from None
    return (index - first) // (step or 1) + 1, count


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="scaleaxis-batch",
        usage="scaleaxis-batch MODEL... -o OUT [OPTION...]\n       scaleaxis-batch volume VOLUME -o OUT [OPTION...]",
        description="Axes of many models, on this machine, on Dask, or in shards.",
        epilog=_EXIT,
    )
    add = parser.add_argument
    add("models", nargs="+", metavar="MODEL", help="file, folder, glob, or table (.csv, .parquet) with a column 'path'")
    add("-o", "--output", required=True, metavar="OUT", help="folder or location of fsspec for axes and rows")
    add("--format", choices=FORMATS, default="ply", help="of the axes; default ply")
    add("--workers", type=int, metavar="N", help="models at a time; default: all processors, with --shard 1")
    add("--threads", type=int, metavar="N", help="for each model; default: the processors shared among the workers")
    add("--scheduler", metavar="ADDRESS", help="of a Dask cluster, as tcp://host:8786; default: this machine")
    add("--shard", nargs="?", type=_share, const=(), metavar="I/N", help="the I-th of N shares, without Dask")
    add("--time-limit", type=float, metavar="SECONDS", help="for each model")
    add("--memory-limit", type=_bytes, metavar="BYTES", help="for each model, as 500M or 4G")
    add("--retry", choices=["failed"], help="try again what has failed")
    add("-q", "--quiet", action="store_true", help="no progress, no summary")
    add("--version", action="version", version=__version__)
    group = parser.add_argument_group("options of the axis", "as of `scaleaxis axis`; a table may have them as columns")
    for name, option in KNOWN.items():
        flag = option.flag or "--" + name.replace("_", "-")
        if option.expected == "true or false":
            group.add_argument(flag, dest=f"axis:{name}", action=argparse.BooleanOptionalAction, help=option.help)
        else:
            group.add_argument(flag, dest=f"axis:{name}", metavar="VALUE", help=option.help)
    for name in RETIRED:  # the error says what takes their place
        group.add_argument(f"--{name}", dest=f"axis:{name}", action="store_const", const=True, help=argparse.SUPPRESS)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command; returns its exit status."""
    words = sys.argv[1:] if arguments is None else list(arguments)
    if words[:1] == ["volume"]:
        from ..volumes.command import main as volume_main

        return volume_main(words[1:])
    given = vars(_parser().parse_args(words))
    options = {name.removeprefix("axis:"): value for name, value in given.items() if name.startswith("axis:")}

    def work() -> int:
        shard = given["shard"]
        if shard == ():
            shard = _share_of_slurm()
        counts = batch(
            given["models"],
            given["output"],
            format=given["format"],
            scheduler=given["scheduler"],
            workers=given["workers"],
            threads=given["threads"],
            shard=shard,
            time_limit=given["time_limit"],
            memory_limit=given["memory_limit"],
            retry=given["retry"],
            progress=False if given["quiet"] else None,
            **options,
        )
        if not given["quiet"]:
            print(f"{counts.total} models: {counts}, {clock(counts.seconds)}")
        return FAILED if counts.failed or counts.lost else DONE

    return status_of("scaleaxis-batch", work)
