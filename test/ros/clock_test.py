#!/usr/bin/python3
"""/clock: strictly increasing while time goes on, one stamp per step, silent during a pause."""
import time
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Clock

import sim_client
from sim_client import Recorder

TIME_STEP = 0.001


class ClockTest(unittest.TestCase):
    def setUp(self):
        self.clock = Recorder("/clock", Clock)
        self.clock.wait_for(1)

    def tearDown(self):
        self.clock.stop()
        sim_client.unpause()

    def times(self):
        return [message.clock.to_nsec() for message in self.clock.messages()]

    def test_never_repeated_never_backwards(self):
        sim_client.unpause()
        self.clock.wait_for(1000)
        times = self.times()
        self.assertTrue(all(a < b for a, b in zip(times, times[1:])))

    def test_every_stamp_is_a_step(self):
        self.pause_and_settle()
        self.clock.clear()
        answer = sim_client.step(200)
        self.wait_for_stamp(answer.stamp)
        last = answer.stamp.to_nsec()
        self.assertEqual(self.times(), [last - (199 - i) * int(TIME_STEP * 1e9) for i in range(200)])

    def wait_for_stamp(self, stamp):
        """The answer of a service may overtake the clock on its own connection."""
        end = time.time() + 10
        while time.time() < end and (not self.times() or self.times()[-1] < stamp.to_nsec()):
            time.sleep(0.01)

    def pause_and_settle(self):
        """Pauses and waits until all stamps from before have come."""
        sim_client.pause()
        self.wait_for_stamp(sim_client.step(1).stamp)

    def test_silent_while_paused(self):
        self.pause_and_settle()
        before = self.times()
        time.sleep(0.5)
        self.assertEqual(self.times(), before)

    def test_reset_world_does_not_move_it_back(self):
        sim_client.unpause()
        self.clock.wait_for(100)
        sim_client.reset_world()
        self.clock.wait_for(len(self.clock.messages()) + 100)
        times = self.times()
        self.assertTrue(all(a < b for a, b in zip(times, times[1:])))

    def test_reset_at_the_start_tells_no_stamp_twice(self):
        self.pause_and_settle()
        sim_client.reset_simulation()
        sim_client.wait_until(lambda: self.times()[-1] == 0, "the stamp of a reset")
        self.clock.clear()
        sim_client.reset_simulation()
        self.wait_for_stamp(sim_client.step(2).stamp)
        self.assertEqual(self.times(), [int(TIME_STEP * 1e9), int(2 * TIME_STEP * 1e9)])

    def test_late_subscriber_knows_the_time_during_a_pause(self):
        sim_client.pause()
        now = sim_client.step(1).stamp
        # Subscribers of one rospy node share a connection; only a new connection is late.
        self.clock.stop()
        late = Recorder("/clock", Clock)
        self.assertEqual(late.wait_for(1)[0].clock, now)
        late.stop()


if __name__ == "__main__":
    # rospy's own sim time would share the /clock connection and keep only the newest stamp.
    rospy.init_node("clock_test", disable_rostime=True)
    rostest.rosrun("blem_sim", "clock", ClockTest)
