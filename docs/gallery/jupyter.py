# SPDX-License-Identifier: Apache-2.0
"""
Jupyter: an axis to turn round
==============================

In a notebook an axis shows itself as an interactive page.
"""

# %%
# ``view`` makes one page of an axis, or of several scales of it with a slider. As the last line of a cell it is
# shown there. Turn it with the mouse, move the scale, click on a sheet to read its thickness.

import scaleaxis

axes = scaleaxis.axis("cat.obj", delta=0.02, scale=[1.0, 1.05, 1.1, 1.5])
scaleaxis.view(axes)

# %%
# Elsewhere the page is a file, which opens in any browser and needs nothing of the network.
# ``axis.view("cat.html")`` says where to put it.

page = scaleaxis.view(axes, "cat.html")
print(f"{page.path}: {page.path.stat().st_size / 1e6:.1f} MB")

# sphinx_gallery_thumbnail_path = 'images/jupyter.png'
