"""What scripts/validate_tosses identifies, from tosses of a known cube: free flights to a corner's touch, and behind any impulse there."""
import pathlib
import sys

import pytest

np = pytest.importorskip("numpy", reason="python3-numpy is not installed")

SUPPORT = pathlib.Path(__file__).resolve().parents[1] / "support"
sys.path[:0] = [str(SUPPORT), str(SUPPORT / "tosses")]
import toss_bounces  # noqa: E402
import toss_identification  # noqa: E402
import tosses as recorded  # noqa: E402
from tosses import RATE, SIDE, product, quaternion_of, rotated  # noqa: E402

SCALE, COM, INERTIA = 0.97, np.array([0.001, -0.002, 0.005]), 0.003  # of the recording; [m]; [m^2]
GRAVITY = np.array([0.0, 0.0, -9.81 * SCALE])
FLIGHT, SAMPLES = 0.2, 60
DEEP = 0.012  # [m] below the floor where the corner turns back, so that samples beside it show the touch


def toss(random):
    """Poses and first velocities of a toss that touches with one corner on its way and then flies on."""
    turn = quaternion_of(random.uniform(-2, 2, 3))
    spin = random.uniform(-4, 4, 3)
    at_touch = product(quaternion_of(FLIGHT * spin), turn)
    corners = rotated(at_touch, 0.5 * SCALE * SIDE * recorded.CORNERS - COM)
    corner = corners[corners[:, 2].argmin()]
    place = np.array([0.1, 0.2, -corner[2] - DEEP])  # of the centre of mass at the touch
    velocity = np.array([*random.uniform(-1, 1, 2), -1.5 - random.uniform()])
    kick = np.array([*random.uniform(-0.5, 0.5, 2), 3.5])  # impulse / mass: any law's
    later, later_spin = velocity + kick, spin + np.cross(corner, kick) / INERTIA
    poses = []
    for t in np.arange(SAMPLES) / RATE - FLIGHT:
        q = product(quaternion_of(t * (later_spin if t > 0 else spin)), at_touch)
        poses.append((place + t * (later if t > 0 else velocity) + 0.5 * t**2 * GRAVITY - rotated(q, COM), q))
    start = velocity - FLIGHT * GRAVITY - np.cross(spin, rotated(turn, COM))
    return poses, start, spin


@pytest.fixture(scope="module")
def tosses():
    random = np.random.RandomState(1)
    made = [toss(random) for _ in range(80)]
    position = np.array([[p for p, _ in poses] for poses, _, _ in made])
    turn = np.array([[q for _, q in poses] for poses, _, _ in made])
    rough = 0.02 * random.standard_normal((2, len(made), 3))
    velocity, spin = np.array([v for _, v, _ in made]), np.array([w for _, _, w in made])
    exact = toss_identification.Starts(position[:, 0], velocity, turn[:, 0], spin)
    return recorded.Tosses(position, turn, velocity + rough[0], spin + rough[1], np.full(len(made), SAMPLES)), exact


def test_flights_tell_scale_gravity_and_centre_of_mass(tosses):
    cube = toss_identification.identify_flight(tosses[0])
    assert cube.side == pytest.approx(SCALE * SIDE, rel=1e-6)
    assert cube.gravity == pytest.approx(GRAVITY, abs=1e-5)
    assert cube.com == pytest.approx(COM, abs=1e-7)


def test_bounces_tell_the_inertia_whatever_the_law(tosses):
    cube = toss_identification.identify_flight(tosses[0])
    inertia, bounces = toss_bounces.inertia_over_mass(tosses[0], cube)
    assert bounces >= 10
    assert inertia == pytest.approx(INERTIA, rel=1e-4)


def test_whole_flights_tell_the_start(tosses):
    cube = toss_identification.identify_flight(tosses[0])
    starts, exact = toss_identification.fitted_starts(*tosses[:1], cube), tosses[1]
    for name in ("position", "velocity", "turn", "spin"):
        assert np.abs(getattr(starts, name) - getattr(exact, name)).max() < 1e-5


def test_misses_of_a_known_shift_and_turn(tosses):
    truth = tosses[0]
    turned = product(quaternion_of(np.radians([0.0, 0.0, 3.0])), truth.turn)
    distance, angle = recorded.misses(truth, truth.position + np.array([0.01, 0, 0]), turned, 0.1)
    assert distance == pytest.approx(np.full(len(truth), 0.1))
    assert angle == pytest.approx(np.full(len(truth), 3.0))
