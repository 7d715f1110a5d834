#!/usr/bin/python3
"""/clock of a node that keeps to real time: the first stamp within a second of the start, each step once, as fast as the wall clock."""
import argparse
import os
import subprocess
import sys
import time
import unittest

import roslib.packages
import rospy
import rostest
from rosgraph_msgs.msg import Clock

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from sim_client import wait_until

LONGEST_START, RATE_ERROR = 1.0, 0.01  # [s]; relative
LONG_RUN = 60.0  # [s] from which on the machine is meant to do nothing else
STEP = 1000000  # [ns]


class PacedClockTest(unittest.TestCase):
    seconds = 8

    def setUp(self):
        self.stamps = []
        subscriber = rospy.Subscriber("/clock", Clock, self.on_clock, tcp_nodelay=True)
        self.addCleanup(subscriber.unregister)
        program = roslib.packages.find_node("blem_sim", "blem_sim_node")[0]
        self.start = time.time()
        self.node = subprocess.Popen([program, "__name:=paced"])
        self.addCleanup(self.stop)

    def processor_seconds(self):
        with open("/proc/%d/stat" % self.node.pid) as stream:
            fields = stream.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def on_clock(self, message):
        self.stamps.append((time.time(), message.clock.to_nsec()))

    def stop(self):
        self.node.terminate()
        self.node.wait()

    def test_first_stamp_rate_and_order(self):
        wait_until(lambda: self.stamps, "the first stamp")
        worked, started = self.processor_seconds(), self.stamps[0][0] - self.start
        time.sleep(1)  # programs that start at once are through with it
        first = len(self.stamps)
        time.sleep(self.seconds)
        stamps = self.stamps[first:]
        wall, simulated = stamps[-1][0] - stamps[0][0], 1e-9 * (stamps[-1][1] - stamps[0][1])
        steps = [b - a for (_, a), (_, b) in zip(stamps, stamps[1:])]
        print("first stamp after %.2f s, %.2f s of processor time; %d stamps in %.1f s, simulated over wall time %.5f, steps between stamps %d to %d ns" % (
            started, worked, len(stamps), wall, simulated / wall, min(steps), max(steps)))
        self.assertEqual((min(steps), max(steps)), (STEP, STEP))
        self.assertLess(abs(simulated / wall - 1), RATE_ERROR)
        self.assertLess(started if self.seconds >= LONG_RUN else worked, LONGEST_START)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=8)
    PacedClockTest.seconds = parser.parse_known_args()[0].seconds
    # Wall time: rospy's own clock would share the connection.
    rospy.init_node("paced_clock_test", disable_rostime=True)
    rostest.rosrun("blem_sim", "paced_clock", PacedClockTest)
