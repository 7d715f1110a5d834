"""The case that tests of sweeps take."""
import pytest

from sweep_case import SweepCase


@pytest.fixture
def case(tmp_path):
    return SweepCase(tmp_path)
