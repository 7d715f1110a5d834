"""Poses: matrices of 4 x 4 that turn and shift points of one frame into another [m]."""
import math

import numpy as np

from sdf.elements import InputError, numbers

SAME = 1e-9  # [m, rad] below which poses are alike


def rotation(roll, pitch, yaw):
    """Matrix of 3 x 3; angles [rad] about fixed axes."""
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (math.cos, math.sin))
    return np.array([[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                     [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
                     [-sp, cp * sr, cp * cr]])


def rotation_of_quaternion(x, y, z, w, where):
    length = math.sqrt(x * x + y * y + z * z + w * w)
    if length < SAME:
        raise InputError("%s: a quaternion of zeros is no rotation; write 0 0 0 1" % where)
    x, y, z, w = x / length, y / length, z / length, w / length
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def pose(element, where):
    """The pose that an element's <pose> tells, in the frame it is relative to; identity without one. Raises InputError."""
    result = np.eye(4)
    found = element.find("pose") if element is not None else None
    if found is None or not (found.text or "").strip():
        return result
    where = where + ": <pose>"
    if found.get("rotation_format") == "quat_xyzw":
        values = numbers(found.text, 7, where)
        result[:3, :3] = rotation_of_quaternion(*values[3:], where=where)
    else:
        values = numbers(found.text, 6, where)
        unit = math.pi / 180 if found.get("degrees") in ("true", "1") else 1
        result[:3, :3] = rotation(*(unit * angle for angle in values[3:]))
    result[:3, 3] = values[:3]
    return result


def relative_to(element):
    """Name of the frame that an element's <pose> is relative to; empty: the default one."""
    found = element.find("pose")
    return "" if found is None else found.get("relative_to", found.get("frame", ""))


def angles(matrix):
    """Roll, pitch, yaw [rad] about fixed axes."""
    pitch = math.asin(max(-1.0, min(1.0, -matrix[2, 0])))
    if abs(matrix[2, 0]) > 1 - 1e-12:
        return [0.0, pitch, math.atan2(-matrix[0, 1], matrix[1, 1])]
    return [math.atan2(matrix[2, 1], matrix[2, 2]), pitch, math.atan2(matrix[1, 0], matrix[0, 0])]


def inverse(matrix):
    result = np.eye(4)
    result[:3, :3] = matrix[:3, :3].T
    result[:3, 3] = -matrix[:3, :3].T @ matrix[:3, 3]
    return result


def is_identity(matrix):
    return bool(np.abs(matrix - np.eye(4)).max() < SAME)


def tidy(values):
    """Numbers to a billionth, without minus zero."""
    return [round(float(value), 9) + 0.0 for value in values]
