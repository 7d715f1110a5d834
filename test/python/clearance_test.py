"""Gaps of a robot in poses that are not at hand, against closed forms."""
import sys
import unittest

import numpy

sys.path.insert(0, __file__.rsplit("/", 1)[0])
from simulator_case import SimulatorCase, blem_sim  # noqa: E402

LAYER = 0.0025  # [m] of each link, the default
BOX = """<link name="%s"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>"""
HINGE = """<joint name="%s%s" type="continuous"><parent link="%s"/><child link="%s"/><origin xyz="0.2 0 0"/><axis xyz="0 0 1"/></joint>"""
CHAIN = "<robot name='chain'>%s</robot>" % "\n".join([BOX % link for link in "abc"] + [HINGE % (a, b, a, b) for a, b in ("ab", "bc")])


def at(*places):
    """Poses of links that stand upright at (x, z)."""
    return [[x, 0, z, 0, 0, 0, 1] for x, z in places]


class ClearanceTest(SimulatorCase):
    """Three boxes of 0.1 m, 0.2 m from one another, as a chain of two hinges above the ground."""

    def setUp(self):
        super(ClearanceTest, self).setUp()
        (self.folder / "chain.urdf").write_text(CHAIN)
        self.simulation = self.chain()
        self.clearance = self.simulation.clearance("chain")

    def chain(self, **keys):
        robot = dict({"name": "chain", "urdf": "chain.urdf", "pose": {"xyz": [0, 0, 1]}}, **keys)
        return blem_sim.Simulator({"environments": [{"name": "ground", "plane": [0, 0, 1, 0]}], "robots": [robot]}, folder=self.folder)

    def only(self, poses, distance):
        """The one pair that is near, with the names of both."""
        found = self.clearance.find(poses, distance)
        self.assertEqual(len(found), 1, found)
        return found[0], self.clearance.colliders[found[0]["a"]], self.clearance.colliders[found[0]["b"]]

    def test_gap_to_the_ground_is_that_between_the_layers(self):
        row, a, b = self.only(at((0, 1), (0.2, 1), (0.4, 0.07)), 0.05)
        self.assertEqual((a, b), ("chain::c", "ground"))
        self.assertAlmostEqual(row["gap"], 0.02 - LAYER, 9)
        numpy.testing.assert_allclose(row["normal"], [0, 0, 1], atol=1e-9)
        self.assertFalse(row["crossed"])

    def test_links_of_a_robot_are_told_of_though_they_do_not_touch_in_the_simulation(self):
        row, a, b = self.only(at((0, 1), (0.2, 1), (0.12, 1)), 0.05)
        self.assertEqual((a, b), ("chain::a", "chain::c"), "b hangs on both")
        self.assertAlmostEqual(row["gap"], 0.02 - 2 * LAYER, 9)

    def test_meshes_that_cross_are_told(self):
        row, _, _ = self.only(at((0, 1), (0.2, 1), (0.09, 1)), 0)
        self.assertTrue(row["crossed"])
        self.assertLess(row["gap"], -2 * LAYER)

    def test_what_is_farther_away_is_not_told(self):
        self.assertEqual(len(self.clearance.find(at((0, 1), (0.2, 1), (0.4, 0.2)), 0.1)), 0)

    def test_listed_pairs_are_left_out(self):
        clearance = self.chain(disable_collisions=[["a", "c"]]).clearance("chain")
        self.assertEqual(len(clearance.find(at((0, 1), (0.2, 1), (0.12, 1)), 0.05)), 0)

    def test_questions_leave_the_simulation_alone(self):
        before = self.simulation.state_hash()
        self.clearance.find(at((0, 0.05), (0.2, 1), (0.1, 1)), 1)
        self.assertEqual(self.simulation.state_hash(), before)

    def test_other_numbers_are_refused(self):
        for poses, distance in ((at((0, 1)), 0.1), (at((0, 1), (0, 1), (0, 1)), -1), ([[0] * 6] * 3, 0.1), ([[0] * 7] * 3, 0.1)):
            with self.assertRaises(blem_sim.InputError):
                self.clearance.find(poses, distance)
        with self.assertRaises(blem_sim.InputError):
            self.simulation.clearance("chian")


if __name__ == "__main__":
    unittest.main()
