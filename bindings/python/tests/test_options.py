# SPDX-License-Identifier: Apache-2.0
"""Names, types and defaults of options, and what messages call them, for all public functions alike."""

from __future__ import annotations

import ast
import builtins
import inspect
import re
import types
import warnings
from functools import partial

import numpy as np
import pytest
import scaleaxis
from conftest import ROOT, box_mesh

PACKAGE = ROOT / "bindings/python/scaleaxis"
FUNCTIONS = {name: getattr(scaleaxis, name) for name in [*scaleaxis.__all__, "filter"]}
FUNCTIONS = {name: value for name, value in FUNCTIONS.items() if inspect.isfunction(value)}
del FUNCTIONS["each_label"]  # its options are those of the function that it calls
# Methods with options, as of `Axis.mesh`.
METHODS = {
    f"{owner.__name__}.{name}": method
    for owner in (getattr(scaleaxis, name) for name in scaleaxis.__all__)
    if inspect.isclass(owner)
    for name, method in inspect.getmembers(owner, inspect.isfunction)
    if not name.startswith("_") and {"threads", "path", "scale"} & inspect.signature(method).parameters.keys()
}
EVERY = FUNCTIONS | METHODS
WRONG = {
    "threads": 1.5,
    "seed": -1,
    "progress": "yes",
    "delta": "fine",
    "scale": "large",
    "sampling": "dense",
    "union": "Fitted",
    "smooth": True,
    "sharp": "no",
    "angle": "30",
    "iso": "0.5",
    "labels": "liver",
    "nonzero": 1,
    "objects": [1.5],
    "delta_range": (0.1,),
    "vertices": 2.5,
    "count": 2**40,
    "file": 3,
}


def owner_of(method):
    return (None,) if "self" in inspect.signature(method).parameters else ()


def test_there_are_functions_and_methods():
    assert len(FUNCTIONS) > 70 and len(METHODS) > 15


@pytest.mark.parametrize("name", EVERY)
def test_unknown_options_are_refused(name):
    with pytest.raises(TypeError, match=r"has no option thraeds(: did you mean threads\?)?.* Its options are"):
        EVERY[name](*owner_of(EVERY[name]), thraeds=1)


@pytest.mark.parametrize("name", EVERY)
def test_options_of_other_types_are_refused_by_name(name):
    parameters = inspect.signature(EVERY[name]).parameters
    for option, value in WRONG.items():
        is_text = option in parameters and "ArrayLike" not in str(parameters[option].annotation)
        if is_text and str(parameters[option].annotation) != "Any":
            with pytest.raises((TypeError, scaleaxis.InvalidOption), match=f"^{option} must be "):
                EVERY[name](*owner_of(EVERY[name]), **{option: value})


@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.filterwarnings("ignore")
def test_whatever_is_given_is_refused_in_words_of_the_package(name, tmp_path, monkeypatch):
    """Not by what happens to fail within it, or by the list of C++ types of the compiled module."""
    monkeypatch.chdir(tmp_path)
    given = [object(), None, "no such", "no.obj", b"x", 3, 2.5, True, [], [1, 2], {}, (np.zeros((3, 3)),), ("a", "b")]
    given += [np.zeros((2, 2)), np.zeros((3, 4)), np.zeros(3, dtype=object), lambda points: points]
    parameters = inspect.signature(FUNCTIONS[name]).parameters.values()
    first, *others = [one.name for one in parameters if one.default is one.empty] or [None]
    for value in given if first else []:
        for other in given[::3] if others else [None]:
            try:
                FUNCTIONS[name](**{first: value, **dict.fromkeys(others, other)})
            except (TypeError, ValueError, OSError) as error:
                assert not re.search("incompatible function|bad_cast|subscriptable|unpack|NoneType", str(error))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"delta": "0.01"}, "delta must be a number, 'auto' or None, not '0.01'"),
        ({"delta": [0.01, 0.02]}, "delta must be a number"),
        ({"seed": None}, "seed must be a whole number of at least 0, not None"),
        ({"seed": 2**64}, "seed must be a whole number"),
        ({"smooth": 1.5}, "smooth must be a whole number or None, not 1.5"),
        ({"sharp": 1}, "sharp must be True or False, not 1"),
        ({"union": "Fitted"}, "union must be one of 'polar', 'fitted' or None, not 'Fitted': did you mean 'fitted'?"),
        ({"detla": 0.1}, "axis() has no option detla: did you mean delta?"),
        ({"voxel_size": 2}, "axis() has no option voxel_size. Its options are solid, delta, scale, "),
        ({"tight": True}, "tight is gone: "),
    ],
)
def test_messages(box, options, message):
    with pytest.raises((TypeError, scaleaxis.InvalidOption)) as caught:
        scaleaxis.axis(box, **options)
    assert str(caught.value).startswith(message)


