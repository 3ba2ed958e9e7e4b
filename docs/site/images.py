#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the pictures of docs/images: docs/site/images.py [NAME...], by default all of PICTURES below.

Needs the program (BUILD, default build/release), PyVista (docs/site/requirements.txt), and for most pictures public models
in the folder SCALEAXIS_DATA (docs/dev/data.md); a picture whose model is not there is skipped, with the place it is from.
Screenshots are not drawn here: pages in a browser (viewer-*.png, jupyter.png) and Blender (blender.png).
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import matplotlib
import numpy as np
import pyvista

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAM = ROOT / os.environ.get("BUILD", "build/release") / "bin/scaleaxis"
DATA = Path(os.environ.get("SCALEAXIS_DATA", "SCALEAXIS_DATA"))  # where unset, a folder that is not there
CAT = ROOT / "data/cat.obj"
os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkOSOpenGLRenderWindow")  # without a screen
FONT = Path(matplotlib.get_data_path(), "fonts/ttf/DejaVuSans.ttf")  # that of VTK has no δ

# Where the models below DATA are from.
SOURCES = {
    "psb/": "the Princeton segmentation benchmark (https://segeval.cs.princeton.edu)",
    "mesh/v-hacd/": "V-HACD (https://github.com/kmammou/v-hacd)",
    "medial/vmtk/": "VMTK's tests (https://github.com/vmtk/vmtk-test-data)",
    "image/vmtk/": "VMTK's tests (https://github.com/vmtk/vmtk-test-data)",
    "image/niivue/": "NiiVue (https://github.com/niivue/niivue)",
    "point/": "https://github.com/alecjacobson/geometry-processing-mesh-reconstruction",
}

INK = (0.13, 0.13, 0.16)
GLASS = (0.46, 0.55, 0.68)
BALLS = (0.93, 0.66, 0.42)
MESH = (0.80, 0.80, 0.83)


class Tile(NamedTuple):
    """One of the pictures side by side: an axis, a mesh or balls, perhaps in a shape of glass."""

    thing: pyvista.PolyData | np.ndarray
    """Points with "radius" are those of an axis, others those of a mesh; an array holds balls: x, y, z, radius."""
    label: str = ""
    shape: pyvista.PolyData | None = None


