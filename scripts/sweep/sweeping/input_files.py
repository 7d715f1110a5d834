"""Files that a run reads, so that it is run again when one of them has changed: configuration, trajectory, URDFs, meshes and clouds."""
import functools
import hashlib
import os
import pathlib
import re

from sweeping.checked_yaml import InputError, read_yaml

NAMED = ("uri", "urdf")  # keys whose values are files
IN_URDF = re.compile(r"""filename\s*=\s*["']([^"']+)["']""")


class InputFiles:
    """Digests of what a configuration reads. Files that cannot be found count as missing: the run will say so."""

    def __init__(self, sweep):
        self.sweep = sweep
        self.configured = read_yaml(sweep.config)
        if not isinstance(self.configured, dict):
            raise InputError("%s: the configuration is no map; write KEY: VALUE" % sweep.config)
        self.base = str(pathlib.Path(sweep.config).parent)

    def digest(self, values):
        """Of the files that a run with these parameter values reads."""
        names = sorted(set(named_files(self.configured)) | set(named_files(values)) | {
            value for name, value in values.items() if name.split(".")[-1] in NAMED and isinstance(value, str)})
        return self.digest_of(tuple(names))

    @functools.lru_cache(maxsize=None)
    def digest_of(self, names):
        fixed = [digest_of_file(path) for path in (self.sweep.config, self.sweep.trajectory) if path]
        return hashlib.sha256(repr(fixed + [self.digest_of_named(name, self.base) for name in names]).encode()).hexdigest()

    @functools.lru_cache(maxsize=None)
    def digest_of_named(self, name, base):
        path = resolved(name, base, self.sweep.packages)
        digests = [name, digest_of_file(path)]
        if path and path.endswith((".urdf", ".xml")) and digests[1]:
            with open(path, encoding="utf-8", errors="replace") as stream:
                meshes = sorted(set(IN_URDF.findall(stream.read())))
            digests += [(mesh, digest_of_file(resolved(mesh, str(pathlib.Path(path).parent), self.sweep.packages))) for mesh in meshes]
        return digests


def resolved(name, base, packages):
    """The file of a name or URI, or None. @param base folder of the file that names it @param packages {name: folder} beside ROS_PACKAGE_PATH"""
    if name.startswith("file://"):
        return name[len("file://"):]
    if not name.startswith("package://"):
        return str(pathlib.Path(base) / name)
    package, _, rest = name[len("package://"):].partition("/")
    folder = packages.get(package) or package_folder(package)
    return str(pathlib.Path(folder) / rest) if folder else None


def named_files(value):
    """All files that a configuration names."""
    if isinstance(value, list):
        return [name for item in value for name in named_files(item)]
    if not isinstance(value, dict):
        return []
    return [name for key, item in value.items() for name in ([item] if key in NAMED and isinstance(item, str) else named_files(item))]


@functools.lru_cache(maxsize=None)
def package_folder(package):
    """Folder of a ROS package on ROS_PACKAGE_PATH, or None."""
    for root in filter(None, os.environ.get("ROS_PACKAGE_PATH", "").split(":")):
        for folder in (pathlib.Path(root), pathlib.Path(root) / package):
            if folder.name == package and (folder / "package.xml").is_file():
                return str(folder)
        named = re.compile(r"<name>\s*%s\s*</name>" % re.escape(package))
        manifest = pathlib.Path(root) / "package.xml"
        if manifest.is_file() and named.search(manifest.read_text(encoding="utf-8", errors="replace")):
            return root
    return None


def digest_of_file(path):
    """SHA-256 of a file's bytes, or None if it cannot be read."""
    if path is None:
        return None
    total = hashlib.sha256()
    try:
        with open(path, "rb") as stream:
            for block in iter(lambda: stream.read(1 << 20), b""):
                total.update(block)
    except OSError:
        return None
    return total.hexdigest()
