"""The Python module against closed forms, blem_sim_run and itself."""
import os
import json
import subprocess
import sys
import threading
import time
import unittest

import numpy

sys.path.insert(0, __file__.rsplit("/", 1)[0])
from simulator_case import GRAVITY, WORLD, SimulatorCase, blem_sim  # noqa: E402


class SimulatorTest(SimulatorCase):

    def test_messages_and_simulator_are_in_one_package(self):
        from blem_sim.msg import StepReport
        from blem_sim.srv import Step
        self.assertTrue(StepReport() is not None and Step is not None and blem_sim.Simulator is not None)
        self.assertTrue(issubclass(blem_sim.InputError, ValueError))

    def test_messages_alone_load_no_simulator(self):
        code = "import sys, blem_sim.msg; sys.exit('blem_sim._simulator' in sys.modules)"
        self.assertEqual(subprocess.run([sys.executable, "-c", code]).returncode, 0)

    def test_hash_is_that_of_blem_sim_run(self):
        program = os.environ.get("BLEM_SIM_RUN", "")
        self.assertTrue(os.access(program, os.X_OK), "set BLEM_SIM_RUN to the program blem_sim_run (scripts/test does)")
        done = subprocess.run([program, "world.yaml", "--duration", "0.3", "--set", "random_seed=7"], cwd=str(self.folder), stdout=subprocess.PIPE,
                              universal_newlines=True, check=True)
        report = json.loads(done.stdout)
        simulation = self.world(settings={"random_seed": 7})
        simulation.step(300)
        self.assertEqual(simulation.state_hash(), report["state_hash"])
        self.assertEqual(simulation.body_names, list(report["bodies"]))
        self.assertEqual(simulation.joint_names, list(report["joints"]))
        for row, body in enumerate(report["bodies"].values()):
            numpy.testing.assert_allclose(simulation.poses[row], body["xyz"] + body["quat_xyzw"], rtol=0, atol=1e-12)
            numpy.testing.assert_allclose(simulation.body_velocities[row], body["linear_velocity"] + body["angular_velocity"], rtol=0, atol=1e-12)
        for row, joint in enumerate(report["joints"].values()):
            shown = [simulation.positions[row], simulation.velocities[row], simulation.efforts[row]]
            numpy.testing.assert_allclose(shown, [joint["position"], joint["velocity"], joint["effort"]], rtol=1e-12)

    def test_file_text_and_dictionary_are_one_world(self):
        import yaml
        ways = [self.world(), blem_sim.Simulator(WORLD, folder=self.folder), blem_sim.Simulator(yaml.safe_load(WORLD), folder=str(self.folder))]
        for way in ways:
            way.step(20)
        self.assertEqual(len({way.state_hash() for way in ways}), 1)

    def test_packages_are_found(self):
        simulation = blem_sim.Simulator({"objects": [{"name": "cube", "uri": "package://cubes/cube.off", "mass": 1}]}, packages={"cubes": self.folder})
        self.assertEqual(len(simulation.body_names), 1)

    def test_restored_state_goes_on_with_the_same_bits(self):
        simulation = self.world()
        simulation.step(50)
        kept = simulation.save()
        self.assertIsInstance(kept, bytes)
        simulation.step(70)
        end, poses = simulation.state_hash(), simulation.poses.copy()
        simulation.restore(kept)
        self.assertEqual(simulation.steps, 50)
        simulation.step(70)
        self.assertEqual(simulation.state_hash(), end)
        numpy.testing.assert_array_equal(simulation.poses, poses)
        other = self.world()
        other.restore(kept)
        other.step(70)
        self.assertEqual(other.state_hash(), end)

    def test_reset_starts_again(self):
        simulation = self.world()
        start = simulation.poses.copy()
        simulation.step(40)
        end = simulation.state_hash()
        simulation.reset()
        self.assertEqual((simulation.time, simulation.steps), (0, 0))
        numpy.testing.assert_array_equal(simulation.poses, start)
        simulation.step(40)
        self.assertEqual(simulation.state_hash(), end)

    def test_free_fall(self):
        simulation = self.cube(10)
        simulation.step(500)
        self.assertAlmostEqual(simulation.time, 0.5, places=12)
        # A step moves by velocity at its end or by the mean: within one step's g t dt / 2 of g t^2 / 2.
        self.assertAlmostEqual(simulation.poses[0, 2], 10 - GRAVITY * 0.5 ** 2 / 2, delta=GRAVITY * 0.5 * simulation.time_step / 2 + 1e-9)
        self.assertAlmostEqual(simulation.body_velocities[0, 2], -GRAVITY * 0.5, places=9)
        self.assertEqual(len(simulation.contacts), 0)

    def test_cube_at_rest_presses_with_its_weight(self):
        simulation = self.cube(0.0525)
        simulation.step(200)
        contacts = simulation.contacts
        self.assertEqual(len(contacts), 4)
        self.assertEqual({tuple(sorted(pair)) for pair in contacts[["body_a", "body_b"]].tolist()}, {(-1, 0)})
        on_cube = numpy.where(contacts["body_a"] == 0, 1, -1)[:, None] * contacts["force"]
        numpy.testing.assert_allclose(on_cube.sum(axis=0), [0, 0, 2 * GRAVITY], atol=1e-5)
        numpy.testing.assert_allclose(numpy.abs(contacts["normal"]), [[0, 0, 1]] * 4, atol=1e-9)
        numpy.testing.assert_allclose(numpy.abs(contacts["point"][:, :2]), 0.05, atol=1e-5)

    def test_wrench_lifts_for_as_long_as_it_acts(self):
        simulation = self.cube(1)
        simulation.apply_wrench("cube::link", [0, 0, 2 * GRAVITY + 4], duration=-1)
        simulation.step(100)
        self.assertAlmostEqual(simulation.body_velocities[0, 2], 0.2, places=9)
        simulation.clear_wrenches("cube::link")
        simulation.apply_wrench("cube::link", [4000, 0, 0])
        simulation.step(2)
        self.assertAlmostEqual(simulation.body_velocities[0, 0], 2, places=9)
        self.assertAlmostEqual(simulation.body_velocities[0, 2], 0.2 - 2 * GRAVITY * 0.001, places=9)

    def test_commands_are_followed(self):
        stiff = {"robots.0.fixed_base": True, "robots.0.motor": "implicit_pd", "robots.0.gains": {"default": {"p": 5000, "i": 0, "d": 100}}}
        simulation = self.world(settings=stiff)
        self.assertEqual((simulation.robots, simulation.robot_joints("arm")), (["arm"], ["shoulder", "elbow"]))
        simulation.command("arm", positions=numpy.array([0.1, -0.2]))
        simulation.step(800)
        numpy.testing.assert_allclose(simulation.positions, [0.1, -0.2], atol=2e-3)
        simulation.command("arm", positions=[0.3], joints=["elbow"])
        simulation.step(800)
        numpy.testing.assert_allclose(simulation.positions, [0.1, 0.3], atol=2e-3)
        simulation.command_trajectory("arm", [0.4, 0.8], [[0.2, 0.2], [0.4, 0.0]])
        simulation.step(400)
        numpy.testing.assert_allclose(simulation.positions, [0.2, 0.2], atol=1e-2)
        simulation.step(800)
        numpy.testing.assert_allclose(simulation.positions, [0.4, 0.0], atol=2e-3)
        simulation.set_joint_positions("arm", [-0.5, 0.5])
        numpy.testing.assert_allclose(simulation.positions, [-0.5, 0.5], atol=1e-12)
        still = simulation.positions.copy()
        simulation.apply_effort("arm::elbow", 20, duration=-1)
        simulation.step(500)
        bent = simulation.positions[1] - still[1]
        simulation.clear_efforts("arm::elbow")
        simulation.step(500)
        # 20 N m against 5000 N m/rad.
        self.assertAlmostEqual(bent - (simulation.positions[1] - still[1]), 0.004, delta=2e-4)

    def test_sensors_read(self):
        simulation = self.world()
        self.assertEqual(simulation.sensors, {})
        simulation.step(100)
        readings = simulation.sensors
        self.assertEqual(set(readings), {"shoulder_wrench", "imu", "base_contact", "tilt", "motors"})
        for name, reading in readings.items():
            self.assertEqual(len(reading), len(simulation.sensor_fields(name)), name)
        self.assertGreater(numpy.linalg.norm(readings["shoulder_wrench"][:3]), 1)


