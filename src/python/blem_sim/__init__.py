"""Simulations of robots in contact with meshes and clouds, and the messages of this package (blem_sim.msg, blem_sim.srv).

Simulator(config) is a simulation; bad input raises InputError, in one line. Both are loaded when they are first asked for, so that
programs that want messages alone load no simulator.
"""
import importlib

__all__ = ["Clearance", "InputError", "STEP_STATUS", "Simulator"]


def __getattr__(name):
    """One of __all__, from the extension module."""
    if name not in __all__:
        raise AttributeError("module 'blem_sim' has no attribute '%s'; it has %s" % (name, ", ".join(__all__)))
    try:
        simulator = importlib.import_module("blem_sim._simulator")
    except ModuleNotFoundError as error:
        raise ImportError("blem_sim.%s: blem_sim was built without its Python module; install pybind11-dev, python3-dev and python3-numpy, and "
                          "build again" % name) from error
    return globals().setdefault(name, getattr(simulator, name))


def __dir__():
    return sorted(set(globals()) | set(__all__))
