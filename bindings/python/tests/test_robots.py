# SPDX-License-Identifier: Apache-2.0
"""Robots in spheres, and what planners and readers of robots make of the files."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pinocchio
import pytest
import scaleaxis
import yaml

ROBOT = Path(__file__).resolve().parents[3] / "examples" / "robot" / "gripper.urdf"
QUICK = {"delta": 0.05, "effort": 0.1}
JOINT = '<joint name="{}" type="fixed"><parent link="{}"/><child link="{}"/></joint>'


@pytest.fixture(scope="module")
def gripper():
    return scaleaxis.robot_spheres(ROBOT, total=12, **QUICK)


def largest_error(spheres):
    return max(statistics["error"] for statistics in spheres.statistics.values())


def model_of(file, **more):
    model = pinocchio.buildModelFromUrdf(str(file))
    return model, pinocchio.buildGeomFromUrdf(model, str(file), pinocchio.GeometryType.COLLISION, **more)


def test_a_total_is_shared(gripper):
    assert {link: len(balls) for link, balls in gripper.balls.items()}.keys() == {"arm", "palm", "finger"}
    assert sum(map(len, gripper.balls.values())) == 12
    # The sphere that the arm has already.
    assert gripper.balls["arm"][-1] == pytest.approx([0, 0, 0.3, 0.05])
    # As many for each link stick out no less; more spheres go to the links that need them.
    equal = scaleaxis.robot_spheres(ROBOT, 4, **QUICK)
    assert largest_error(gripper) <= largest_error(equal)
    more = scaleaxis.robot_spheres(ROBOT, total=18, **QUICK)
    assert largest_error(more) < largest_error(scaleaxis.robot_spheres(ROBOT, 6, **QUICK))
    assert len(more.balls["palm"]) > len(more.balls["finger"])


def test_nothing_reaches_through_a_plane():
    planes = {"palm": [("z", 0.0), ((0, 2, 0), -0.02)]}
    palm = scaleaxis.robot_spheres(ROBOT, 6, clip_planes=planes, **QUICK).balls["palm"]
    assert (palm[:, 2] - palm[:, 3] >= -1e-12).all()
    assert (palm[:, 1] - palm[:, 3] >= -0.02 - 1e-12).all()
    free = scaleaxis.robot_spheres(ROBOT, 6, **QUICK).balls["palm"]
    assert (free[:, 2] - free[:, 3] < -0.001).any()
    with pytest.raises(scaleaxis.InvalidOption, match="no link nose"):
        scaleaxis.robot_spheres(ROBOT, 6, clip_planes={"nose": [("z", 0.0)]}, **QUICK)
    with pytest.raises(scaleaxis.InvalidOption, match="no axis"):
        scaleaxis.robot_spheres(ROBOT, 6, clip_planes={"palm": [("up", 0.0)]}, **QUICK)


def test_pairs_at_rest(gripper):
    assert ("arm", "palm", "adjacent") in gripper.ignored
    assert ("arm", "finger", "touches at rest") not in gripper.ignored
    near = scaleaxis.robot_spheres(ROBOT, 4, **QUICK)
    near.balls["finger"] = np.vstack([near.balls["finger"], [-0.05, 0, -0.04, 0.04]])  # at the arm's end
    assert ("arm", "finger", "touches at rest") in near.ignored
    far = scaleaxis.robot_spheres(ROBOT, 4, rest={"slide": 0.4}, **QUICK)
    far.balls["finger"] = near.balls["finger"]
    assert ("arm", "finger", "touches at rest") not in far.ignored
    with pytest.raises(scaleaxis.InvalidOption, match="no joint end"):
        scaleaxis.robot_spheres(ROBOT, 4, rest={"end": 1.0}, **QUICK)


@pytest.mark.parametrize(
    ("joints", "fault"),
    [
        ("", "no joint leads from link a to link b"),
        (JOINT.format("j", "a", "c"), "joint j: there is no link c"),
        (JOINT.format("j", "a", "b") + '<link name="a"/>', "two links are named a"),
        (JOINT.format("j", "a", "b") + JOINT.format("k", "b", "a"), "joints lead from link a back to it"),
        (JOINT.format("j", "a", "b").replace("/></joint>", '/><mimic joint="j"/></joint>'), "cannot follow itself"),
        (JOINT.format("j", "a", "b"), None),
    ],
)
def test_joints_lead_from_one_link_to_all_others(tmp_path, joints, fault):
    ball = '<link name="{}"><collision><geometry><sphere radius="1"/></geometry></collision></link>'
    file = tmp_path / "robot.urdf"
    file.write_text(f'<robot name="r">{ball.format("a")}{ball.format("b")}{joints}</robot>')
    if fault is None:
        assert scaleaxis.robot_spheres(file, 1).ignored == [("a", "b", "adjacent")]
        return
    with pytest.raises(scaleaxis.FileError, match=fault):
        scaleaxis.robot_spheres(file, 1)


def test_boxes_have_positive_sizes(tmp_path):
    file = tmp_path / "box.urdf"
    box = '<link name="a"><collision><geometry><box size="1 -1 1"/></geometry></collision></link>'
    file.write_text(f'<robot name="r">{box}</robot>')
    with pytest.raises(scaleaxis.FileError, match="size should be positive"):
        scaleaxis.robot_spheres(file, 1)


def test_origins_turn_by_angles_or_by_quaternions(tmp_path):
    file = tmp_path / "turned.urdf"

    def balls_of(origin):
        box = f'<collision><origin {origin}/><geometry><box size="1 2 4"/></geometry></collision>'
        file.write_text(f'<robot name="r"><link name="a">{box}</link></robot>')
        return scaleaxis.robot_spheres(file, 4).balls["a"]

    x, y, z, w = np.array([0.3, 0.4, 0.5, 0.8]) / np.linalg.norm([0.3, 0.4, 0.5, 0.8])
    roll = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = np.arcsin(2 * (w * y - z * x))
    yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    across = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turn = np.eye(3) + 2 * w * across + 2 * across @ across
    for origin in ('quat_xyzw="0.3 0.4 0.5 0.8"', f'rpy="{roll} {pitch} {yaw}"'):
        in_box = (balls_of(f'xyz="1 2 3" {origin}')[:, :3] - [1, 2, 3]) @ turn
        assert (np.abs(in_box) < [0.5, 1.0, 2.0]).all() and np.ptp(in_box[:, 2]) > 2.0
    faults = {'quat_xyzw="0 0 0 0"': "should not be 0", 'rpy="0 0 1" quat_xyzw="0 0 0 1"': "leave one out"}
    for origin, fault in faults.items():
        with pytest.raises(scaleaxis.FileError, match=fault):
            balls_of(origin)


def test_pinocchio_reads_the_description(gripper, tmp_path):
    (file,) = gripper.write(tmp_path / "few.urdf")
    model, geometry = model_of(file)
    assert model.nq == 2 and geometry.ngeoms == 12
    subprocess.run(["check_urdf", file], check=True, capture_output=True)
    # Where it finds spheres at rest, and which of them touch, is what we say.
    data = model.createData()
    places = geometry.createData()
    pinocchio.updateGeometryPlacements(model, data, geometry, places, pinocchio.neutral(model))
    balls = {}
    for thing, place in zip(geometry.geometryObjects, places.oMg):
        link = model.frames[thing.parentFrame].name
        balls.setdefault(link, []).append((place.translation, thing.geometry.radius))
    touching = {
        (a, b)
        for a in balls
        for b in balls
        if a < b and any(np.linalg.norm(p - q) <= r + s for p, r in balls[a] for q, s in balls[b])
    }
    ours = {tuple(sorted(pair[:2])) for pair in gripper.ignored}
    assert touching <= ours
    assert {tuple(sorted(pair[:2])) for pair in gripper.ignored if pair[2] != "adjacent"} <= touching


def test_pinocchio_leaves_out_the_disabled_pairs(gripper, tmp_path):
    (urdf,), (srdf,) = gripper.write(tmp_path / "few.urdf"), gripper.write(tmp_path / "few.srdf")
    model, geometry = model_of(urdf)
    geometry.addAllCollisionPairs()
    before = len(geometry.collisionPairs)
    pinocchio.removeCollisionPairs(model, geometry, str(srdf))
    counts = {link: len(balls) for link, balls in gripper.balls.items()}
    assert before - len(geometry.collisionPairs) == sum(counts[a] * counts[b] for a, b, _ in gripper.ignored)


def test_the_configuration_of_curobo(gripper, tmp_path):
    (file,) = gripper.write(tmp_path / "few.yml")
    kinematics = yaml.safe_load(file.read_text())["robot_cfg"]["kinematics"]
    assert kinematics["base_link"] == "arm" and kinematics["tool_frames"] == ["tip"]
    assert kinematics["collision_link_names"] == ["arm", "palm", "finger"]
    assert kinematics["cspace"]["joint_names"] == ["wrist", "slide"]
    assert kinematics["self_collision_ignore"]["arm"] == ["palm"]
    assert kinematics["self_collision_buffer"] == {"arm": 0.0, "palm": 0.0, "finger": 0.0}
    for link, balls in gripper.balls.items():
        rows = [[*sphere["center"], sphere["radius"]] for sphere in kinematics["collision_spheres"][link]]
        assert np.array_equal(rows, balls)


def test_spheres_of_ballpark_and_pyroki(gripper, tmp_path):
    (file,) = gripper.write(tmp_path / "few.json")
    document = json.loads(file.read_text())
    assert ["arm", "palm"] in document["ignore_pairs"]
    for link, balls in gripper.balls.items():
        assert np.array_equal(document["spheres"][link]["centers"], balls[:, :3])
        assert np.array_equal(document["spheres"][link]["radii"], balls[:, 3])


@pytest.mark.parametrize("large", [1, 2])
def test_two_levels_for_vamp(gripper, tmp_path, large):
    files = gripper.write(tmp_path / "hand.json", "vamp", large=large)
    assert [file.name for file in files] == [
        "hand_spherized.urdf", "hand_spherized_1.urdf", "hand_spherized.srdf", "hand.json",
    ]  # fmt: skip
    config = json.loads(files[3].read_text())
    assert config["name"] == "Hand" and (tmp_path / config["urdf"]).exists() and (tmp_path / config["srdf"]).exists()
    assert config["end_effectors"] == ["tip"]
    _, geometry = model_of(files[1])
    for link, small in gripper.balls.items():
        model = [g for g in geometry.geometryObjects if g.name.startswith(f"{link}_")]
        assert len(model) == large
        _, fine = model_of(files[0])
        own = [g for g in fine.geometryObjects if g.name.startswith(f"{link}_")]
        assert len(own) == len(small)
        for g in own:
            slack = [
                h.geometry.radius
                - g.geometry.radius
                - np.linalg.norm(h.placement.translation - g.placement.translation)
                for h in model
            ]
            assert max(slack) > -1e-9


def test_xacro_is_expanded(tmp_path, monkeypatch):
    text = ROBOT.read_text().replace(
        '<robot name="gripper">', '<robot name="gripper" xmlns:xacro="http://ros.org/xacro">'
    )
    text = text.replace('<link name="arm">', '<xacro:arg name="long" default="0.3"/><link name="arm">', 1)
    text = text.replace('length="0.3"', 'length="$(arg long)"')
    text = text.replace("package://robot", f"file://{ROBOT.parent}")
    file = tmp_path / "gripper.urdf.xacro"
    file.write_text(text)
    monkeypatch.setenv("PATH", str(Path(sys.executable).parent), prepend=":")
    usual = scaleaxis.robot_spheres(file, 2, **QUICK)
    longer = scaleaxis.robot_spheres(file, 2, xacro={"long": "0.6"}, **QUICK)
    assert np.array_equal(usual.balls["arm"], scaleaxis.robot_spheres(ROBOT, 2, **QUICK).balls["arm"])
    assert longer.balls["arm"][:-1, 3].max() > usual.balls["arm"][:-1, 3].max()
    with pytest.raises(scaleaxis.FileError, match="does not expand"):
        file.write_text(text.replace("arg long", "arg short"))
        scaleaxis.robot_spheres(file, 2, **QUICK)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(scaleaxis.FileError, match="pip install xacro"):
        scaleaxis.robot_spheres(file, 2, **QUICK)


def test_wrong_robots(gripper, tmp_path):
    with pytest.raises(scaleaxis.InvalidOption, match="total"):
        scaleaxis.robot_spheres(ROBOT, 2, total=6)
    with pytest.raises(scaleaxis.InvalidOption, match="too few"):
        scaleaxis.robot_spheres(ROBOT, total=2, **QUICK)
    with pytest.raises(scaleaxis.InvalidOption, match="extension"):
        gripper.write(tmp_path / "few.txt")
    with pytest.raises(scaleaxis.InvalidOption, match='choose "vamp"'):
        gripper.write(tmp_path / "few.urdf", large=2)
    with pytest.raises(scaleaxis.FileError, match="cannot be written"):
        gripper.write(tmp_path / "none" / "few.urdf")
    (tmp_path / "two.urdf").write_text(
        "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>"
        "<joint name='j' type='fixed'><parent link='a'/><child link='c'/></joint>"
        "<joint name='k' type='fixed'><parent link='b'/><child link='c'/></joint></robot>"
    )
    with pytest.raises(scaleaxis.FileError, match="another parent"):
        scaleaxis.robot_spheres(tmp_path / "two.urdf", 2)
