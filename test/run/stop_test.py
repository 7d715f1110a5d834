"""--stop: a run ends after the first step after which an expression holds."""
import random
import sys
import unittest

sys.path.insert(0, __file__.rsplit("/", 1)[0])
from run_scene import RunCase  # noqa: E402


class StopTest(RunCase):

    def stopped(self, *expressions):
        """Name and time of the stop, or None."""
        arguments = [word for expression in expressions for word in ("--stop", expression)]
        return self.report("world.yaml", "--duration", 0.05, *arguments).get("stopped")

    def test_the_first_that_holds_ends_the_run(self):
        report = self.report("world.yaml", "--duration", 0.3, "--stop", "late=time > 0.2", "--stop", "soon=time >= 0.0195")
        self.assertEqual((report["steps"], report["stopped"]["name"]), (20, "soon"))
        self.assertAlmostEqual(report["stopped"]["time_s"], 0.02, places=9)
        whole = self.report("world.yaml", "--duration", 0.02)
        self.assertNotIn("stopped", whole)
        self.assertEqual(report["state_hash"], whole["state_hash"])

    def test_operators_and_names(self):
        for holds in ("1 + 2 * 3 == 7", "(1 + 2) * 3 == 9", "7 - 2 - 1 == 4", "8 / 2 / 2 == 2", "not 1 > 2", "0 or 1 and 1", "-abs(-2) < -1",
                      "sqrt(9) == 3", "not sqrt(-1) <= 1", "cube::link.z < 0.09 and cube::link.z > 0.05",
                      "1e-3 + 1e+3 > 1000", "1 <= 1 and 1 >= 1 and 1 != 2 and not (1 < 1 or 1 > 1 or 1 != 1 or 1 == 2 or 2 <= 1)", "min(2, 1) == 1 and max(2, 1) == 2",
                      "base_contact.force_z > 1",
                      '"arm::shoulder.position" > 0', "abs(cube::link.yaw - 0.3) < 0.1", "STATE_NOT_FINITE == 0"):
            self.assertIsNotNone(self.stopped("it=" + holds), holds)
        for fails in ("0", "1 > 2", "sqrt(-1)", "sqrt(-1) == sqrt(-1)", "(1 or 1) and 0", "cube::link.speed < 0"):
            self.assertIsNone(self.stopped("it=" + fails), fails)

    def test_bad_expressions_are_refused_in_one_line(self):
        self.assertIn("the nearest known name is 'cube::link.z'", self.refusal("world.yaml", "--stop", "low=cube::lnk.z < 1"))
        for bad in ("", "1 +", "(1", "1)", "1 2", "1..2 < 3", '"arm', "abs 1", "max(1)", "1e+", "(" * 500, "- " * 500 + "1", "1" + "+1" * 500):
            self.assertIn("--stop it", self.refusal("world.yaml", "--stop", "it=" + bad))

    def test_refused_stops_leave_the_table_of_an_earlier_run(self):
        table = self.write("rows.csv", "kept")
        self.refusal("world.yaml", "--csv", table, "--stop", "it=nothing > 1")
        with open(table) as stream:
            self.assertEqual(stream.read(), "kept")
        self.assertIn("given twice", self.refusal("world.yaml", "--stop", "it=1", "--stop", "it=0"))

    def test_garbage_is_refused_or_read(self):
        dice = random.Random(7)
        for _ in range(40):
            text = "".join(dice.choice(["(", ")", "time", "1", "+", "-", "<", "not ", " and ", '"', "abs", "\u00e9", "$"]) for _ in range(8))
            done = self.run_program("world.yaml", "--duration", 0.002, "--stop", "it=" + text)
            self.assertIn(done.returncode, (0, 2), text)
            self.assertLessEqual(len(done.stderr.strip().splitlines()), 1, text)


if __name__ == "__main__":
    unittest.main()
