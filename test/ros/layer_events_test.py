#!/usr/bin/python3
"""A contact outside its boundary layers is told: as events, in words, in colour, and by the test node expect_contacts_in_layer."""
import os
import subprocess
import tempfile
import time
import unittest

import rosgraph
import roslib.packages
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Log
from visualization_msgs.msg import Marker, MarkerArray

from blem_sim.msg import LayerEvent, StepReport
from sim_client import SETTLE, Recorder, reset_simulation, step, unpause, wait_until

PAIR = ("lower", "upper")
JUDGE = "/judge_of_contacts"


def alarms(array):
    """Colours of the points of a contact marker message, true where it is the alarm's."""
    points = [marker for marker in array.markers if marker.type == Marker.SPHERE_LIST][0]
    return [(colour.r, colour.g) == (1, 0) for colour in points.colors]


def listens(node):
    subscribers = dict(rosgraph.Master("/layer_events_test").getSystemState()[1])
    return node in subscribers.get("/blem_sim/step_report", []) + subscribers.get("/nobody/step_report", [])


class LayerEventsTest(unittest.TestCase):

    def setUp(self):
        step(1)  # pauses
        reset_simulation()

    def recorder(self, topic, message_type):
        recorder = Recorder(topic, message_type)
        self.addCleanup(recorder.stop)
        wait_until(recorder.connected, "a connection to " + topic)
        return recorder

    def test_events_warning_and_energy(self):
        events = self.recorder("/blem_sim/layer_events", LayerEvent)
        log = self.recorder("/rosout", Log)
        reports = self.recorder("/blem_sim/step_report", StepReport)
        step(300)
        left, back = events.wait_for(2)
        self.assertEqual([(left.body_a, left.body_b), (back.body_a, back.body_b)], [PAIR, PAIR])
        self.assertEqual((left.outside, left.pierced, left.header.stamp.to_sec(), left.header.frame_id), (True, True, 0, "world"))
        self.assertAlmostEqual(left.of_layer, 3, delta=1e-3)
        self.assertAlmostEqual(left.depth, 0.015, delta=1e-5)
        self.assertFalse(back.outside)
        self.assertLessEqual(back.of_layer, 1)
        self.assertGreater(back.header.stamp.to_sec(), 0.01)

        def warnings():
            return [message.msg for message in log.messages() if message.level == Log.WARN and "left their boundary layers" in message.msg]

        wait_until(warnings, "a warning on /rosout")
        self.assertEqual(len(warnings()), 1)
        for word in PAIR + ("boundary_width", "t = 0.000 s"):
            self.assertIn(word, warnings()[0])
        gained = sum(report.energy_gained for report in reports.wait_for(3))
        self.assertGreater(gained, 9.81 * 0.01)

    def test_late_subscribers_are_told_the_last_event(self):
        step(300)
        last = self.recorder("/blem_sim/layer_events", LayerEvent).wait_for(1)[0]
        self.assertFalse(last.outside)

    def test_markers_have_the_alarm_colour_until_it_is_back(self):
        markers = self.recorder("/blem_sim/contact_markers", MarkerArray)
        step(1)
        step(100)
        wait_until(lambda: any(any(alarms(message)) for message in markers.messages()), "an alarm colour")
        self.assertFalse(all(alarms(markers.messages()[-1])))  # those on the ground
        step(300)
        markers.clear()
        step(100)
        self.assertFalse(any(alarms(markers.wait_for(1)[-1])))

    def test_diagnostics_count_them(self):
        step(300)
        diagnostics = self.recorder("/diagnostics", DiagnosticArray)

        def values():
            return {value.key: value.value for message in diagnostics.messages() for status in message.status for value in status.values}

        key = "times that contacts left their boundary layers since the start"
        wait_until(lambda: values().get(key) == "1", "the count of events in /diagnostics")
        self.assertGreater(float(values()["energy gained out of nothing since the start [J]"]), 9.81 * 0.01)

    def judged(self, meanwhile=lambda: None, **parameters):
        """(exit code, what it wrote to its JUnit file) of expect_contacts_in_layer. @param meanwhile is called once it listens"""
        rospy.set_param(JUDGE, parameters)
        with tempfile.TemporaryDirectory() as folder:
            results = os.path.join(folder, "results.xml")
            command = [roslib.packages.find_node("blem_sim", "expect_contacts_in_layer")[0], "--gtest_output=xml:" + results, "__name:=" + JUDGE[1:]]
            process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            self.addCleanup(lambda: process.poll() is None and process.kill())
            wait_until(lambda: listens(JUDGE) or process.poll() is not None, "the judge to listen")
            time.sleep(SETTLE)
            meanwhile()
            code = process.wait(timeout=120)
            with open(results) as stream:
                return code, stream.read()

    def test_judge_fails_a_contact_that_leaves(self):
        code, words = self.judged(unpause, duration=0.5, patience=20)
        self.assertEqual(code, 1, words)
        for word in PAIR + ("t = 0.000 s", "boundary_width", "used up 3 ", "<failure"):
            self.assertIn(word, words)

    def test_judge_fails_a_contact_that_left_before_it_listened(self):
        step(300)
        code, words = self.judged(unpause, duration=0.2, patience=20)
        self.assertEqual(code, 1, words)
        for word in PAIR + ("boundary_width", "<failure"):
            self.assertIn(word, words)

    def test_judge_knows_its_parameters(self):
        code, words = self.judged(unpause, duration=0.1, patience=20, max_energy_gaine=1e9, max_of_layer=100)
        self.assertEqual(code, 1, words)
        self.assertIn("max_energy_gaine: unknown parameter; the nearest known one is 'max_energy_gained'", words.replace("&apos;", "'"))

    def test_judge_ignores_what_it_is_told_to(self):
        code, words = self.judged(unpause, duration=0.5, patience=20, ignore_until=0.4)
        self.assertEqual(code, 0, words)

    def test_judge_fails_for_energy(self):
        code, words = self.judged(unpause, duration=0.3, patience=20, max_of_layer=4, max_energy_gained=0.01)
        self.assertEqual(code, 1, words)
        self.assertIn("J came out of nothing", words)
        self.assertNotIn("used up", words)

    def test_judge_fails_when_nobody_answers(self):
        code, words = self.judged(simulator="/nobody", patience=1)
        self.assertEqual(code, 1, words)
        self.assertIn("no node /nobody", words)
        code, words = self.judged(patience=1)
        self.assertEqual(code, 1, words)
        self.assertIn("unpause it", words)

    def test_judge_names_a_bad_parameter(self):
        code, words = self.judged(duration="long")
        self.assertEqual(code, 1, words)
        self.assertIn(JUDGE + "/duration", words)


if __name__ == "__main__":
    rospy.init_node("layer_events_test")
    rostest.rosrun("blem_sim", "layer_events", LayerEventsTest)
