"""Bad input: exit status 2 and one line that names file, field and cure."""
import os
import subprocess
import sys
import unittest

sys.path.insert(0, __file__.rsplit("/", 1)[0])
from run_scene import RunCase, arm_urdf  # noqa: E402


class BadInputTest(RunCase):

    def assert_refused(self, words, *arguments):
        line = self.refusal(*(arguments or ("world.yaml", "--duration", 0.01)))
        for word in words:
            self.assertIn(word, line)

    def test_command_line(self):
        self.assert_refused(["--durations", "unknown option"], "world.yaml", "--durations", 1)
        self.assert_refused(["--duration", "'soon'"], "world.yaml", "--duration", "soon")
        self.assert_refused(["--duration", "'-1'"], "world.yaml", "--duration", "-1")
        self.assert_refused(["--seed", "missing"], "world.yaml", "--seed")
        self.assert_refused(["--set", "NAME=VALUE"], "world.yaml", "--set", "gravity")
        self.assert_refused(["CONFIG.yaml"], "--duration", 1)
        self.assert_refused(["none.yaml", "cannot be read"], "none.yaml")
        self.assert_refused([".", "is a folder"], ".")

    def test_empty_values(self):
        for option in ("--report", "--csv", "--trajectory", "--save-state", "--load-state"):
            self.assert_refused([option, "is empty"], "world.yaml", "--duration", 0.001, option, "")

    def test_settings(self):
        self.assert_refused(["contact.frction", "'friction'"], "world.yaml", "--set", "contact.frction=1")
        self.assert_refused(["robots.1", "item"], "world.yaml", "--set", "robots.1.name=b")
        self.assert_refused(["time_step.x", "below"], "world.yaml", "--set", "time_step.x=1")
        self.assert_refused(["time_step", "'fast'"], "world.yaml", "--set", "time_step=fast")

    def test_unknown_key(self):
        self.write("world.yaml", "robots:\n  - name: arm\n    urdf: arm.urdf\n    gians: {}\n")
        self.assert_refused(["world.yaml:4", "robots[0].gians", "'gains'"])

    def test_topic(self):
        self.write("world.yaml", "environments:\n  - {name: live, topic: /points}\n")
        self.assert_refused(["live", "topic", "/points", "blem_sim_node", ".pcd"])

    def test_not_yaml(self):
        self.write("world.yaml", "robots: [\n")
        self.assert_refused(["world.yaml", "not YAML"])

    def test_urdf_that_is_not_xml(self):
        self.write("arm.urdf", "this is no robot")
        self.assert_refused(["arm.urdf"])

    def test_urdf_missing(self):
        (self.folder / "arm.urdf").unlink()
        self.assert_refused(["arm.urdf"])

    def test_mesh_missing(self):
        self.write("arm.urdf", arm_urdf(shape='<mesh filename="package://nowhere/upper.stl"/>'))
        self.assert_refused(["nowhere", "--package"])
        self.write("arm.urdf", arm_urdf())
        (self.folder / "cube.off").unlink()
        self.assert_refused(["cube", "cube.off"])

    def test_mesh_broken(self):
        self.write("cube.off", "OFF\n8 12 0\n0 0 0\n")
        self.assert_refused(["cube.off"])

    def test_masses(self):
        for mass in (0, -1):
            self.write("arm.urdf", arm_urdf(mass=mass))
            self.assert_refused(["upper", "mass"])
        self.write("arm.urdf", arm_urdf())
        self.assert_refused(["objects[0].mass"], "world.yaml", "--set", "objects.0.mass=-2")

    def test_names_that_the_robot_does_not_have(self):
        for setting, name in (("robots.0.gains.wirst.p", "wirst"), ("robots.0.initial_positions.elbwo", "elbwo"),
                              ("robots.0.links.uper.friction", "uper"), ("robots.0.effort_limits.elbwo", "elbwo")):
            self.assert_refused([name], "world.yaml", "--duration", 0, "--set", setting + "=1")
        self.assert_refused(["wrist"], "world.yaml", "--duration", 0, "--set", "robots.0.sensors.0.joint=wrist")

    def test_node_only_settings(self):
        self.assert_refused(["topic"], "world.yaml", "--set", "environments.0={name: live, topic: /points}")
        self.assert_refused(["description"], "world.yaml", "--set", "robots.0={name: arm, description_param: robot_description}")

    def test_trajectories(self):
        for text, words in (
            ("time,shoulder\n0,0\n1,nan\n", ["motion.csv:3", "'nan'"]),
            ("time,wrist\n0,0\n", ["motion.csv", "'wrist'"]),
            ("milestone,shoulder\n0,0\n", ["motion.csv", "'time'"]),
            ("time,shoulder\n1,0\n1,0\n", ["motion.csv", "increase"]),
            ("time,shoulder\n", ["motion.csv", "no rows"]),
        ):
            self.write("motion.csv", text)
            self.assert_refused(words, "world.yaml", "--duration", 0.01, "--trajectory", "motion.csv")
        self.assert_refused(["none.csv"], "world.yaml", "--trajectory", "none.csv")
        self.write("empty.yaml", "environments: [{name: ground, plane: [0, 0, 1, 0]}]")
        self.assert_refused(["no robot"], "empty.yaml", "--trajectory", "motion.csv")

    def test_states(self):
        self.write("words.state", "words")
        self.assert_refused(["words.state", "--save-state"], "world.yaml", "--load-state", "words.state")
        self.report("world.yaml", "--duration", 0.01, "--save-state", "whole.state")
        whole = (self.folder / "whole.state").read_bytes()
        for cut in (20, len(whole) // 2, len(whole) - 1):
            (self.folder / "cut.state").write_bytes(whole[:cut])
            self.assert_refused(["cut.state"], "world.yaml", "--load-state", "cut.state")
        self.assert_refused([], "world.yaml", "--set", "objects=[]", "--load-state", "whole.state")

    def test_files_that_cannot_be_written(self):
        self.assert_refused(["nowhere/r.json"], "world.yaml", "--duration", 0.001, "--report", "nowhere/r.json")
        self.assert_refused(["nowhere/t.csv"], "world.yaml", "--duration", 0.001, "--csv", "nowhere/t.csv")
        self.assert_refused(["/dev/full", "rows"], "world.yaml", "--duration", 0.01, "--csv", "/dev/full", "--report", "r.json")

    def test_states_do_not_take_the_place_of_what_is_no_file(self):
        pipe = self.folder / "pipe"
        os.mkfifo(str(pipe))
        self.assert_refused(["pipe", "no file"], "world.yaml", "--duration", 0.001, "--save-state", "pipe")
        self.assertTrue(pipe.is_fifo())

    def test_standard_output_on_a_full_disk(self):
        with open("/dev/full", "w") as full:
            done = subprocess.run([self.program, "world.yaml", "--duration", "0.001"], cwd=str(self.folder), stdout=full, stderr=subprocess.PIPE, text=True)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
        self.assertIn("standard output", done.stderr)


if __name__ == "__main__":
    unittest.main()
