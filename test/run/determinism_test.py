"""Same input, same bits: in two runs, and in a run that goes on from a saved state."""
import sys
import unittest

sys.path.insert(0, __file__.rsplit("/", 1)[0])
from run_scene import RunCase  # noqa: E402


class DeterminismTest(RunCase):

    def hash(self, *arguments):
        return self.report("world.yaml", *arguments)["state_hash"]

    def test_two_runs(self):
        first = self.report("world.yaml", "--duration", 0.5, "--trajectory", "motion.csv")
        second = self.report("world.yaml", "--duration", 0.5, "--trajectory", "motion.csv")
        for key in ("state_hash", "bodies", "joints", "sensors", "contacts", "max_penetration", "energy_J"):
            self.assertEqual(first[key], second[key])
        self.assertRegex(first["state_hash"], "^[0-9a-f]{16}$")

    def test_a_run_from_a_saved_state(self):
        whole = self.hash("--duration", 0.5, "--trajectory", "motion.csv")
        half = self.hash("--duration", 0.2, "--trajectory", "motion.csv", "--save-state", "half.state")
        again = self.hash("--duration", 0.3, "--load-state", "half.state")
        self.assertEqual(whole, again)
        self.assertNotEqual(whole, half)

    def test_a_saved_state_is_the_same_state(self):
        saved = self.hash("--duration", 0.1, "--save-state", "a.state")
        loaded = self.hash("--duration", 0, "--load-state", "a.state", "--save-state", "b.state")
        self.assertEqual(saved, loaded)
        self.assertEqual((self.folder / "a.state").read_bytes(), (self.folder / "b.state").read_bytes())

    def test_other_input_gives_another_hash(self):
        base = self.hash("--duration", 0.1)
        self.assertNotEqual(base, self.hash("--duration", 0.1, "--seed", 2))
        self.assertNotEqual(base, self.hash("--duration", 0.1, "--set", "objects.0.mass=1.1"))
        self.assertNotEqual(base, self.hash("--duration", 0.101))


if __name__ == "__main__":
    unittest.main()
