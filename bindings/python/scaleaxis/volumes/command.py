# SPDX-License-Identifier: Apache-2.0
"""The command scaleaxis-batch volume."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from ..batch.exits import CANCELLED, DONE, FAILED, USAGE, Parser, status_of
from .call import CAUSES, PARTS_FORMATS, volume

_EXIT = f"""exit status:
  {DONE}  the results are there
  {FAILED}  a block has none, or the volume cannot be read
  {USAGE}  an option is wrong, or the memory is not enough
  {CANCELLED}  stopped by Ctrl-C or SIGTERM
What is done stays: the same command computes the rest."""


def _labels(text: str) -> list[int]:
    try:
        return [int(label) for label in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is no label as 3, and no list as 2,3") from None


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="scaleaxis-batch volume",
        usage="scaleaxis-batch volume VOLUME -o OUT [OPTION...]",
        description="Axis and thickness of a volume larger than memory, block by block.",
        epilog=_EXIT,
    )
    add = parser.add_argument
    add("source", metavar="VOLUME", help=".npy, Zarr, OME-Zarr, N5, NRRD, NIfTI, or Neuroglancer precomputed")
    add("-o", "--output", required=True, metavar="OUT", help="folder or location of fsspec for the results")
    add("--memory", default="4GB", metavar="BYTES", help="of all workers together, as 4GB; default 4GB")
    add("--workers", type=int, metavar="N", help="blocks at a time; default: all processors")
    add("--scheduler", metavar="ADDRESS", help="of a Dask cluster, as tcp://host:8786; default: this machine")
    add("--block", type=int, metavar="N", help="voxels along an axis, a multiple of 32; default: as the memory allows")
    add("--label", type=_labels, metavar="L[,L...]", help="labels that are one solid; default: all but 0")
    add("--level", type=float, metavar="V", help="the solid is above this value")
    add("--below", action="store_true", help="the solid is below the level")
    add("--dataset", metavar="NAME", help="array in a Zarr, or level of a multiscale or precomputed volume")
    add("--spacing", type=float, metavar="LENGTH", help="of voxels; default: that of the file")
    add("--smoothing", type=int, default=1, metavar="N", help="how often a mask is smoothed, 0 to 4; default 1")
    add("--scale", type=float, default=1.1, metavar="S", help="by which balls are grown; default 1.1")
    add("--seed", type=int, default=1, metavar="N", help="of what is moved to be in general position; default 1")
    add("--no-axis", dest="axis", action="store_false", help="no axis")
    add("--no-stitch", dest="stitch", action="store_false", help="leave the axis in parts, as many as there are blocks")
    add("--parts-format", choices=PARTS_FORMATS, default="ply", help="of the parts; default ply")
    add("--thickness", action="store_true", help="local thickness, thickness.zarr")
    add("--angle", type=float, metavar="DEGREES", help="remove sheets of a smaller object angle from the stitched axis")
    add("--clean", type=float, metavar="LENGTH", help="remove what has less erosion thickness from it")
    add("--skeleton", action="store_true", help="curve skeleton: skeleton.swc, skeletons")
    add("-q", "--quiet", action="store_true", help="no progress, no summary")
    return parser


def main(arguments: Sequence[str]) -> int:
    """Runs the command; returns its exit status."""
    given = vars(_parser().parse_args(arguments))
    is_quiet = given.pop("quiet")

    def work() -> int:
        report = volume(**given, progress=False if is_quiet else None)
        if not is_quiet:
            print(f"{report.blocks} blocks of {report.block} voxels, {report.computed} parts computed")
            if report.euler is not None:
                print(f"{report.faces} faces; Euler characteristic {report.euler}, of the solid {report.solid_euler}")
                for low, much in report.mismatches.items():
                    cause, place = report.causes.get(low, ("", low))
                    why = f": {CAUSES[cause]}, at voxel {', '.join(map(str, place))}" if cause else ""
                    print(f"the block at voxel {', '.join(map(str, low))} differs by {much:+}{why}")
                if report.agrees is False and not report.mismatches:
                    print("no block differs by itself: the difference is where blocks meet")
        return DONE

    return status_of("scaleaxis-batch volume", work)
