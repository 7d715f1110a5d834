"""Input that the Python module refuses: one line that names the field, a simulator that goes on as if nothing had been asked."""
import sys
import unittest

import numpy

sys.path.insert(0, __file__.rsplit("/", 1)[0])
from simulator_case import SimulatorCase, blem_sim  # noqa: E402

NAN = float("nan")
# Call on a simulator of the world -> a part of its refusal.
CALLS = [
    (lambda s: s.step(-1), "give 0 or more"),
    (lambda s: s.command("nobody", [0, 0]), "there is arm"),
    (lambda s: s.command("arm", [0]), "1 numbers for 2 joints"),
    (lambda s: s.command("arm", [[0, 0]]), "1 dimension"),
    (lambda s: s.command("arm", "up"), "positions: must be numbers"),
    (lambda s: s.command("arm", [0, NAN]), "arm"),
    (lambda s: s.command("arm", [0], joints=["knee"]), "knee"),
    (lambda s: s.command("arm", [0], joints="elbow"), "joints: must be a list of names"),
    (lambda s: s.command_trajectory("arm", [1, 2], [[0, 0]]), "give one for each"),
    (lambda s: s.command_trajectory("arm", [2, 1], [[0, 0], [0, 0]]), "arm"),
    (lambda s: s.set_joint_positions("arm", [NAN, 0]), "shoulder"),
    (lambda s: s.apply_effort("knee", 1), "knee"),
    (lambda s: s.apply_effort("elbow", NAN), "effort"),
    (lambda s: s.apply_wrench("cub", [0, 0, 1]), "cub"),
    (lambda s: s.apply_wrench("ground", [0, 0, 1]), "ground"),
    (lambda s: s.apply_wrench("cube::link", [0, 1]), "force: must be three numbers"),
    (lambda s: s.apply_wrench("cube::link", [0, 0, NAN]), "finite"),
    (lambda s: s.sensor_fields("nose"), "there is shoulder_wrench"),
    (lambda s: s.restore(b"garbage"), "state"),
    (lambda s: s.restore(s.save()[:-8]), "state"),
]


class RefusedInputTest(SimulatorCase):

    def refusal(self, call):
        with self.assertRaises(blem_sim.InputError) as caught:
            call()
        self.assertEqual(len(str(caught.exception).splitlines()), 1, caught.exception)
        return str(caught.exception)

    def test_calls(self):
        simulation, untouched = self.world(), self.world()
        for call, part in CALLS:
            simulation.step(2)
            untouched.step(2)
            self.assertIn(part, self.refusal(lambda: call(simulation)))
            self.assertEqual(simulation.state_hash(), untouched.state_hash(), part)

    def test_state_of_another_world(self):
        self.refusal(lambda: self.world().restore(self.cube(1).save()))

    def test_configurations(self):
        (self.folder / "bad.yaml").write_text("time_step: 0.001\ngravty: [0, 0, 0]\n")
        itself = []
        itself.append(itself)
        for config, part in (
                (str(self.folder / "missing.yaml"), "missing.yaml: cannot be read"),
                (self.folder / "bad.yaml", "bad.yaml:2: gravty: unknown key; the nearest known one is 'gravity'"),
                ("time_step: 0.001\ngravty: 1\n", "configuration:2: gravty"),
                ("{a: [}", "configuration:1: is not YAML"),
                ({"gravty": 1}, "'gravity'"),
                ({"time_step": numpy.float64(-1)}, "time_step"),
                ({"objects": [{"name": object()}]}, "objects[0].name: must be a number"),
                ({1: 2}, "a key must be a text"),
                ({"objects": itself}, "does it hold itself?"),
                ({"objects": [{"name": "a", "uri": "nothing.off", "mass": 1}]}, "nothing.off"),
                ({"environments": [{"name": "live", "topic": "/points"}]}, "blem_sim_node"),
                (3, "must be a path")):
            self.assertIn(part, self.refusal(lambda: blem_sim.Simulator(config)))
        self.assertIn("settings", self.refusal(lambda: blem_sim.Simulator({}, settings=[1])))
        self.assertIn("packages", self.refusal(lambda: blem_sim.Simulator({}, packages=3)))


if __name__ == "__main__":
    unittest.main()
