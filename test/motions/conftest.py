"""The case that tests of plan_motion take."""
import pytest
from motion_case import MotionCase


@pytest.fixture
def case(tmp_path):
    return MotionCase(tmp_path)
