"""Worlds and models of Gazebo's SDF, converted and simulated."""
import math
import pathlib
import subprocess

import blem_sim
import numpy as np
import pytest
import yaml

PROGRAM = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "worlds" / "world_from_sdf"
G = 9.8  # [m/s^2], Gazebo's
SMALL = "<inertial><mass>%g</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial>"


def box(size, name="c", extra=""):
    return "<collision name='%s'>%s<geometry><box><size>%s</size></box></geometry></collision>" % (name, extra, size)


class Conversion:
    def __init__(self, folder, sdf, *options, version="1.6"):
        self.folder = folder
        (folder / "my.world").write_text("<?xml version='1.0'?><sdf version='%s'>%s</sdf>" % (version, sdf))
        run = subprocess.run([str(PROGRAM), "my.world", *options], cwd=str(folder), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                             universal_newlines=True, check=False)
        self.status, self.lines = run.returncode, run.stderr.splitlines()

    @property
    def yaml(self):
        return yaml.safe_load((self.folder / "my" / "world.yaml").read_text())

    def simulator(self):
        return blem_sim.Simulator(str(self.folder / "my" / "world.yaml"))


@pytest.fixture
def convert(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))  # where no models are
    monkeypatch.delenv("GAZEBO_MODEL_PATH", raising=False)
    return lambda sdf, *options, **more: Conversion(tmp_path, sdf, *options, **more)


def world(content):
    return "<world name='w'>%s</world>" % content


def model(content, name="m", pose="0 0 0 0 0 0"):
    return "<model name='%s'><pose>%s</pose>%s</model>" % (name, pose, content)


def link(content, name="l", pose="0 0 0 0 0 0"):
    return "<link name='%s'><pose>%s</pose>%s</link>" % (name, pose, content)


def joint(content, name="j", kind="revolute", parent="world", child="l"):
    return "<joint name='%s' type='%s'><parent>%s</parent><child>%s</child>%s</joint>" % (name, kind, parent, child, content)


def period(simulator, rest):
    """[s] of the swing of the last joint about a position [rad]."""
    rises, last = [], None
    while len(rises) < 2:
        simulator.step(1)
        angle = simulator.positions[-1] - rest
        if last is not None and last < 0 <= angle:
            rises.append(simulator.time - simulator.time_step * angle / (angle - last))
        last = angle
    return rises[1] - rises[0]


def test_a_box_rests_on_a_table_of_boxes_beside_the_ground(convert):
    table = "<static>1</static>" + link(box("1 1 0.04") + box("0.1 0.1 0.7", "leg", "<pose>0 0 -0.35 0 0 0</pose>"), pose="0 0 0.7 0 0 0")
    conversion = convert(world("<include><uri>model://ground_plane</uri></include>" + model(table, "table", "1 2 0 0 0 0.3") +
                               model(link(SMALL % 2 + box("0.1 0.1 0.2")), "box", "1 2 0.83 0 0 0.5")))
    assert (conversion.status, conversion.lines) == (0, [])
    assert [entry["name"] for entry in conversion.yaml["environments"]] == ["ground_plane", "table"]
    simulator = conversion.simulator()
    simulator.step(1000)
    assert simulator.poses[0, 2] == pytest.approx(0.72 + 0.1 + 0.0025, abs=1e-6)  # with its layer
    assert np.abs(simulator.contacts["force"][:, 2]).sum() == pytest.approx(2 * G, rel=1e-6)


def test_settings_are_the_physics(convert):
    conversion = convert(world("<gravity>0 0 -1.6</gravity><physics type='ode'><max_step_size>0.002</max_step_size>"
                               "<real_time_update_rate>1000</real_time_update_rate></physics><light name='a'/>"))
    assert {key: conversion.yaml[key] for key in ("gravity", "time_step", "real_time_factor")} == {
        "gravity": [0, 0, -1.6], "time_step": 0.002, "real_time_factor": 2.0}
    assert conversion.lines == ["note: not read: <light>"]


# A joint away from its link's origin, in a model that is turned: the pin is 0.2 m above the origin, the mass 0.5 m below.
@pytest.mark.parametrize("axis,version", [("<xyz>1 0 0</xyz>", "1.6"), ("<xyz expressed_in='__model__'>1 0 0</xyz>", "1.7"), ("<xyz>1 0 0</xyz>", "1.4"),
                                          ("<use_parent_model_frame>1</use_parent_model_frame><xyz>1 0 0</xyz>", "1.5")])
