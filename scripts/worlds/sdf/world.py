"""The world of an SDF file as blem_sim's configuration, and the files that it names."""
import yaml

from sdf.elements import InputError, number, numbers, read_file, text, truth, version_of
from sdf.files import included
from sdf.model import WORLD, Reader
from sdf.poses import angles, pose, tidy
from sdf.shapes import Mesh, parts_of, shape_of
from sdf.urdf import KINDS, UrdfWriter, mesh_uri, restitution_of, shifted, surface_of, surfaces_of

READ = {"model", "include", "physics", "gravity", "state"}
SOFTEST_RIGID = 1e6  # [N/m] from which surfaces are rigid


def pose_entry(X):
    return {"xyz": tidy(X[:3, 3]), "rpy": tidy(angles(X))}


def components_of(model):
    """Links that hang together: (root, joints from the root on, whether the world holds the root). Raises InputError for a loop."""
    held = {joint.child: joint for joint in reversed(model.joints)}
    for joint in model.joints:
        where = "model '%s', joint '%s'" % (model.name, joint.name)
        if joint.kind not in KINDS:
            raise InputError("%s: type '%s' is not read; write revolute, continuous, prismatic or fixed" % (where, joint.kind))
        for end in (joint.parent, joint.child):
            if end != WORLD and end not in model.links:
                raise InputError("%s: there is no link '%s'; name one of the model" % (where, end))
        if joint.child == WORLD or held[joint.child] is not joint:
            raise InputError("%s: closes a loop, which is not read; leave it out" % where)
    children = {}
    for joint in model.joints:
        children.setdefault(joint.parent, []).append(joint)

    def below(link):
        joints = []
        for joint in children.get(link, []):
            joints += [joint] + below(joint.child)
        return joints

    components = [(link, below(link), False) for link in model.links if link not in held]
    for joint in children.get(WORLD, []):
        if joint.kind == "fixed":
            components.append((joint.child, below(joint.child), True))
        else:
            components.append((WORLD, [joint] + below(joint.child), True))
    if sum(len(joints) + (root != WORLD) for root, joints, _ in components) != len(model.links):
        raise InputError("model '%s': its joints go round in a circle; leave one out" % model.name)
    return components


