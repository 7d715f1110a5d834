"""The report and the table that blem_sim_run writes, field by field as the contract has them."""
import csv
import json
import math
import re
import statistics
import sys
import unittest
import xml.etree.ElementTree

sys.path.insert(0, __file__.rsplit("/", 1)[0])
from run_scene import RunCase, SOURCE_DIR  # noqa: E402

STAGES = ["sample_commands", "motor_torque", "broad_phase", "narrow_phase", "reduction", "step_guard", "solve", "sensors", "report"]


class ReportTest(RunCase):

    def test_every_field_is_there(self):
        report = self.report("world.yaml", "--duration", 0.3)
        self.assertAlmostEqual(report["simulated_s"], 0.3, places=12)
        self.assertEqual(report["steps"], 300)
        for key in ("cpu_s", "wall_s", "real_time_factor"):
            self.assertGreater(report[key], 0)
        self.assertIn("STEP_SHORTENED", report["status"])
        self.assertEqual(report["status"]["STATE_NOT_FINITE"], 0)
        for stage in STAGES:
            profile = report["profile_ms"][stage]
            self.assertLessEqual(profile["p50"], profile["p99"])
            self.assertLessEqual(profile["p99"], profile["max"])
            self.assertGreaterEqual(profile["mean"], 0)
        contacts = report["contacts"]
        self.assertGreaterEqual(contacts["raw_mean"], contacts["reduced_mean"])
        self.assertGreaterEqual(contacts["reduced_max"], contacts["reduced_mean"])
        self.assertGreater(contacts["reduced_mean"], 0)
        self.assertEqual(contacts["wrench_error_max"] > 0, report["status"]["CONTACTS_REDUCED"] > 0)
        self.assertEqual(set(report["max_penetration"]), {"depth_m", "of_layer", "pair", "time_s"})
        self.assertTrue(math.isfinite(report["energy_J"]))

    def test_energy_and_contacts_outside_their_layers(self):
        sound = self.report("world.yaml", "--duration", 0.3)
        self.assertEqual(set(sound["energy"]), {"gained_j", "most_in_a_step_j", "most_in_a_step_time_s"})
        self.assertLess(sound["energy"]["gained_j"], 0.1)
        self.assertEqual((sound["layer_event_count"], sound["layer_events"]), (0, []))
        # The cube starts 2 cm deep in the base: it is pushed out.
        report = self.report("world.yaml", "--duration", 1, "--set", "objects[0].pose.xyz=[0.1, 0, 0.135]", "--set",
                             "objects[0].pose.rpy=[0, 0, 0]")
        self.assertGreater(report["energy"]["gained_j"], 9.81 * 0.02)
        self.assertEqual(report["layer_event_count"], len(report["layer_events"]))
        first = report["layer_events"][0]
        self.assertEqual(set(first), {"time_s", "pair", "outside", "depth_m", "of_layer", "pierced"})
        self.assertEqual((first["time_s"], first["pair"], first["outside"], first["pierced"]), (0, ["arm::base", "cube"], True, True))
        self.assertGreater(first["of_layer"], 1)
        last = report["layer_events"][-1]
        self.assertEqual((last["pair"], last["outside"]), (["arm::base", "cube"], False))

    def test_bodies_and_joints(self):
        report = self.report("world.yaml", "--duration", 0.3)
        self.assertEqual(sorted(report["bodies"]), ["arm::base", "arm::lower", "arm::upper", "cube::link"])
        self.assertEqual(sorted(report["joints"]), ["arm::elbow", "arm::shoulder"])
        base = report["bodies"]["arm::base"]
        self.assertEqual([len(base[key]) for key in ("xyz", "quat_xyzw", "linear_velocity", "angular_velocity")], [3, 4, 3, 3])
        self.assertAlmostEqual(sum(q * q for q in base["quat_xyzw"]), 1, places=9)
        self.assertAlmostEqual(base["xyz"][2], 0.0525, delta=1e-3)
        self.assertEqual(set(report["joints"]["arm::elbow"]), {"position", "velocity", "effort"})

    def test_sensors_are_averaged_from_a_time_on(self):
        report = self.report("world.yaml", "--duration", 0.3, "--stats-from", 0.1)
        sensors = report["sensors"]
        self.assertEqual(sorted(sensors), ["base_contact", "imu", "motors", "shoulder_wrench", "tilt"])
        self.assertEqual(sensors["shoulder_wrench"]["samples"], 200)
        self.assertEqual(sensors["imu"]["samples"], 40)
        self.assertEqual(sensors["tilt"]["samples"], 10)
        for sensor in sensors.values():
            for key in ("mean", "std", "min", "max"):
                self.assertEqual(len(sensor[key]), len(sensor["fields"]))
            for low, mean, high in zip(sensor["min"], sensor["mean"], sensor["max"]):
                self.assertLessEqual(low, mean + 1e-12)
                self.assertLessEqual(mean, high + 1e-12)
        # 6.5 kg stand on the base.
        weight = sensors["base_contact"]["mean"][sensors["base_contact"]["fields"].index("force_z")]
        self.assertAlmostEqual(weight, 6.5 * 9.81, delta=3)

    def test_statistics_are_those_of_the_table(self):
        report = self.run_program("world.yaml", "--duration", 0.2, "--csv", "out.csv", "--csv-rate", 0, "--report", "r.json")
        self.assertEqual(report.returncode, 0, report.stderr)
        sensor = json.loads((self.folder / "r.json").read_text())["sensors"]["shoulder_wrench"]
        with open(str(self.folder / "out.csv")) as stream:
            rows = list(csv.DictReader(stream))
        self.assertEqual(len(rows), 200)
        for i, field in enumerate(sensor["fields"]):
            values = [float(row["shoulder_wrench." + field]) for row in rows]
            self.assertAlmostEqual(sensor["mean"][i], statistics.mean(values), places=9)
            self.assertAlmostEqual(sensor["std"][i], statistics.pstdev(values), places=9)
            self.assertEqual((sensor["min"][i], sensor["max"][i]), (min(values), max(values)))

    def test_load_report(self):
        load = {row["name"]: row for row in self.report("world.yaml", "--duration", 0)["load"]}
        cube = load["cube"]
        self.assertEqual((cube["triangles"], cube["degenerate"], cube["duplicate"], cube["open_edges"]), (12, 0, 0, 0))
        self.assertEqual(cube["boundary_width"], 0.0025)

    def test_report_to_a_file(self):
        done = self.run_program("world.yaml", "--duration", 0.01, "--report", "out.json")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))
        self.assertEqual(json.loads((self.folder / "out.json").read_text())["steps"], 10)

    def test_ignored_columns_are_noted(self):
        report = self.report("world.yaml", "--duration", 0.01, "--trajectory", "motion.csv")
        self.assertTrue(any("root_x" in note for note in report["notes"]), report["notes"])

    def test_a_trajectory_is_followed(self):
        report = self.report("world.yaml", "--duration", 1.5, "--trajectory", "motion.csv")
        self.assertAlmostEqual(report["joints"]["arm::shoulder"]["position"], 0.2, delta=0.05)
        self.assertAlmostEqual(report["joints"]["arm::elbow"]["position"], 0.2, delta=0.05)

    def test_the_table(self):
        done = self.run_program("world.yaml", "--duration", 0.1, "--csv", "out.csv", "--csv-rate", 50, "--report", "r.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(str(self.folder / "out.csv")) as stream:
            rows = list(csv.DictReader(stream))
        self.assertEqual([round(float(row["time"]), 9) for row in rows], [0.02, 0.04, 0.06, 0.08, 0.1])
        last = json.loads((self.folder / "r.json").read_text())
        self.assertEqual(float(rows[-1]["arm::shoulder"]), last["joints"]["arm::shoulder"]["position"])
        self.assertEqual(float(rows[-1]["cube::link_z"]), last["bodies"]["cube::link"]["xyz"][2])
        self.assertIn("arm::base_x", rows[-1])
        self.assertNotEqual(rows[-1]["shoulder_wrench.force_z"], "")

    def test_the_table_of_a_fixed_base(self):
        done = self.run_program("world.yaml", "--set", "robots.0.fixed_base=true", "--duration", 0.01, "--csv", "out.csv", "--report", "r.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        header = (self.folder / "out.csv").read_text().splitlines()[0].split(",")
        self.assertIn("arm::shoulder", header)
        self.assertIn("cube::link_x", header)
        self.assertEqual([name for name in header if name.startswith("arm::") and name.endswith("_x")], [], "no part of it is free")

    def test_a_trajectory_that_a_spreadsheet_saved(self):
        self.write("motion.csv", "\ufefftime,shoulder,elbow\r\n0,0.3,0\r\n")  # with a byte order mark
        self.report("world.yaml", "--duration", 0.01, "--trajectory", "motion.csv")

    def test_what_a_state_has_brought_along_is_noted(self):
        self.report("world.yaml", "--duration", 0.01, "--save-state", "s.state")
        same = self.report("world.yaml", "--duration", 0.01, "--load-state", "s.state")
        self.assertFalse(any("s.state" in note for note in same["notes"]), same["notes"])
        other = self.report("world.yaml", "--duration", 0.01, "--load-state", "s.state", "--set", "gravity=[0, 0, -1.6]", "--seed", 7)
        self.assertEqual(other["state_hash"], same["state_hash"])
        self.assertEqual(len([note for note in other["notes"] if "s.state" in note]), 2, other["notes"])

    def test_settings(self):
        report = self.report("world.yaml", "--duration", 0.1, "--set", "time_step=0.002", "--set", "robots[0].sensors=[]")
        self.assertEqual(report["steps"], 50)
        self.assertEqual(report["sensors"], {})

    def test_packages(self):
        (self.folder / "meshes").mkdir()
        (self.folder / "cube.off").rename(self.folder / "meshes" / "cube.off")
        report = self.report("world.yaml", "--duration", 0, "--set", "objects.0.uri=package://things/meshes/cube.off", "--package",
                             "things=%s" % self.folder)
        self.assertEqual(report["steps"], 0)

    def test_help(self):
        done = self.run_program("--help")
        self.assertEqual(done.returncode, 0)
        for option in ("--duration", "--set", "--trajectory", "--stats-from", "--csv", "--csv-rate", "--report", "--seed", "--package", "--stop", "--batch"):
            self.assertIn(option, done.stdout)

    def test_version(self):
        done = self.run_program("--version")
        self.assertEqual(done.returncode, 0)
        package = xml.etree.ElementTree.parse(SOURCE_DIR / "package.xml")
        self.assertRegex(done.stdout, r"^blem_sim %s \(\w+ [0-9.]+\)\n$" % re.escape(package.findtext("version")))


if __name__ == "__main__":
    unittest.main()