def test_numbers_of_numpy_are_numbers(box):
    known = scaleaxis.axis(box, 0.05, 1.1, smooth=3, sharp=False, seed=7)
    same = scaleaxis.axis(
        box, np.float64(0.05), np.array(1.1), smooth=np.int8(3), sharp=np.bool_(False), seed=np.uint64(7)
    )
    np.testing.assert_array_equal(known.vertices, same.vertices)
    assert [axis.scale for axis in scaleaxis.axis(box, 0.05, np.array([1.0, 1.5]))] == [1.0, 1.5]
    assert scaleaxis.axis(box, 0.05, angle=None).scale == 1.1


def test_help_names_all_options():
    for function in (scaleaxis.axis, scaleaxis.label_axes):
        parameters = inspect.signature(function).parameters
        assert {"delta", "sharp", "mask_smoothing", "threads"} <= parameters.keys()
        assert (parameters["sharp"].default, parameters["angle"].default) == (True, None)
    for option in inspect.signature(scaleaxis.axis).parameters:
        assert re.search(rf"\b{option}\b", scaleaxis.axis.__doc__), option


def test_options_beside_an_axis_are_refused(box):
    axis = scaleaxis.axis(box, delta=0.05)
    for call in (scaleaxis.skeleton, scaleaxis.midsurface):
        for given, options in (
            (axis, {"delta": 0.1}),
            (axis, {"scale": 3.0}),
            (axis, {"seed": 2}),
            (axis.complex, {"delta_abs": 0.1}),
            (axis.complex, {"iso": 0.5}),
        ):
            with pytest.raises(scaleaxis.InvalidOption, match=f"{next(iter(options))} has no effect on an axis"):
                call(given, **options)
    with pytest.raises(scaleaxis.InvalidOption, match="the distance of nodes is node_spacing"):
        scaleaxis.skeleton(axis, spacing=0.1)


def test_numbers_that_no_length_or_share_can_be(box):
    axis = scaleaxis.axis(box, delta=0.05)
    for edge in (-1.0, 1.5, np.nan):
        with pytest.raises(scaleaxis.InvalidOption, match="edge must be a number between 0 and 1, not"):
            scaleaxis.thickness(axis, edge=edge)
    for spacing in (0.0, -1.0, np.nan, np.inf):
        for skeleton in (scaleaxis.skeleton, scaleaxis.Axis.skeleton):
            with pytest.raises(scaleaxis.InvalidOption, match="node_spacing must be a positive length or None"):
                skeleton(axis, node_spacing=spacing)
    values = np.arange(len(box[0]), dtype=float)
    assert len(scaleaxis.thin_regions(*box, values, -1).areas) == 0  # values need not be lengths
    with pytest.raises(scaleaxis.InvalidOption, match="limit must be a number, not nan"):
        scaleaxis.thin_regions(*box, values, np.nan)
    with pytest.raises(TypeError, match="edge must be a number between 0 and 1, not '0.1'"):
        scaleaxis.thickness(axis, edge="0.1")


def test_two_lengths_for_one_option_are_refused(box):
    balls = np.array([[0.0, 0.0, 0.0, 1.0]])
    for function, given, name in (
        (scaleaxis.axis, box, "delta"),
        (scaleaxis.mesh, balls, "delta"),
        (partial(scaleaxis.compare, box), balls, "spacing"),
        (scaleaxis.spheres, box, "error"),
        (scaleaxis.robot_spheres, "robot.urdf", "error"),
    ):
        with pytest.raises(scaleaxis.InvalidOption, match=f"{name} and {name}_abs are the same option"):
            function(given, **{name: 0.1, f"{name}_abs": 0.1})


def test_star_imports_shadow_nothing():
    names: dict[str, object] = {}
    exec("from scaleaxis import *", names)
    assert not [name for name in scaleaxis.__all__ if hasattr(builtins, name)]
    public = {name for name in vars(scaleaxis) if not name.startswith("_") and name not in ("filter", "Warning")}
    modules = {name for name in public if isinstance(getattr(scaleaxis, name), types.ModuleType)}
    assert public - modules <= names.keys() and {"batch", "errors"} <= names.keys()
    assert set(scaleaxis.__all__) <= set(dir(scaleaxis)) and "curves" not in dir(scaleaxis)
    assert scaleaxis.Warning is scaleaxis.ScaleAxisWarning


def imports_of(path):
    """The modules of the package that a module imports, wherever in it."""
    package = ["scaleaxis", *path.relative_to(PACKAGE).parent.parts]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level:
            base = ".".join([*package[: len(package) + 1 - node.level], *((node.module or "").split("."))]).rstrip(".")
            named = {f"{base}.{alias.name}" for alias in node.names}
            inner = named & {*MODULES, "scaleaxis._core"}
            yield from inner | ({base} if named - inner else set())


MODULES = {
    ".".join(["scaleaxis", *path.relative_to(PACKAGE).with_suffix("").parts]).removesuffix(".__init__"): path
    for path in PACKAGE.rglob("*.py")
}