class World:
    """entries: the configuration; its files lie in a folder."""

    def __init__(self, folder, folders, report):
        self.folder, self.folders, self.report = folder, folders, report
        self.entries = {"contact": {"friction": 1.0}, "environments": [], "objects": [], "robots": []}
        self.names = set()

    def read(self, path):
        """Raises InputError if the file is no SDF; what it holds that cannot be read is told to the report."""
        root, beside = read_file(path), path.resolve().parent
        world = root.find("world")
        within = root if world is None else world
        if not len(within):
            raise InputError("%s: has no <world> and no <model>; give a file that has one" % path)
        if world is not None:
            self._read_settings(world)
        states = {model.get("name"): model for model in within.findall("state/model")}
        for element in within:
            if element.tag == "model":
                self._read_model(element, version_of(root), beside, None, element, states)
            elif element.tag == "include":
                self._read_include(element, beside, states)
        others = sorted({element.tag for element in within} - READ)
        if others:
            self.report.note("not read: %s" % ", ".join("<%s>" % tag for tag in others))

    def _read_settings(self, world):
        physics = world.find("physics")
        step = number(physics, "max_step_size", 0.001, "<physics>")
        rate = number(physics, "real_time_update_rate", 1000.0, "<physics>")
        gravity = text(world, "gravity") or text(physics, "gravity")
        self.entries = {"time_step": step, "real_time_factor": round(step * rate, 9),
                        "gravity": numbers(gravity, 3, "<gravity>") if gravity else [0.0, 0.0, -9.8], **self.entries}

    def _read_include(self, include, beside, states):
        try:
            root, element, folder = included(include, self.folders, beside)
        except InputError as error:
            return self.report.leave_out(str(error))
        if element is not None:
            placed = include if include.find("pose") is not None else element
            self._read_model(element, version_of(root), folder, text(include, "name"), placed, states, truth(include, "static"))

    def _read_model(self, element, version, folder, name, placed, states, static=False):
        """placed: the element whose <pose> tells where the model is, unless the world's state does."""
        try:
            model = Reader(self.folders).read(element, version, folder, name)
            self._take_place(model, placed, states)
            if model.static or static:
                self._add_environments(model)
            else:
                for root, joints, held in components_of(model):
                    self._add_moving(model, root, joints, held)
        except InputError as error:
            self.report.leave_out(str(error))

    def _take_place(self, model, placed, states):
        state = states.get(model.name)
        given = state if state is not None and state.find("pose") is not None else placed
        model.X_WM = pose(given, "model '%s'" % model.name)
        if state is not None and len(model.links) > 1 and not model.static:
            self.report.note("model '%s': its <state> places the model; joints start where the links' poses have them" % model.name)

    def _own_name(self, name):
        own, count = name, 1
        while own in self.names:
            own, count = "%s_%d" % (name, count), count + 1
        if own != name:
            self.report.note("model '%s': the name is there twice; the later one is called '%s'" % (name, own))
        self.names.add(own)
        return own

    def _add_moving(self, model, root, joints, held):
        parts = len(model.links) - len(joints) > 1
        name = self._own_name(model.name if not parts or root == WORLD else "%s__%s" % (model.name, root))
        path = self.folder / "urdf" / (name.replace("/", "_") + ".urdf")
        path.parent.mkdir(parents=True, exist_ok=True)
        UrdfWriter(model, self.folders, self.report).write(name, root, joints, path)
        X_WR = model.X_WM if root == WORLD else model.X_WM @ model.links[root].X_ML
        entry = {"name": name, "urdf": "urdf/" + path.name, "pose": pose_entry(X_WR)}
        bounces = {link: restitution for link, restitution in self._restitutions(model, root, joints).items() if restitution > 0}
        if not joints and not held and not model.plugins and is_plain(model.links[root]):
            self.entries["objects"].append({**entry, **({"restitution": bounces[root]} if bounces else {})})
            return
        entry.update({"fixed_base": True} if held else {})
        entry["motors"] = "free"
        if bounces:
            entry["links"] = {link: {"restitution": restitution} for link, restitution in bounces.items()}
        self.entries["robots"].append(entry)

    def _restitutions(self, model, root, joints):
        result = {}
        for link in [root] * (root != WORLD) + [joint.child for joint in joints]:
            found = [restitution_of(collision, "link '%s'" % link) for collision in model.links[link].element.findall("collision")]
            result[link] = max(found, default=0.0)
        return result

    def _add_environments(self, model):
        """Boxes, cylinders and spheres of one surface are one mesh, which has the model's name."""
        meshes = []
        for link in model.links.values():
            if link.element.find("sensor") is not None:
                self.report.note("model '%s': sensors of what is static are not read" % model.name)
            for collision in link.element.findall("collision"):
                where = "model '%s', link '%s', collision '%s'" % (model.name, link.name, collision.get("name"))
                try:
                    self._add_collision(model, link, collision, where, meshes)
                except InputError as error:
                    self.report.leave_out(str(error))
        for surface, mesh in meshes:
            name = self._own_name(model.name)
            path = self.folder / "meshes" / (name.replace("/", "_") + ".off")
            path.parent.mkdir(parents=True, exist_ok=True)
            mesh.write(path)
            self.entries["environments"].append({"name": name, "uri": "meshes/" + path.name, "pose": pose_entry(model.X_WM), **surface})

    def _add_collision(self, model, link, collision, where, meshes):
        X_ML = link.X_ML @ pose(collision, where)
        surface = environment_surface(collision, where)
        plane = collision.find("geometry/plane")
        if plane is not None:
            X = model.X_WM @ X_ML
            normal = X[:3, :3] @ numbers(text(plane, "normal", "0 0 1"), 3, where + ": <normal>")
            name = self._own_name(model.name)
            self.entries["environments"].append({"name": name, "plane": tidy([*normal, normal @ X[:3, 3]]), **surface})
            return
        shape = shape_of(collision.find("geometry"), where)
        if shape.tag == "mesh":
            entry = {"uri": self.folders.file_of(mesh_uri(shape, where), link.folder, where), "pose": pose_entry(model.X_WM @ X_ML)}
            if text(shape, "scale"):
                entry["scale"] = numbers(text(shape, "scale"), 3, where + ": <scale>")
            self.entries["environments"].append({"name": self._own_name(model.name), **entry, **surface})
            return
        parts = parts_of(shape, where)
        mesh = next((mesh for other, mesh in meshes if other == surface), None)
        if mesh is None:
            mesh = Mesh()
            meshes.append((surface, mesh))
        for name, sizes, height in parts:
            mesh.add(name, sizes, X_ML @ shifted(height))

    def write(self, source):
        """Writes world.yaml, and returns its path. source: name of the file that it was made of."""
        robots = self.entries["robots"]
        for robot in robots if len(robots) > 1 else []:
            robot["namespace"] = robot["name"]
        path = self.folder / "world.yaml"
        self.folder.mkdir(parents=True, exist_ok=True)
        kept = {key: value for key, value in self.entries.items() if value != []}
        lines = ["# Made of %s by world_from_sdf. config/default.yaml has all that may be written here." % source]
        lines.append(yaml.safe_dump(kept, sort_keys=False, default_flow_style=None, width=150, allow_unicode=True))
        path.write_text("\n".join(lines), encoding="utf-8")
        return path


def is_plain(link):
    """Whether an object can be made of it: it has no sensor, and one surface."""
    return link.element.find("sensor") is None and len(surfaces_of(link)) < 2


def environment_surface(collision, where):
    """Contact settings of an environment."""
    given = surface_of(collision, where)
    surface = {"friction": given["mu1"]}
    if given.get("kp", SOFTEST_RIGID) < SOFTEST_RIGID:
        surface["stiffness"] = given["kp"]
        surface["damping"] = given.get("kd", 1.0)
    restitution = restitution_of(collision, where)
    if restitution > 0:
        surface["restitution"] = restitution
    return surface
