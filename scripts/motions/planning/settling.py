"""Where a link comes to rest on the meshes of the world: asked of the simulator, which lets the link alone sink with the robot's weight on it."""
import copy
import pathlib
import tempfile
import xml.etree.ElementTree as ElementTree

import numpy as np
from kinematics import from_quaternion
from sweeping.checked_yaml import InputError, read_yaml
from sweeping.input_files import resolved

from planning.results import roll_pitch_yaw
from planning.robot_file import with_own
from planning.simulation import simulator

ROBOT_KEYS = ("name", "boundary_width", "friction", "restitution", "stiffness", "damping", "impact_friction_factor", "impact_friction_speed")
GYRATION = 0.05         # [m] radius of gyration that the weight is given, about that of a foot
LONGEST, LOOK = 5.0, 0.1  # [s] that a link has to come to rest; between looks
STILL = 1e-4            # [m/s, rad/s] at which it counts as resting
FARTHEST = 0.03         # [m] of its rest from where it is put down


class Settling:
    """The links of a robot, one at a time, among what stands still in its configuration. Raises InputError where there is no simulator, or a link
    does not come to rest."""

    def __init__(self, motion, robot, packages):
        if robot.name is None:
            raise InputError("%s: settles: a URDF has no world; name a configuration, or leave the key out" % motion.file)
        self.motion, self.model, self.packages = motion, robot.model, packages
        self.folder = pathlib.Path(robot.file).resolve().parent
        self.config = read_yaml(robot.file)
        self.row = self.config["robots"][robot.number]
        self.urdf = pathlib.Path(resolved(self.row["urdf"], str(self.folder), with_own(packages)))
        self.known = {}

    def rest(self, contact, frame):
        """The frame (rotation, middle) of a contact that rests where `frame` puts it, the robot's weight on the middle of its points: turned and
        raised or lowered, while the middle keeps its x and y."""
        place = (contact.name, np.concatenate([frame[0].ravel(), frame[1]]).tobytes())
        if place not in self.known:
            self.known[place] = self.settled(contact, *frame)
        return self.known[place]

    def settled(self, contact, rotation, middle):
        """The frame of a contact that was let go at another."""
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "link.urdf"
            file.write_text(self.link_alone(contact))
            pose = {"xyz": [float(x) for x in middle - rotation @ contact.middle], "rpy": [float(a) for a in roll_pitch_yaw(rotation)]}
            x, y, z, *quaternion = self.at_rest(contact, self.config_of(contact, file, pose))
        rotation = np.array(from_quaternion(*quaternion))
        return rotation, np.append(middle[:2], ([x, y, z] + rotation @ contact.middle)[2])

    def at_rest(self, contact, config):
        """Pose (x y z, quaternion x y z w) of the one link of a configuration once it rests."""
        world = simulator("settles", self.motion.file, config, self.packages, str(self.folder))
        for _ in range(int(round(LONGEST / LOOK))):
            world.step(int(round(LOOK / world.time_step)))
            if np.linalg.norm(world.poses[0][:3] - config["robots"][0]["pose"]["xyz"]) > FARTHEST:
                break
            if np.abs(world.body_velocities[0]).max() < STILL:
                return world.poses[0].copy()
        raise InputError("%s: contacts.%s: settles: link '%s' does not come to rest within %g mm of where it is put down; choose a place on something, or"
                         " leave the key out" % (self.motion.file, contact.name, contact.link, 1e3 * FARTHEST))

    def config_of(self, contact, urdf, pose):
        """The configuration with nothing that moves but the link."""
        config = {key: copy.deepcopy(value) for key, value in self.config.items() if key not in ("robots", "objects", "sensors", "attachments")}
        row = {key: self.row[key] for key in ROBOT_KEYS if key in self.row}
        row.update(urdf=str(urdf), fixed_base=False, pose=pose, links={key: value for key, value in self.row.get("links", {}).items() if key == contact.link})
        config["robots"] = [row]
        return config

    def link_alone(self, contact):
        """URDF of a contact's link, the robot's weight on the middle of its points."""
        tree = ElementTree.parse(str(self.urdf)).getroot()
        link = next(each for each in tree.findall("link") if each.get("name") == contact.link)
        for element in list(link):
            if element.tag != "collision":
                link.remove(element)
        for mesh in link.iter("mesh"):
            if "://" not in mesh.get("filename"):
                mesh.set("filename", str((self.urdf.parent / mesh.get("filename")).resolve()))
        inertial, turning = ElementTree.SubElement(link, "inertial"), repr(self.model.mass * GYRATION ** 2)
        ElementTree.SubElement(inertial, "origin", xyz=" ".join(repr(float(x)) for x in contact.middle))
        ElementTree.SubElement(inertial, "mass", value=repr(self.model.mass))
        ElementTree.SubElement(inertial, "inertia", ixx=turning, iyy=turning, izz=turning, ixy="0", ixz="0", iyz="0")
        robot = ElementTree.Element("robot", name=contact.link)
        robot.append(link)
        robot.extend(each for each in tree.findall("gazebo") if each.get("reference") == contact.link)
        return ElementTree.tostring(robot, encoding="unicode")
