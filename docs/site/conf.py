# SPDX-License-Identifier: Apache-2.0
"""The documentation site: docs/site/build calls Sphinx with this."""

from __future__ import annotations

import inspect
import os
import re
import sys
import warnings
from pathlib import Path
from typing import Any

import pyvista
import scaleaxis
from sphinx.pycode import ModuleAnalyzer

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

project = "scaleaxis"
version = release = scaleaxis.__version__
copyright = "the authors of scaleaxis; Apache License 2.0"
root_doc = "index"
exclude_patterns = ["gallery-source", "site"]
extensions = [
    "myst_parser",
    "breathe",
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "sphinx.ext.githubpages",
    "sphinx_copybutton",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
]

# Markdown, as code hosts show it
myst_enable_extensions = ["colon_fence", "dollarmath", "attrs_block"]
myst_heading_anchors = 3
source_suffix = {".rst": "restructuredtext", ".md": "markdown"}
highlight_language = "text"

# Python
autodoc_typehints = "description"
autodoc_typehints_description_target = "all"
autodoc_type_aliases = {
    "npt.ArrayLike": "numpy.typing.ArrayLike",
    "Floats": "numpy.ndarray",
    "Ints": "numpy.ndarray",
    "Progress": "scaleaxis.Progress",
    "Path": "os.PathLike",
    "Function": "collections.abc.Callable",
}
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True}
python_maximum_signature_line_length = 100
add_module_names = False
default_role = "py:obj"

# C++
breathe_projects = {"scaleaxis": os.environ["SCALEAXIS_DOXYGEN"]}
breathe_default_project = "scaleaxis"
breathe_show_include = False
cpp_maximum_signature_line_length = 100

# Gallery
pyvista.BUILDING_GALLERY = True
pyvista.OFF_SCREEN = True
theme = pyvista.global_theme
theme.background = "white"
theme.font.color = "black"
theme.font.family = "arial"
theme.window_size = [1000, 750]
theme.anti_aliasing = "ssaa"
theme.lighting_params.ambient = 0.15
theme.colorbar_orientation = "vertical"
theme.colorbar_vertical.position_x = 0.86
theme.colorbar_vertical.position_y = 0.1
theme.colorbar_vertical.width = 0.05
theme.colorbar_vertical.height = 0.45
# What an example warns of is shown without the place of its file on this machine.
warnings.formatwarning = lambda message, category, *_: f"{category.__name__}: {message}\n"
sphinx_gallery_conf = {
    "examples_dirs": ["gallery-source"],
    "gallery_dirs": ["gallery"],
    "filename_pattern": "",  # all
    "copyfile_regex": r".*\.(obj|stl|png)",
    "within_subsection_order": "gallery_order.key",
    "image_scrapers": ("matplotlib", "pyvista"),
    "abort_on_example_error": True,
    "capture_repr": ("_repr_html_", "__repr__"),
    "ignore_repr_types": r"matplotlib|NoneType|pyvista|tuple|list",
    "min_reported_time": 1e6,
    "show_signature": False,
    "show_memory": False,
    "write_computation_times": False,
    "thumbnail_size": (400, 300),
    "remove_config_comments": True,
    "plot_gallery": True,
}

# Appearance
html_theme = "pydata_sphinx_theme"
html_title = "scaleaxis"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {
    "show_prev_next": False,
    "navigation_with_keys": False,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "show_nav_level": 2,
    "header_links_before_dropdown": 7,
    "logo": {"text": "scaleaxis"},
    "pygments_light_style": "default",
}
html_sidebars = {"index": [], "how-it-works": [], "compared": []}
html_context = {"default_mode": "light"}

# The gallery's order is a function; the namespace scaleaxis is declared by each header.
suppress_warnings = ["config.cache", "duplicate_declaration.cpp"]


def parameters_as_fields(app: Any, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Docstrings say `name, name: what it is`, and indent what follows; the site lists each parameter as a field."""
    try:
        known = set(inspect.signature(thing).parameters)
    except (TypeError, ValueError):
        return
    result: list[str] = []
    names: list[str] = []
    meaning: list[str] = []

    def flush() -> None:
        for one in names:
            escaped = re.sub("_$", r"\\_", one)
            result.extend([f":param {escaped}: {meaning[0]}", *meaning[1:]])
        names.clear()

    for line in lines:
        start = re.match(r"(\w+(?:, \w+)*): (.*)", line)
        if start and known.issuperset(start.group(1).split(", ")):
            if not names and result and result[-1]:
                result.append("")
            flush()
            names[:] = start.group(1).split(", ")
            meaning[:] = [start.group(2)]
        elif names and line.startswith(" "):
            meaning.append("    " + line.strip())
        else:
            if names:
                flush()
                result.append("")
            result.append(line)
    flush()
    lines[:] = [*result, ""]


def names_for_outside(app: Any, docname: str, content: list[str]) -> None:
    """Links to what the site does not have, such as sources, become the names of these files."""
    folder = os.path.dirname(docname)

    def name_of(link: re.Match[str]) -> str:
        target = os.path.normpath(os.path.join("docs", folder, link.group(2)))
        if target.startswith("docs/"):
            return link.group(0)
        return f"`{target}`" if link.group(1) in target else f"{link.group(1)} (`{target}`)"

    if not docname.startswith("gallery/"):
        content[0] = re.sub(r"(?<!!)\[([^\]]+)\]\((\.\./[^)#]+)(?:#[^)]*)?\)", name_of, content[0])


def setup(app: Any) -> None:
    # `axis` has overloads for type checkers; readers are better off with the one signature behind them.
    analyzer = ModuleAnalyzer.for_module("scaleaxis.pipeline")
    analyzer.analyze()
    analyzer.overloads.clear()
    app.connect("source-read", names_for_outside)
    app.connect("autodoc-process-docstring", parameters_as_fields)
