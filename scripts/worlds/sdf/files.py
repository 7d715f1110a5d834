"""Where models and meshes lie that SDF names by URI."""
import os
import pathlib
from xml.etree import ElementTree

from sdf.elements import InputError, parse, read_file, text, version_of

MODEL_SCHEMES = ("model://", "models://")
# Models that nearly every world includes, for computers without Gazebo.
OWN = {"sun": "<light/>",
       "ground_plane": """<model name="ground_plane"><static>1</static><link name="link"><collision name="collision">
         <geometry><plane><normal>0 0 1</normal></plane></geometry>
         <surface><friction><ode><mu>100</mu><mu2>50</mu2></ode></friction></surface></collision></link></model>"""}


class Folders:
    """Folders with Gazebo's models: those given, then GAZEBO_MODEL_PATH, then ~/.gazebo/models and Gazebo's own."""

    def __init__(self, given):
        named = [folder for folder in os.environ.get("GAZEBO_MODEL_PATH", "").split(":") if folder]
        own = sorted(pathlib.Path("/usr/share").glob("gazebo*/models"), reverse=True)
        self.all = [pathlib.Path(folder).expanduser().resolve() for folder in [*given, *named, "~/.gazebo/models", *own]]

    def find(self, path):
        """The file or folder of a path below one of them, or None."""
        return next((folder / path for folder in self.all if path and (folder / path).exists()), None)

    def file_of(self, uri, beside, where):
        """What blem_sim is to be told of a mesh's URI: package:// as it is, others as a file. Raises InputError.

        beside: folder of the file that names it."""
        if uri.startswith("package://"):
            return uri
        for scheme in MODEL_SCHEMES:
            if uri.startswith(scheme):
                found = self.find(uri[len(scheme):])
                break
        else:
            found = (pathlib.Path(beside) / (uri[len("file://"):] if uri.startswith("file://") else uri)).resolve()
        if found is None or not found.is_file():
            raise InputError("%s: '%s' is not there; give the folder of its model by --models" % (where, uri))
        return "file://%s" % found

    def model_file(self, uri, beside):
        """The SDF file of a model's URI. Raises InputError."""
        scheme = next((scheme for scheme in MODEL_SCHEMES if uri.startswith(scheme)), "")
        folder = self.find(uri[len(scheme):].rstrip("/")) if scheme else pathlib.Path(beside) / uri.replace("file://", "", 1)
        if folder is None or not folder.exists():
            raise InputError("<include>: '%s' is in none of the folders of models; give its folder by --models" % uri)
        return folder if folder.is_file() else file_in(folder)


def file_in(folder):
    """The newest SDF that the model.config of a folder names."""
    config = folder / "model.config"
    if not config.is_file():
        config = folder / "manifest.xml"
    if not config.is_file() and (folder / "model.sdf").is_file():
        return folder / "model.sdf"
    root = parse(config)
    versions = [(version_of(sdf), (sdf.text or "").strip()) for sdf in root.iter("sdf")]
    if not versions:
        raise InputError("%s: has no <sdf>; name the model's file there" % config)
    return folder / max(versions)[1]


def included(include, folders, beside):
    """Root, model and folder of what an <include> names; the model is None for a light or an actor. Raises InputError."""
    uri = text(include, "uri")
    if not uri:
        raise InputError("<include>: has no <uri>; name a model")
    name = uri.rpartition("://")[2].strip("/")
    if uri.startswith(MODEL_SCHEMES) and name in OWN and folders.find(name) is None:
        root = ElementTree.fromstring("<sdf>%s</sdf>" % OWN[name])
        return root, root.find("model"), beside
    path = folders.model_file(uri, beside)
    root = read_file(path)
    return root, root.find("model"), path.parent
