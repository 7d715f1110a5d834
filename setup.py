# For catkin_python_setup in cmake/python.cmake alone: the package blem_sim of Python, beside the generated messages. Not to be called by hand.
from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["blem_sim"], package_dir={"": "src/python"}))