def test_a_pendulum_swings_as_theory_has_it(convert, axis, version):
    bob = link("<inertial><pose>0 0 -0.5 0 0 0</pose><mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>",
               pose="0 0 1 0.1 0 0")
    conversion = convert(model(bob + joint("<pose>0 0 0.2 0 0 0</pose><axis>%s</axis>" % axis), pose="1 2 3 0 0 0.7"), version=version)
    assert conversion.status == 0
    inertia = 0.1 + 2 * 0.7 ** 2
    theory = 2 * math.pi * math.sqrt(inertia / (2 * 9.81 * 0.7)) * (1 + 0.1 ** 2 / 16)
    assert period(conversion.simulator(), -0.1) == pytest.approx(theory, rel=1e-5)


def test_axes_of_old_files_are_the_models(convert):
    turned = model(link(SMALL % 1, pose="0 0 0 0 0 1.5707963267948966") + joint("<axis><xyz>1 0 0</xyz></axis>"))
    for version, axis in (("1.4", [0, -1, 0]), ("1.6", [1, 0, 0])):
        urdf = (convert(turned, version=version).folder / "my" / "urdf" / "m.urdf").read_text()
        found = [float(number) for number in urdf.split('<axis xyz="')[1].split('"')[0].split()]
        assert found == pytest.approx(axis, abs=1e-9)


def test_frames_nested_and_included_models_take_their_places(convert, tmp_path):
    hook = tmp_path / "models" / "hook"
    hook.mkdir(parents=True)
    (hook / "model.config").write_text("<model><sdf version='1.4'>old.sdf</sdf><sdf version='1.6'>new.sdf</sdf></model>")
    (hook / "new.sdf").write_text("<sdf version='1.6'>%s</sdf>" % model(link(SMALL % 1 + box("0.1 0.1 0.1")), "hook", "9 9 9 0 0 0"))
    nested = model(link(SMALL % 1), "inner", "0 0 1 0 0 0")
    outer = ("<frame name='up'><pose>0 0 2 0 0 0</pose></frame>" + nested + link(SMALL % 1, "base", "0.1 0.2 0.3 0 0 0.5") +
             "<include><uri>model://hook</uri><pose relative_to='up'>0.5 0 0 0 0 0</pose></include>" +
             joint("", "a", "fixed", "base", "inner::l") + joint("", "b", "revolute", "base", "hook::l"))
    conversion = convert(model(outer, pose="0 5 0 0 0 1.5707963267948966"), "--models", "models", version="1.7")
    assert (conversion.status, conversion.lines) == (0, [])
    simulator = conversion.simulator()
    assert simulator.body_names == ["m::base", "m::hook__l"]
    assert simulator.poses[1, :3] == pytest.approx([0, 5.5, 2], abs=1e-9)


def test_states_move_models_and_names_that_are_there_twice_differ(convert):
    brick = link(SMALL % 1 + box("0.1 0.1 0.1"))
    conversion = convert(world(model(brick, "a") + model(brick, "a") + "<state world_name='w'><model name='a'><pose>1 2 3 0 0 0</pose></model></state>"))
    assert [(entry["name"], entry["pose"]["xyz"]) for entry in conversion.yaml["objects"]] == [("a", [1, 2, 3]), ("a_1", [1, 2, 3])]
    assert conversion.lines == ["note: model 'a': the name is there twice; the later one is called 'a_1'"]


# One of two skids grips: with half of the weight it holds a fifth of it, but not three fifths, which two that grip would.
@pytest.mark.parametrize("pull,stays", [(2, True), (6, False)])
def test_collisions_of_a_link_keep_their_surfaces(convert, pull, stays):
    skids = "".join("<collision name='%s'><pose>0 %g 0 0 0 0</pose><geometry><box><size>0.2 0.02 0.02</size></box></geometry>"
                    "<surface><friction><ode><mu>%g</mu></ode></friction></surface></collision>" % skid
                    for skid in (("grip", 0.1, 0.9), ("slip", -0.1, 0)))
    conversion = convert(world("<gravity>%g 0 -9.8</gravity><include><uri>model://ground_plane</uri></include>" % pull +
                               model(link(SMALL % 4 + skids), "sledge", "0 0 0.0125 0 0 0")))
    simulator = conversion.simulator()
    simulator.step(500)
    assert (simulator.poses[0, 0] < 1e-4) == stays