def sheet_colors(sheets: np.ndarray) -> np.ndarray:
    """RGB of sheets as in the program's files: multiples of the golden ratio on a circle of OKLab (Ottosson 2020)."""
    turns = 2 * np.pi * (0.72 + sheets / ((1 + 5**0.5) / 2))
    a, b = 0.115 * np.cos(turns), 0.115 * np.sin(turns)
    lms = 0.77 + np.outer(a, (0.39634, -0.10556, -0.08948)) + np.outer(b, (0.21580, -0.06385, -1.29149))
    to_rgb = np.array([[4.07674, -3.30771, 0.23097], [-1.26844, 2.60976, -0.34132], [-0.00420, -0.70342, 1.70761]])
    linear = np.clip(lms**3 @ to_rgb.T, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def smooth(mesh: pyvista.PolyData) -> pyvista.PolyData:
    """With normals at the points, which jump at edges of 40° and more."""
    return mesh.triangulate().clean().compute_normals(
        cell_normals=False, split_vertices=True, feature_angle=40, consistent_normals=False
    )


def spheres(balls: np.ndarray) -> pyvista.PolyData:
    centers = pyvista.PolyData(balls[:, :3])
    centers["radius"] = balls[:, 3]
    ball = pyvista.Sphere(radius=1.0, theta_resolution=48, phi_resolution=32)
    return centers.glyph(scale="radius", geom=ball, orient=False)


def add_axis(plotter: pyvista.Plotter, axis: pyvista.PolyData, pixels: float) -> None:
    """Faces with a colour for each sheet, or for each label if there are any; borders, seams and curves as lines."""
    if axis.faces.size:
        faces = pyvista.PolyData(axis.points, faces=axis.faces)
        kind = axis.cell_data.get("label", axis.cell_data.get("sheet"))[-faces.n_cells :]
        if "label" in axis.cell_data:
            kind = np.unique(kind, return_inverse=True)[1]
        faces.cell_data["rgb"] = sheet_colors(kind)
        plotter.add_mesh(faces, scalars="rgb", rgb=True, ambient=0.25, diffuse=0.85)
        lines = faces.extract_feature_edges(feature_edges=False, manifold_edges=False)
        if lines.n_cells:
            plotter.add_mesh(lines, color=INK, opacity=0.7, line_width=max(2 * pixels, 1.5))
    if axis.lines.size:
        curves = pyvista.PolyData(axis.points, lines=axis.lines)
        plotter.add_mesh(curves, color=INK, line_width=9 * pixels, render_lines_as_tubes=True, lighting=False)
    if axis.n_verts:
        plotter.add_points(axis.points[axis.verts[1::2]], color=INK, point_size=18 * pixels, lighting=False)


def add_glass(plotter: pyvista.Plotter, shape: pyvista.PolyData, to_viewer: np.ndarray) -> None:
    """Clear where it faces the viewer, tinted at its outline."""
    shape = smooth(shape)
    slope = 1 - np.abs(shape.point_data["Normals"] @ to_viewer)
    opacity = 0.06 + 0.5 * slope**2
    shape.point_data["rgba"] = np.column_stack([np.tile(GLASS, (len(opacity), 1)), opacity])
    plotter.add_mesh(shape, scalars="rgba", rgba=True, lighting=False, culling="back")


def draw(
    file: Path,
    tiles: list[Tile],
    size: tuple[int, int] = (480, 480),
    columns: int | None = None,
    view: tuple[float, float] = (30, 20),
    up: str = "y",
    is_same_scale: bool = False,
) -> None:
    """Draws tiles of a size in rows.

    view: azimuth and elevation of the viewer in degrees; with y upwards, azimuth 0 looks from +z, 90 from +x.
    is_same_scale: all tiles of a row show the same part of space.
    """
    columns = columns or len(tiles)
    rows = -(-len(tiles) // columns)
    azimuth, elevation = np.radians(view)
    to_viewer = np.array(
        [np.sin(azimuth) * np.cos(elevation), np.sin(elevation), np.cos(azimuth) * np.cos(elevation)]
    )
    upwards = np.array([0.0, 1.0, 0.0])
    turn = "yzx".index(up)  # the names of the coordinates rotate
    to_viewer, upwards = np.roll(to_viewer, turn), np.roll(upwards, turn)
    right = np.cross(upwards, to_viewer)
    right /= np.linalg.norm(right)
    screen = np.column_stack([right, np.cross(to_viewer, right)])

    def extent(tile: Tile) -> np.ndarray:
        """Least and largest coordinates on the screen."""
        things = [spheres(tile.thing) if isinstance(tile.thing, np.ndarray) else tile.thing, tile.shape]
        flat = np.concatenate([thing.points @ screen for thing in things if thing is not None])
        return np.array([flat.min(axis=0), flat.max(axis=0)])

    extents = [extent(tile) for tile in tiles]
    pixels = min(size) / 800  # of lines before they are averaged
    text = 24 if any(tile.label for tile in tiles) else 0  # pixels below the scene
    plotter = pyvista.Plotter(
        shape=(rows, columns), window_size=(columns * size[0], rows * size[1]), border=False, off_screen=True
    )
    plotter.set_background("white")
    for i, tile in enumerate(tiles):
        plotter.subplot(i // columns, i % columns)
        if isinstance(tile.thing, np.ndarray):
            plotter.add_mesh(spheres(tile.thing), color=BALLS, smooth_shading=True, ambient=0.2)
        elif "radius" in tile.thing.point_data:
            add_axis(plotter, tile.thing, pixels)
        elif "sheet" in tile.thing.cell_data or "rgb" in tile.thing.cell_data:
            if "sheet" in tile.thing.cell_data:
                tile.thing.cell_data["rgb"] = sheet_colors(tile.thing.cell_data["sheet"])
            plotter.add_mesh(
                tile.thing,
                scalars="rgb",
                rgb=True,
                ambient=0.3,
                diffuse=0.8,
                show_edges=True,
                edge_color=INK,
                line_width=1.5,
            )
        elif "RGB" in tile.thing.point_data:
            plotter.add_mesh(smooth(tile.thing), scalars="RGB", rgb=True, smooth_shading=True, ambient=0.35)
        else:
            plotter.add_mesh(smooth(tile.thing), color=MESH, smooth_shading=True, ambient=0.2)
        if tile.shape is not None:
            add_glass(plotter, tile.shape, to_viewer)
        plotter.enable_depth_peeling(16)
        if tile.label:
            caption = pyvista.Text(tile.label, position=(size[0] // 2, 8))
            caption.prop.set_font_file(str(FONT))
            caption.prop.font_size = 14
            caption.prop.color = INK
            caption.prop.justification_horizontal = "center"
            plotter.add_actor(caption)

        row = extents[i // columns * columns : (i // columns + 1) * columns] if is_same_scale else [extents[i]]
        low, high = np.min([e[0] for e in row], axis=0), np.max([e[1] for e in row], axis=0)
        free = np.array([size[0], size[1] - text]) - 0.06 * min(size)
        per_pixel = max((high - low) / free)
        middle = (low + high) / 2 - (0, text * per_pixel / 2)
        place = tile.thing[0, :3] if isinstance(tile.thing, np.ndarray) else tile.thing.points[0]
        center = screen @ middle + (place @ to_viewer) * to_viewer
        camera = plotter.camera
        camera.parallel_projection = True
        camera.focal_point = center
        camera.position = center + to_viewer * 10 * np.linalg.norm(high - low)
        camera.up = upwards
        camera.parallel_scale = per_pixel * size[1] / 2
        plotter.renderer.ResetCameraClippingRange()
    plotter.enable_anti_aliasing("ssaa", all_renderers=True)
    plotter.screenshot(file)
    plotter.close()


# What is drawn. Files go to a folder of their own, and each has a name of its own.
FILES = tempfile.TemporaryDirectory()


class Missing(Exception):
    """A model that is not here."""


def new_file(ending: str) -> Path:
    return Path(tempfile.mkstemp(ending, dir=FILES.name)[1])


def program(*arguments: object) -> None:
    subprocess.run([PROGRAM, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)


def model(name: str) -> Path:
    """A file below DATA."""
    if not (DATA / name).exists():
        folder = next(folder for folder in SOURCES if name.startswith(folder))
        raise Missing(f"{DATA / name} is not here, a model of {SOURCES[folder]}")
    return DATA / name


def stl(mesh: pyvista.PolyData) -> Path:
    """A mesh that PyVista has made, as a file."""
    file = new_file(".stl")
    mesh.triangulate().save(file)
    return file


def result(*arguments: object, ending: str = ".vtp") -> pyvista.PolyData:
    """What a command of the program writes."""
    file = new_file(ending)
    program(*arguments, "-q", "-o", file)
    return pyvista.read(file)


def axis(*arguments: object) -> pyvista.PolyData:
    return result("axis", *arguments)


def axis_in_surface(*arguments: object, label: str = "") -> Tile:
    """An axis in the boundary of its own balls, for what is no mesh."""
    surface = new_file(".ply")
    return Tile(axis(*arguments, "--mesh", surface), label, pyvista.read(surface))


def mesh(file: Path) -> pyvista.PolyData:
    surface = new_file(".ply")
    program("info", file, "--repaired", surface)
    return pyvista.read(surface)


def sheet_count(axis: pyvista.PolyData) -> int:
    return int(axis.cell_data["sheet"].max()) + 1


def box() -> Path:
    return stl(pyvista.Box((0, 3, 0, 2, 0, 1)))


def teaser(file: Path) -> None:
    cat = mesh(CAT)
    draw(file, [Tile(axis(CAT, "--scale", s), f"s = {s}", cat) for s in (1, 1.1, 1.5)], (560, 560), view=(10, 10))


def cleaning(file: Path) -> None:
    models = [model(f"psb/{name}.off") for name in (123, 87, 102)]
    shapes = [mesh(name) for name in models]
    kinds = [("--clean", 0), ()]
    tiles = [Tile(axis(name, *kind), "", shape) for kind in kinds for name, shape in zip(models, shapes)]
    draw(file, tiles, (500, 440), columns=3)


def fit(file: Path) -> None:
    tube = pyvista.Disc(inner=9, outer=10, r_res=1, c_res=64).extrude((0, 0, -60), capping=True)
    tiles = []
    for name, solid in (("cat", CAT), ("box", box()), ("tube", stl(tube))):
        for label, options in ((f"{name}, polar: ", ("--union", "polar")), ("fitted: ", ())):
            found = axis(solid, "--clean", 0, "--no-sharp", *options)
            tiles.append(Tile(found, f"{label}{sheet_count(found):,} sheets", mesh(solid)))
    draw(file, tiles, (500, 380), columns=2)


def filtration(file: Path) -> None:
    nested = new_file(".ply")
    program("filtration", CAT, "-q", "-o", nested)
    scales = (1.05, 1.1, 1.2, 1.5)
    levels = [Tile(result("filter", nested, "--scale", s), f"filtration, s = {s}") for s in scales]
    grown = [Tile(axis(CAT, "--scale", s), f"grown balls, s = {s}") for s in scales]
    draw(file, levels + grown, (400, 400), columns=4, view=(10, 10), is_same_scale=True)


def image(file: Path) -> None:
    level_set = model("image/vmtk/aorta-final-levelset.mha")
    draw(file, [axis_in_surface(level_set, "--iso", 0, "--below")], (700, 500), view=(0, 0))


def labels(file: Path) -> None:
    combined = new_file(".vtp")
    torso = model("image/niivue/torsoLabel.nii.gz")
    program("axis", torso, "--each-label", "--delta", 0.02, "--combined", combined, "-q")
    draw(file, [Tile(pyvista.read(combined))], (480, 620), view=(90, 10), up="z")


def midsurface(file: Path) -> None:
    outline = [(0, 0), (8, 0), (8, 3), (7.6, 3), (7.6, 0.4), (4.2, 0.4), (4.2, 2), (3.8, 2), (3.8, 0.4), (0, 0.4)]
    face = pyvista.PolyData([(x, y, 0) for x, y in outline], faces=[len(outline), *range(len(outline))])
    bracket = stl(face.triangulate().extrude((0, 0, -6), capping=True))
    middle = result("midsurface", bracket)
    draw(file, [Tile(axis(bracket), "axis"), Tile(middle, "midsurface", mesh(bracket))], (640, 480))


def implicit(file: Path) -> None:
    gyroid = "max(sin(4*x)*cos(4*y)+sin(4*y)*cos(4*z)+sin(4*z)*cos(4*x), 3*(sqrt(x^2+y^2+z^2)-1.5))"
    bounds = "-1.7,-1.7,-1.7,1.7,1.7,1.7"
    draw(file, [axis_in_surface("--implicit", gyroid, "--bounds", bounds)], (600, 600))


def points(file: Path) -> None:
    elephant = axis_in_surface(model("point/gpmr_elephant.pwn"), "--delta", 0.008, "--scale", 1.1)
    draw(file, [elephant], (800, 800))


def psb(file: Path) -> None:
    model("psb/1.off")
    names = sorted((DATA / "psb").glob("*.off"), key=lambda name: int(name.stem))
    draw(file, [Tile(axis(name), name.stem) for name in names], (160, 160), columns=12)


def sharp_edges(file: Path) -> None:
    cylinder = stl(pyvista.Cylinder(direction=(0, 1, 0), radius=1, height=1.4, resolution=96))
    solids = [box(), cylinder, model("psb/331.off")]
    kinds = [("--no-sharp", ("--no-sharp",)), ("by default", ())]
    tiles = [Tile(axis(solid, *kind), label, mesh(solid)) for label, kind in kinds for solid in solids]
    draw(file, tiles, (420, 340), columns=3)


def sharp_edges_casting(file: Path) -> None:
    casting = model("mesh/v-hacd/casting.off")
    draw(file, [Tile(axis(casting, "--no-sharp"), "--no-sharp"), Tile(axis(casting), "by default")], (640, 460))


def simplification(file: Path) -> None:
    solids = [model("psb/123.off"), model("psb/102.off"), CAT]
    axes = [axis(solid, *kind) for kind in ((), ("--compact",)) for solid in solids]
    draw(file, [Tile(axis, f"{axis.n_points:,} vertices") for axis in axes], (420, 420), columns=3)


def skeleton(file: Path) -> None:
    solids = [model(f"psb/{name}.off") for name in (123, 1, 181, 102, 361, 21)]
    draw(file, [Tile(result("skeleton", solid), "", mesh(solid)) for solid in solids], (420, 420), columns=3)


def vessels(file: Path) -> None:
    """VMTK's aorta: centerlines, sections as discs of their area, the path between two ends, cylinders."""
    solid = model("medial/vmtk/aorta-surface.stl")
    shape = mesh(solid)
    curves, path, table = new_file(".vtp"), new_file(".vtp"), new_file(".csv")
    program("skeleton", solid, "--sections", "-q", "-o", curves)
    program("skeleton", solid, "--path", "223,170,24", "215,101,28", "-q", "-o", path)
    program("skeleton", solid, "--step", 0.05, "-q", "-o", table)
    lines = pyvista.read(curves)
    discs = pyvista.PolyData()
    for k in np.flatnonzero(lines["CenterlineSectionClosed"])[::12]:
        radius = np.sqrt(lines["CenterlineSectionArea"][k] / np.pi)
        disc = pyvista.Disc(center=lines.points[k], inner=0, outer=radius, normal=lines["FrenetTangent"][k], c_res=48)
        discs = discs.append_polydata(disc.triangulate())
    cylinders = pyvista.PolyData()
    for row in np.genfromtxt(table, delimiter=",", names=True):
        start, along = (np.array([row[f"{name}_{c}"] for c in "xyz"]) for name in ("start", "axis"))
        middle = start + 0.5 * row["length"] * along
        cylinder = pyvista.Cylinder(center=middle, direction=along, radius=row["radius"], height=row["length"])
        cylinders = cylinders.append_polydata(cylinder.triangulate())
    tiles = [
        Tile(lines, "centerlines", shape),
        Tile(discs, "sections", shape),
        Tile(pyvista.read(path), "a path", shape),
        Tile(cylinders, "cylinders"),
    ]
    draw(file, tiles, (300, 560), view=(0, 10))


def spheres_of_cat(file: Path) -> None:
    tiles = [Tile(mesh(CAT), "a cat")]
    for kind, label in (("--cover", "32 balls that cover it"), ("--inside", "32 balls inside")):
        balls = new_file(".xyzr")
        program("spheres", CAT, "--count", 32, kind, "-q", "-o", balls)
        tiles.append(Tile(np.loadtxt(balls), label))
    draw(file, tiles, (480, 640))


def robots(file: Path) -> None:
    """A gripper at rest: its shapes, 24 spheres of all links, and the large sphere of each."""
    robot = ROOT / "examples/robot/gripper.urdf"
    places = {"arm": (0, 0, 0), "palm": (0, 0, 0.35), "finger": (0.05, 0, 0.39)}
    finger = mesh(robot.parent / "meshes/finger.obj").scale(0.001).rotate_y(np.degrees(0.2)).translate((0, 0, 0.01))
    shapes = [
        pyvista.Cylinder((0, 0, 0.15), (0, 0, 1), 0.04, 0.3).triangulate(),
        pyvista.Sphere(0.05, (0, 0, 0.3)),
        pyvista.Cube((0, 0, 0.02), 0.16, 0.06, 0.04).triangulate().rotate_z(np.degrees(0.3)).translate(places["palm"]),
        finger.translate(places["finger"]),
    ]
    whole = shapes[0].extract_surface()
    for shape in shapes[1:]:
        whole = whole.append_polydata(shape.extract_surface())
    whole.clear_data()
    folder = Path(tempfile.mkdtemp(dir=FILES.name))
    program("spheres", robot, "--total", 24, "-q", "-o", folder / "few.urdf")
    program("spheres", folder / "few.urdf", "--count", 1, "--output-format", "vamp", "-q", "-o", folder / "few.json")
    tiles = [Tile(whole, "a gripper")]
    for name, label in (("few", "24 spheres"), ("few_spherized_1", "one large sphere a link")):
        program("spheres", folder / f"{name}.urdf", "--count", 1, "-q", "-o", folder / "few.csv")
        rows = [line.split(",") for line in (folder / "few.csv").read_text().splitlines()[1:]]
        balls = np.array([[*map(float, row[1:])] for row in rows])
        balls[:, :3] += [places[row[0]] for row in rows]
        tiles.append(Tile(balls, label))
    draw(file, tiles, (360, 640), up="z", is_same_scale=True)


def thickness(file: Path) -> None:
    solids = [CAT, model("psb/102.off")]
    draw(file, [Tile(result("thickness", solid, ending=".ply")) for solid in solids], (520, 520))


def walls(file: Path) -> None:
    """A profile with ribs, a slot and a snap hook: thin walls in red, narrow gaps in orange."""
    outline = [
        (0, 0), (30, 0), (30, 2), (25.6, 2), (25.6, 6), (27, 6), (27, 7), (25, 7), (25, 2), (20, 2), (20, 0.5),
        (18.5, 0.5), (18.5, 2), (12, 2), (12, 7), (11.4, 7), (11.4, 2), (11, 2), (11, 7), (9.5, 7), (9.5, 2), (0, 2),
    ]  # fmt: skip
    points = np.array([(x, y, 0.0) for x, y in outline[::-1]])
    profile = pyvista.PolyData(points, [len(points), *range(len(points))]).triangulate()
    part, colored = new_file(".stl"), new_file(".vtp")
    profile.extrude((0, 0, 8), capping=True).triangulate().save(part)
    program("walls", part, "--min-wall", 0.8, "--min-gap", 0.6, "--mesh", colored, "--exit-zero", "-q")
    found = pyvista.read(colored)
    colors = np.where((found["gap"] < 0.6)[:, None], (240, 160, 60), (170, 178, 190))
    found["RGB"] = np.where((found["wall"] < 0.79)[:, None], (215, 60, 50), colors).astype(np.uint8)
    draw(file, [Tile(found)], (960, 420), view=(-25, 25))


def sizes(file: Path) -> None:
    """A profile with a thin rib and a block, as mmg (`mmgpy`) meshes it: red where elements are small."""
    import meshio
    import mmgpy

    outline = [(0, 0), (40, 0), (40, 2), (29, 2), (29, 8), (25, 8), (25, 2), (11, 2), (11, 12), (10, 12), (10, 2), (0, 2)]
    points = np.array([(x, y, 0.0) for x, y in outline[::-1]])
    profile = pyvista.PolyData(points, [len(points), *range(len(points))]).triangulate()
    part = new_file(".stl")
    profile.extrude((0, 0, 16), capping=True).triangulate().save(part)
    tiles = []
    for across in (2, 4):
        sol = new_file(".sol")
        program("sizes", part, "--elements-across", across, "-q", "-o", sol)
        tool = Path(mmgpy.__file__).parent / "bin" / "mmgs_O3"
        subprocess.run([tool, sol.with_suffix(".mesh"), sol.with_name("fine.mesh")], check=True, capture_output=True)
        fine = meshio.read(sol.with_name("fine.mesh"))
        mesh = pyvista.PolyData.from_regular_faces(fine.points, fine.get_cells_type("triangle"))
        logarithm = np.log(mesh.compute_cell_sizes()["Area"])
        low, high = np.percentile(logarithm, [2, 98])
        colors = matplotlib.colormaps["Spectral"](np.clip((logarithm - low) / (high - low), 0, 1))
        mesh.cell_data["rgb"] = (255 * colors[:, :3]).astype(np.uint8)
        tiles.append(Tile(mesh, f"{across} elements across"))
    draw(file, tiles, (620, 420), view=(-25, 25))


def volumes(file: Path) -> None:
    """The sheets of a gyroid in a ball: faces of the axis by their block, and without those of small angles."""
    from scaleaxis import read_axis
    from scaleaxis.volumes import volume

    z, y, x = np.indices((96, 96, 96)) - 47.5
    u, v, w = (2 * np.pi * c / 48 for c in (x, y, z))
    gyroid = np.sin(u) * np.cos(v) + np.sin(v) * np.cos(w) + np.sin(w) * np.cos(u)
    source, output = new_file(".npy"), Path(FILES.name, "volume")
    np.save(source, ((np.abs(gyroid) < 0.45) & (x * x + y * y + z * z < 44**2)).astype(np.uint8))
    volume(source, output, block=64, memory="8GB", angle=45, progress=False)
    tiles = []
    for name, label in (("axis", "owned by eight blocks"), ("filtered", "stitched, from 45°")):
        complex = read_axis(output / f"{name}.ply")
        data = complex.to_pyvista()
        if name == "axis":
            firsts = complex.vertices[np.minimum.reduceat(complex.faces.indices, complex.faces.offsets[:-1])] >= 64
            data["sheet"] = np.concatenate([np.zeros(data.n_cells - len(firsts), int), firsts @ [1, 2, 4]])
        tiles.append(Tile(data, label))
    draw(file, tiles, (560, 560), view=(30, 25))


def sampling(file: Path) -> None:
    surface = mesh(CAT)
    surface["RGB"] = np.tile(MESH, (surface.n_points, 1))
    tiles = []
    for kind in ("uniform", "adaptive"):
        balls = result("balls", CAT, "--sampling", kind, ending=".ply")
        _, places = surface.find_closest_cell(balls.points, return_closest_point=True)
        dots = spheres(np.column_stack([places, np.full(len(places), 0.002 * surface.length)]))
        dots["RGB"] = np.tile(INK, (dots.n_points, 1))
        tiles.append(Tile(surface.append_polydata(dots), f"{kind}: {balls.n_points:,} balls"))
    draw(file, tiles, (600, 600))


def creases(file: Path) -> None:
    tiles = []
    for solid in (box(), model("psb/331.off")):
        for label, options in (("--no-sharp", ("--no-sharp",)), ("by default", ())):
            stored = new_file(".ply")
            program("axis", solid, "--delta", 0.02, "--scale", 1, *options, "-q", "-o", stored)
            tiles.append(Tile(result("mesh", stored, ending=".ply"), label))
    draw(file, tiles, (420, 420))


def shells(file: Path) -> None:
    boxes = [((0, 0, 0), (40, 2, 30)), ((0, 0, 0), (40, 30, 2)), ((5, 0, 0), (7, 20, 20)), ((33, 0, 0), (35, 20, 20))]
    tiles = [pyvista.Box(bounds=[x for pair in zip(low, high) for x in pair]).triangulate() for low, high in boxes]
    bracket = new_file(".stl")
    pyvista.merge(tiles).save(bracket)
    mesh_file = new_file(".vtu")
    program("midsurface", bracket, "--shells", mesh_file, "--size", 2, "--delta", 0.01, "-q")
    sheets = pyvista.read(mesh_file).extract_surface(algorithm="dataset_surface")
    draw(file, [Tile(mesh(bracket), "bracket"), Tile(sheets, "shells")], (560, 480), view=(35, 25), up="z")


def holes(file: Path) -> None:
    cat = mesh(CAT)
    numbers = np.random.default_rng(1)
    centers = cat.cell_centers().points
    discs = centers[numbers.choice(cat.n_cells, 5, replace=False)]
    is_gone = numbers.random(cat.n_cells) < 0.02
    is_gone |= np.linalg.norm(centers[:, None] - discs, axis=2).min(axis=1) < 0.03 * cat.length
    open_cat = stl(pyvista.PolyData.from_regular_faces(cat.points, cat.regular_faces[~is_gone]))
    with_holes = Tile(pyvista.read(open_cat), "2 % of the triangles removed, and five discs")
    draw(file, [with_holes, Tile(mesh(open_cat), "closed"), Tile(axis(open_cat), "axis")], (480, 480), view=(10, 10))


PICTURES: dict[str, Callable[[Path], None]] = {
    "teaser": teaser,
    "cleaning": cleaning,
    "fit": fit,
    "filtration": filtration,
    "image": image,
    "labels": labels,
    "midsurface": midsurface,
    "shells": shells,
    "implicit": implicit,
    "points": points,
    "psb": psb,
    "sampling": sampling,
    "sharp-edges": sharp_edges,
    "sharp-edges-casting": sharp_edges_casting,
    "simplification": simplification,
    "skeleton": skeleton,
    "vessels": vessels,
    "robots": robots,
    "spheres": spheres_of_cat,
    "thickness": thickness,
    "walls": walls,
    "sizes": sizes,
    "volumes": volumes,
    "creases": creases,
    "holes": holes,
}


def main(names: list[str]) -> None:
    unknown = [name for name in names if name not in PICTURES]
    if unknown:
        sys.exit(f"images.py: no picture {', '.join(unknown)}; there are {', '.join(PICTURES)}")
    if not PROGRAM.exists():
        sys.exit(f"images.py: {PROGRAM} is not there: tools/build run scaleaxis_cli")
    for name in names or PICTURES:
        try:
            PICTURES[name](ROOT / f"docs/images/{name}.png")
            print(f"{name}: drawn")
        except Missing as missing:
            print(f"{name}: skipped, for {missing}")


if __name__ == "__main__":
    main(sys.argv[1:])
