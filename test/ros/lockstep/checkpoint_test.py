#!/usr/bin/python3
"""A node that is killed goes on from its last checkpoint, to the same bits. More kills: rostest blem_sim checkpoint.test kills:=50"""
import os
import random
import signal
import sys
import threading
import time
import unittest
import xmlrpc.client

import rospy
import rostest
from sensor_msgs.msg import JointState

from blem_sim.msg import RobotCommand
from blem_sim.srv import StepWithCommands

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from sim_client import service

DECISIONS = 300
STEPS = 10  # of each
STEPS_PER_CHECKPOINT = 50
FILE = os.path.join(os.environ.get("ROS_HOME", os.path.expanduser("~/.ros")), "blem_sim.checkpoint")


def pid():
    uri = rospy.get_master().lookupNode("/blem_sim")[2]
    return xmlrpc.client.ServerProxy(uri).getPid("/test")[2]


def decide(number):
    """Fails where the node is not there; waiting for it would give it a command at another step."""
    target = 0.3 * ((number // 20) % 2)
    step = rospy.ServiceProxy("/blem_sim/step_with_commands", StepWithCommands)
    return step(STEPS, [RobotCommand("", JointState(name=["shoulder"], position=[target]))])


def seen():
    """What the node knows now; waits for it to be back."""
    deadline = time.time() + sim_client.PATIENCE
    while True:
        try:
            return service("step_with_commands", StepWithCommands)(0, [])
        except (rospy.ServiceException, rospy.ROSException, OSError):
            if time.time() > deadline:
                raise
            time.sleep(0.05)


class CheckpointTest(unittest.TestCase):
    def setUp(self):
        sim_client.pause()
        service("reset_simulation", sim_client.Empty)()

    def test_killed_runs_end_in_the_same_hash(self):
        uninterrupted = [decide(i).state_hash for i in range(DECISIONS)]
        service("reset_simulation", sim_client.Empty)()
        numbers = random.Random(1)
        kills, lost = rospy.get_param("~kills"), []
        number = 0
        wants_more = lambda: len(lost) < kills or max(lost) <= 0  # a kill right after a checkpoint loses nothing
        while number < DECISIONS or wants_more():
            if number == DECISIONS:
                service("reset_simulation", sim_client.Empty)()
                number = 0
            killer = None
            if wants_more():
                killer = threading.Timer(numbers.uniform(0.05, 0.5), os.kill, (pid(), signal.SIGKILL))
                killer.start()
            try:
                while number < DECISIONS:
                    answer = decide(number)
                    self.assertEqual((answer.step, answer.state_hash), (STEPS * (number + 1), uninterrupted[number]), str(lost))
                    number += 1
            except (rospy.ServiceException, rospy.ROSException, OSError):
                known = seen()
                back = known.step
                if back > 0:
                    self.assertEqual(known.state_hash, uninterrupted[back // STEPS - 1])
                self.assertEqual(back % STEPS_PER_CHECKPOINT, 0)
                # The call that was cut off may have come to one more checkpoint.
                self.assertLessEqual(back, STEPS * (number + 1))
                self.assertGreaterEqual(back, STEPS * number - STEPS_PER_CHECKPOINT)
                lost.append(STEPS * number - back)
                number = back // STEPS
            finally:
                if killer:
                    killer.cancel()
        self.assertGreater(max(lost), 0, "steps made anew")

    def test_what_is_no_state_is_put_aside(self):
        if os.path.exists(FILE + ".refused"):
            os.remove(FILE + ".refused")
        decide(0)
        os.kill(pid(), signal.SIGKILL)
        time.sleep(0.2)  # before it is started again
        with open(FILE, "w") as stream:
            stream.write("no state")
        self.assertEqual(seen().step, 0)
        with open(FILE + ".refused") as stream:
            self.assertEqual(stream.read(), "no state")


if __name__ == "__main__":
    rospy.init_node("checkpoint_test")
    rostest.rosrun("blem_sim", "checkpoint", CheckpointTest)
