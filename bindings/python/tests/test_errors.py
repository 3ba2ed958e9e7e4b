# SPDX-License-Identifier: Apache-2.0
"""What the library throws and warns of."""

from __future__ import annotations

import pickle
import warnings

import numpy as np
import pytest
import scaleaxis


def test_classes():
    for name in ("InvalidOption", "FileError", "UnusableInput", "InconsistentResult", "Cancelled"):
        assert issubclass(getattr(scaleaxis, name), scaleaxis.Error)
    assert issubclass(scaleaxis.InvalidOption, ValueError) and issubclass(scaleaxis.UnusableInput, ValueError)
    assert issubclass(scaleaxis.FileError, OSError)
    assert issubclass(scaleaxis.Warning, UserWarning)


def test_sheet_is_refused_with_its_place(box):
    with pytest.raises(scaleaxis.UnusableInput, match="no inside") as caught:
        scaleaxis.axis((box[0], box[1][:1]))
    error = caught.value
    assert error.code == "mesh.sheet"
    assert error.place is not None and len(error.place) == 3
    assert min(np.linalg.norm(box[0] - error.place, axis=1).min(), 0.5) < 4  # it lies at the box


def test_options_out_of_range(box):
    for options in ({"delta": 0.9}, {"scale": 0.5}, {"angle": 100.0}, {"smooth": -1}, {"threads": -1}, {"scale": 11}):
        with pytest.raises(scaleaxis.InvalidOption) as caught:
            scaleaxis.axis(box, **options)
        assert caught.value.code == "option"
    for options, known in (({"union": "round"}, "'polar', 'fitted'"), ({"method": "x"}, "'scale', 'angle', 'lambda'")):
        with pytest.raises(scaleaxis.InvalidOption, match=known):
            scaleaxis.axis(box, **options)
    with pytest.raises(scaleaxis.InvalidOption, match="'mls', 'crust'"):
        scaleaxis.axis(box[0], points="best")
    with pytest.raises(scaleaxis.InvalidOption, match="'mesh'"):
        scaleaxis.axis("x.obj", kind="solid")
    with pytest.raises(TypeError):
        scaleaxis.axis(box, progress="yes")


def test_files(tmp_path):
    with pytest.raises(scaleaxis.FileError) as caught:
        scaleaxis.axis(tmp_path / "missing.obj")
    assert "missing.obj" in str(caught.value) and caught.value.code
    (tmp_path / "bad.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 x\n3 0 1 2\n")
    with pytest.raises(OSError, match="bad.off") as caught:
        scaleaxis.read_mesh(tmp_path / "bad.off")
    assert (caught.value.element, caught.value.index) == ("line", 5)
    with pytest.raises(scaleaxis.FileError, match="\\.xyz"):
        scaleaxis.check_axis_output(tmp_path / "axis.xyz")


def test_errors_survive_pickling():
    error = scaleaxis.UnusableInput("it is open", "mesh.sheet", "edge", 3, (1.0, 2.0, 3.0))
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is scaleaxis.UnusableInput and str(again) == "it is open"
    assert (again.code, again.element, again.index, again.place) == ("mesh.sheet", "edge", 3, (1.0, 2.0, 3.0))
    warning = pickle.loads(pickle.dumps(scaleaxis.Warning("odd", "x.odd")))
    assert str(warning) == "odd" and warning.code == "x.odd"
    file = pickle.loads(pickle.dumps(scaleaxis.FileError("cannot be read", "file")))
    assert str(file) == "cannot be read" and file.code == "file"


def test_warnings_are_pythons_and_stay_with_the_result(box):
    reversed_box = (box[0], box[1][:, ::-1])
    with pytest.warns(scaleaxis.Warning) as caught:
        axis = scaleaxis.axis(reversed_box, delta=0.05)
    assert [warning.message for warning in caught] == axis.warnings
    assert axis.warnings[0].code.startswith("mesh.")
    assert caught[0].filename == __file__
    with pytest.warns(scaleaxis.Warning) as caught:
        scaleaxis.load(reversed_box)
    assert caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error", scaleaxis.Warning)
        with pytest.raises(scaleaxis.Warning):
            scaleaxis.axis(reversed_box, delta=0.05)


def test_elements_whose_names_are_no_text():
    """The head of a PLY file may name an element by any bytes."""
    head = b"ply\nformat binary_little_endian 1.0\nelement vertex 1\n"
    head += b"property float x\nproperty float y\nproperty float z\n"
    head += b"element fa\xe5e 4\nproperty list uchar int vertex_indices\nend_header\n"
    with pytest.raises(scaleaxis.FileError, match="a list is longer") as caught:
        scaleaxis.read_mesh(head + bytes(12) + b"\xff" * 40, "bad.ply")
    assert caught.value.element == "fa\ufffde"