class ArraysTest(SimulatorCase):

    def test_arrays_go_on_with_the_simulation_and_cannot_be_written(self):
        simulation = self.cube(1)
        poses = simulation.poses
        simulation.step(10)
        self.assertLess(poses[0, 2], 1)
        self.assertIs(simulation.poses, poses)
        for array in (simulation.positions, simulation.velocities, simulation.efforts, poses, simulation.body_velocities):
            self.assertFalse(array.flags.writeable)
            with self.assertRaises(ValueError):
                array.flags.writeable = True

    def test_arrays_outlive_the_simulation(self):
        simulation = self.cube(1)
        poses = simulation.poses
        del simulation
        self.assertEqual(poses[0, 2], 1)


class TogetherTest(SimulatorCase):

    def test_two_simulations_do_not_disturb_each_other(self):
        alone = self.world()
        alone.step(60)
        first, second = self.world(), self.cube(0.3)
        for _ in range(60):
            first.step()
            second.step(3)
        self.assertEqual(first.state_hash(), alone.state_hash())

    def test_python_runs_while_a_thread_steps(self):
        simulation = self.world()
        begun = time.monotonic()
        simulation.step(200)
        count = int(200 * 0.5 / (time.monotonic() - begun)) + 1
        thread = threading.Thread(target=simulation.step, args=(count,))
        thread.start()
        looks = 0
        while thread.is_alive():
            looks += simulation.positions[0] < 100
            time.sleep(0.001)
        thread.join()
        self.assertGreater(looks, 20)
        self.assertEqual(simulation.steps, 200 + count)

    def test_threads_take_turns(self):
        simulation, alone = self.world(), self.world()
        threads = [threading.Thread(target=lambda: [simulation.step(5) for _ in range(10)]) for _ in range(3)]
        for thread in threads:
            thread.start()
        for _ in range(20):
            simulation.save()
        for thread in threads:
            thread.join()
        alone.step(150)
        self.assertEqual(simulation.state_hash(), alone.state_hash())


if __name__ == "__main__":
    unittest.main()