def test_round_shapes_that_stand_still_are_closed_meshes(convert):
    shapes = ("<cylinder><radius>0.5</radius><length>2</length></cylinder>", "<sphere><radius>0.5</radius></sphere>")
    volumes = (0.5 * math.pi, math.pi / 6)
    for shape, volume in zip(shapes, volumes):
        conversion = convert(world(model("<static>1</static>" + link("<collision name='c'><geometry>%s</geometry></collision>" % shape))))
        rows = (conversion.folder / "my" / "meshes" / "m.off").read_text().split("\n")[1:]
        count = int(rows[0].split()[0])
        points = np.array([[float(x) for x in row.split()] for row in rows[1:1 + count]])
        corners = points[[[int(i) for i in row.split()[1:]] for row in rows[1 + count:] if row]]
        enclosed = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
        assert enclosed == pytest.approx(volume, rel=2e-3)


def test_several_robots_have_namespaces_sensors_and_drives(convert):
    wheel = SMALL % 1 + "<collision name='c'><geometry><cylinder><radius>0.1</radius><length>0.05</length></cylinder></geometry></collision>"
    cart = (link(SMALL % 5 + box("0.3 0.2 0.1") + "<sensor name='imu' type='imu'><update_rate>50</update_rate></sensor>", "base") +
            "".join(link(wheel, side, "0 %g 0 -1.570796 0 0" % y) + joint("<axis><xyz>0 0 1</xyz></axis>", side + "_axle", parent="base", child=side)
                    for side, y in (("left", 0.15), ("right", -0.15))) +
            "<plugin name='drive' filename='libgazebo_ros_diff_drive.so'><leftJoint>left_axle</leftJoint><rightJoint>right_axle</rightJoint>"
            "<wheelSeparation>0.3</wheelSeparation><wheelDiameter>0.2</wheelDiameter><legacyMode>false</legacyMode>"
            "<robotBaseFrame>base</robotBaseFrame></plugin>")
    conversion = convert(world(model(cart, "one", "0 0 0.1 0 0 0") + model(cart, "two", "0 2 0.1 0 0 0")))
    assert [robot["namespace"] for robot in conversion.yaml["robots"]] == ["one", "two"]
    notes = conversion.simulator().notes
    assert any("two: drives of its <gazebo> blocks: drive (on /two/cmd_vel)" in note for note in notes), notes
    assert any("one: sensors of its <gazebo> blocks: imu" in note for note in notes), notes


@pytest.mark.parametrize("content,line", [
    (model(link(SMALL % 1) + joint("", kind="ball")), "model 'm', joint 'j': type 'ball' is not read; write revolute, continuous, prismatic or fixed"),
    (model(link("", "a") + link("", "b") + joint("", "x", parent="a", child="b") + joint("", "y", parent="b", child="a")),
     "model 'm': its joints go round in a circle; leave one out"),
    (model(link("") + joint("", "x") + joint("", "y")), "model 'm', joint 'y': closes a loop, which is not read; leave it out"),
    (model(link("") + joint("", parent="arm")), "model 'm', joint 'j': there is no link 'arm'; name one of the model"),
    ("<include><uri>model://shelf</uri></include>", "<include>: 'model://shelf' is in none of the folders of models; give its folder by --models"),
    (model("<static>1</static>" + link("<collision name='c'><geometry><heightmap/></geometry></collision>")),
     "model 'm', link 'l', collision 'c': <geometry> heightmap is not read; write a mesh, box, cylinder, sphere or capsule"),
    (model(link(box("1 1"))), "model 'm', link 'l', collision 'c': <size>: '1 1' must be 3 numbers"),
    (model(link("", pose="0 0 x 0 0 0")), "model 'm', link 'l': <pose>: '0 0 x 0 0 0' must be 6 numbers"),
    (model("<link name='l'><pose relative_to='k'/></link><link name='k'><pose relative_to='l'/></link>"),
     "model 'm': frame 'l' is told relative to itself; break that circle"),
])
def test_what_cannot_be_read_is_left_out_in_a_line(convert, content, line):
    conversion = convert(world(content + model(link(SMALL % 1 + box("0.1 0.1 0.1")), "kept")), version="1.7")
    assert conversion.status == 1
    assert conversion.lines == ["left out: " + line]
    assert [entry["name"] for entry in conversion.yaml["objects"]][-1:] == ["kept"]


@pytest.mark.parametrize("text,words", [("", "is no XML"), ("<robot/>", "<robot> is no SDF; give a file with <sdf>"),
                                        ("<sdf version='1.6'/>", "has no <world> and no <model>"), ("<sdf version='x'><model name='m'/></sdf>", "write 1.6")])
def test_other_files_are_refused_in_a_line(tmp_path, text, words):
    (tmp_path / "a.sdf").write_text(text)
    run = subprocess.run([str(PROGRAM), "a.sdf"], cwd=str(tmp_path), stderr=subprocess.PIPE, universal_newlines=True, check=False)
    assert run.returncode == 2
    assert run.stderr.count("\n") == 1 and words in run.stderr, run.stderr
