# SPDX-License-Identifier: Apache-2.0
"""The server of the Model Context Protocol, over standard input and output."""

import asyncio
import base64
import json
import sys
from pathlib import Path

import numpy as np
import pytest
import scaleaxis
from conftest import box_mesh
from scaleaxis.mcp import picture_of

PNG = b"\x89PNG\r\n\x1a\n"


def test_pictures_show_the_mesh() -> None:
    vertices, triangles = box_mesh((2, 3, 1))
    colors = np.tile(np.array([200, 40, 40], dtype=np.uint8), (len(vertices), 1))
    assert picture_of(scaleaxis.Mesh(vertices, triangles), colors).startswith(PNG)


def test_tools_over_stdio(tmp_path: Path) -> None:
    mcp = pytest.importorskip("mcp")
    from mcp.client.stdio import stdio_client

    part = str(tmp_path / "plate.stl")
    scaleaxis.write_mesh(part, scaleaxis.Mesh(*box_mesh((20, 10, 0.5))))

    async def ask() -> dict:
        server = mcp.StdioServerParameters(command=sys.executable, args=["-m", "scaleaxis.mcp"])
        async with stdio_client(server) as streams, mcp.ClientSession(*streams) as session:
            await session.initialize()
            names = [tool.name for tool in (await session.list_tools()).tools]
            calls = {
                "info": {"path": part},
                "walls": {"path": part, "min_wall": 0.8},
                "thickness": {"path": part, "points": [[5, 5, 0.5]]},
                "spheres": {"path": part, "count": 4},
            }
            return {"names": names} | {name: await session.call_tool(name, given) for name, given in calls.items()}

    answers = asyncio.run(ask())
    assert sorted(answers["names"]) == ["info", "skeleton", "spheres", "thickness", "walls"]
    documents = {name: json.loads(answers[name].content[0].text) for name in ("info", "walls", "thickness", "spheres")}
    assert documents["info"]["kind"] == "mesh"
    (finding,) = documents["walls"]["findings"]
    assert finding["kind"] == "thin_wall" and finding["value"] == pytest.approx(0.5, rel=2e-3)
    assert base64.b64decode(answers["walls"].content[1].data).startswith(PNG)
    assert documents["thickness"]["thickness"] == pytest.approx([0.5], rel=3e-3)
    assert len(documents["spheres"]["balls"]) == 4