def test_modules_do_not_import_in_circles():
    imports = {name: set(imports_of(path)) & MODULES.keys() for name, path in MODULES.items()}
    assert imports["scaleaxis.result"] >= {"scaleaxis.data", "scaleaxis.page"} and len(imports) > 25
    while imports:
        done = {name for name, needed in imports.items() if not needed & imports.keys()}
        assert done, f"a circle: {imports}"
        imports = {name: needed for name, needed in imports.items() if name not in done}


DEFAULTS = {
    "sample": ("sampling", "SamplingOptions"),
    "repair": ("fit", "RepairOptions"),
    "medial_axis": ("medial_axis", "MedialAxisOptions"),
    "filter": ("filter", "FilterOptions"),
    "extend_to_sharp_edges": ("sharp_edges", "SharpEdgeOptions"),
    "clean": ("cleaning", "CleanOptions"),
    "densify": ("shrinking", "DensifyOptions"),
    "skeleton": ("skeleton", "SkeletonOptions"),
    "midsurface": ("midsurface", "MidsurfaceOptions"),
    "thickness": ("thickness", "ThicknessOptions"),
    "filtration": ("filtration", "FiltrationOptions"),
    "vanishing_scales": ("filtration", "FiltrationOptions"),
    "mesh": ("union_mesh", "UnionMeshOptions"),
    "smoothed_mask": ("image", "MaskSmoothing"),
    "image_solid": ("image", "Level"),
}


@pytest.mark.parametrize("name", DEFAULTS)
def test_defaults_are_those_of_the_library(name):
    header, struct = DEFAULTS[name]
    text = (ROOT / f"include/scaleaxis/{header}.hpp").read_text(encoding="utf-8")
    body = re.search(rf"struct {struct} \{{\n(.*?)^\}};", text, re.S | re.M)[1]
    members = dict(re.findall(r"^    [\w:]+ (\w+) = ([\d.e-]+|true|false);", body, re.M))
    parameters = inspect.signature(FUNCTIONS[name]).parameters
    shared = [member for member in members if member in parameters and parameters[member].default is not None]
    shared = [member for member in shared if parameters[member].default is not inspect.Parameter.empty]
    assert shared
    for member in shared:
        value = members[member]
        expected = value == "true" if value in ("true", "false") else float(value)
        assert parameters[member].default == expected, member


def test_messages_of_the_library_name_no_flag_of_the_program():
    for path in [*(ROOT / "src").rglob("*.cpp"), *(ROOT / "src").rglob("*.hpp")]:
        for text in re.findall(r'"(?:[^"\\\n]|\\.)*"', path.read_text(encoding="utf-8")):
            assert not re.search(r"(?<![\w<!-])--[a-z]|scaleaxis (info|filtration)", text), (path, text)


def test_hints_have_the_names_of_options_here():
    known = {parameter for function in EVERY.values() for parameter in inspect.signature(function).parameters}
    hints = "delta-abs solid thickness opening clip iso label nonzero each-label largest-scale error"
    for hint in hints.split():
        name = scaleaxis.errors.with_hints("", [(hint, None)])[2:-1]
        assert name in known | FUNCTIONS.keys(), hint
    words = scaleaxis.errors.with_hints
    assert words("thin", [("solid", "thicken"), ("thickness", "0.09")]) == "thin (triangles='thicken', thickness=0.09)"
    assert words("which?", [("iso", None), ("each-label", "")]) == "which? (iso, label_axes)"
    assert words("a--b.stl: too coarse", []) == "a--b.stl: too coarse"


def test_messages_of_the_library_are_in_words_of_python():
    sheet = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]
    with pytest.raises(scaleaxis.UnusableInput, match="triangles='thicken', thickness=0.0"):
        scaleaxis.axis(sheet)
    vertices, faces = box_mesh()
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        scaleaxis.axis((vertices * [1, 1, 0.03], faces), delta=0.05)
    assert any(re.search(r"\(delta_abs=0\.0", str(one.message)) for one in told)
    with pytest.raises(scaleaxis.InvalidOption) as caught:
        scaleaxis.axis(lambda points: points[:, 0])
    assert caught.value.code == "option"


def test_warnings_come_once_for_the_line_of_the_user():
    vertices, faces = box_mesh((10.0, 10.0, 4.0))
    calls = [
        lambda: scaleaxis.axis((vertices, faces[:-1]), delta=0.05),
        lambda: scaleaxis.load((vertices, faces[:-1])),
        lambda: scaleaxis.skeleton((vertices, faces[:-1]), delta=0.05),
        lambda: scaleaxis.midsurface((vertices, faces[:-1]), delta=0.05),
        lambda: scaleaxis.spheres((vertices, faces[:-1]), 4, delta=0.05),
        lambda: scaleaxis.thin_regions(vertices, faces, np.arange(8.0), 3.5),
    ]
    for call in calls:
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            call()
        assert told and {one.filename for one in told} == {__file__}
        assert len({str(one.message) for one in told}) == len(told)
