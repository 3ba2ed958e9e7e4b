# SPDX-License-Identifier: Apache-2.0
"""Checks a built site: check.py FOLDER

Local links and anchors resolve, every page can be reached from the first one, every example of the gallery has a
picture that is not blank, the references have every public name and every header, and nothing on the pages comes
from the network or names a path of this machine.
"""

from __future__ import annotations

import os
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import numpy as np
import scaleaxis
import sphinx.util.inventory
from gallery_order import ORDER
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
LOADED = {("script", "src"), ("img", "src"), ("link", "href"), ("iframe", "src")}  # with the page itself


class Page(HTMLParser):
    """Links, what is loaded, and anchors of a page."""

    def __init__(self, file: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.anchors: set[str] = set()
        self.text = file.read_text(encoding="utf-8")
        self.feed(self.text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        for name, value in attributes:
            if value is None:
                continue
            if name in ("id", "name"):
                self.anchors.add(value)
            elif (tag, name) in LOADED and dict(attributes).get("rel") not in ("search", "index", "next", "prev"):
                self.loaded.append(value)
            elif name in ("href", "src"):
                self.links.append(value)


def is_blank(picture: Path) -> bool:
    """Almost one colour?"""
    colors = np.asarray(Image.open(picture).convert("RGB"), dtype=float)
    background = np.median(colors.reshape(-1, 3), axis=0)
    return bool((np.abs(colors - background).max(axis=2) > 24).mean() < 0.01)


def check_links(site: Path, pages: dict[Path, Page]) -> list[str]:
    faults = []
    reached, waiting = {site / "index.html"}, [site / "index.html"]
    while waiting:
        file = waiting.pop()
        page = pages[file]
        for link in page.links + page.loaded:
            parts = urlsplit(link)
            if parts.scheme in ("http", "https", "//", "mailto", "data", "javascript") or parts.netloc:
                continue
            target = Path(os.path.normpath(file.parent / unquote(parts.path))) if parts.path else file
            if not target.is_file():
                faults.append(f"{file.relative_to(site)}: {link} leads nowhere")
            elif target in pages:
                if parts.fragment and unquote(parts.fragment) not in pages[target].anchors:
                    faults.append(f"{file.relative_to(site)}: {link} has no such anchor")
                if target not in reached:
                    reached.add(target)
                    waiting.append(target)
    apart = {site / "search.html", site / "genindex.html", site / "py-modindex.html"}
    faults += [f"{file.relative_to(site)}: no link leads there" for file in sorted(pages.keys() - reached - apart)]
    return faults


def check_pages(site: Path, pages: dict[Path, Page]) -> list[str]:
    faults = []
    for file, page in pages.items():
        name = file.relative_to(site)
        faults += [
            f"{name}: loads {link}, from the network"
            for link in page.loaded
            if urlsplit(link).netloc and not link.startswith("data:")
        ]
        for path in {str(ROOT), str(Path.home()) + "/"} - {"//"}:
            if path in page.text:
                faults.append(f"{name}: names {path}, a path of this machine")
    return faults


def check_gallery(site: Path) -> list[str]:
    faults = []
    scripts = {file.stem for file in (ROOT / "docs/gallery").glob("*.py")}
    if scripts != set(ORDER):
        faults.append(f"gallery: {sorted(scripts ^ set(ORDER))} must be in both, docs/gallery and gallery_order.py")
    for name in ORDER:
        if not (site / "gallery" / f"{name}.html").is_file():
            faults.append(f"gallery: no page of {name}")
        pictures = sorted((site / "_images").glob(f"sphx_glr_{name}_[0-9]*.png"))
        thumbnail = site / "_images" / f"sphx_glr_{name}_thumb.png"
        if not pictures and name != "jupyter":  # which has a page in its page
            faults.append(f"gallery: no picture of {name}")
        for picture in [*pictures, thumbnail]:
            if not picture.is_file() or is_blank(picture):
                faults.append(f"gallery: {picture.name} is blank, or not there")
    if "<iframe" not in (site / "gallery/jupyter.html").read_text(encoding="utf-8"):
        faults.append("gallery: jupyter.html has no interactive page in it")
    return faults


def check_reference(site: Path) -> list[str]:
    with open(site / "objects.inv", "rb") as file:
        inventory = sphinx.util.inventory.InventoryFile.load(file, "", lambda base, path: path)
    python = {
        name.split(".", 1)[1]
        for kind in inventory
        if kind.startswith("py:")
        for name in inventory[kind]
        if name.startswith("scaleaxis.")
    }
    cpp = {name for kind in inventory if kind.startswith("cpp:") for name in inventory[kind]}
    same = {"union_mesh", "surface_distance", "signed_distance_image", "load_solid", "errors", "batch", "__version__"}
    faults = [f"reference: scaleaxis.{name} is not in it" for name in sorted(set(scaleaxis.__all__) - python - same)]
    headers = {file.name for file in (ROOT / "include/scaleaxis").glob("*.hpp")}
    text = "".join(file.read_text(encoding="utf-8") for file in (ROOT / "docs/reference/cpp").glob("*.md"))
    faults += [f"reference: scaleaxis/{name} is not in it" for name in sorted(headers) if f":: {name}\n" not in text]
    for name in ("scale_axis", "Solid", "MedialComplex", "BallUnion", "UnusableInput", "Execution"):
        if f"scaleaxis::{name}" not in cpp:
            faults.append(f"reference: scaleaxis::{name} is not in it")
    return faults


def main(site: Path) -> int:
    pages = {
        file: Page(file)
        for file in site.rglob("*.html")
        if "_static" not in file.parts and "_downloads" not in file.parts
    }
    faults = check_links(site, pages) + check_pages(site, pages) + check_gallery(site) + check_reference(site)
    for fault in faults:
        print(f"docs/site/check.py: {fault}", file=sys.stderr)
    print(f"{len(pages)} pages, {len(ORDER)} examples, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve()))
