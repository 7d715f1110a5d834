#!/usr/bin/python3
"""Models come and go while the simulation runs: memory and handles stay, and the others move as if nothing had been there."""
import argparse
import os
import sys
import time
import unittest
import xmlrpc.client

import rosgraph
import rosnode
import rospkg
import rospy
import rostest
from geometry_msgs.msg import Point, Pose

from blem_sim import srv

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from sim_client import service

ARM = os.path.join(rospkg.RosPack().get_path("blem_sim"), "test", "data", "ros", "arm_on_base.urdf")
BALL = """<robot name="ball"><link name="ball"><inertial><mass value="1"/>
<inertia ixx="0.004" iyy="0.004" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><sphere radius="0.1"/></geometry></collision></link></robot>"""
GROWTH = 8192  # [kB] of resident memory, from the first quarter of the cycles to the end


def pid_of(node):
    return xmlrpc.client.ServerProxy(rosnode.get_api_uri(rosgraph.Master("/test"), node)).getPid("/test")[2]


def resident(pid):
    """[kB]"""
    with open("/proc/%d/status" % pid) as stream:
        return next(int(line.split()[1]) for line in stream if line.startswith("VmRSS"))


def handles(pid):
    return len(os.listdir("/proc/%d/fd" % pid))


class SpawnCyclesTest(unittest.TestCase):
    cycles = 40

    def cycle(self, arm):
        spawn, delete = service("spawn_urdf_model", srv.SpawnModel), service("delete_model", srv.DeleteModel)
        for name, xml, x in (("second", arm, 3.0), ("ball", BALL, -3.0)):
            answer = spawn(name, xml, name, Pose(position=Point(x, 0, 0.4)), "")
            self.assertTrue(answer.success, answer.status_message)
        for name in ("ball", "second"):
            answer = delete(name)
            self.assertTrue(answer.success, answer.status_message)

    def settled_handles(self, pid):
        """Connections of clients that have gone close a little later."""
        time.sleep(2)
        return handles(pid)

    def test_memory_and_the_others(self):
        with open(ARM) as stream:
            arm = stream.read()
        pid = pid_of("/blem_sim")
        for _ in range(self.cycles // 4):
            self.cycle(arm)
        memory, files = resident(pid), self.settled_handles(pid)
        start = time.time()
        for _ in range(self.cycles - self.cycles // 4):
            self.cycle(arm)
        seconds, grown, more = time.time() - start, resident(pid) - memory, self.settled_handles(pid) - files
        end = self.compare_with_undisturbed()
        print("%d cycles of two models, %.3f s each, to step %d: memory %+d kB of %d from a quarter on, handles %+d of %d" % (
            self.cycles, seconds / (self.cycles - self.cycles // 4), end, grown, memory, more, files))
        self.assertLess(grown, GROWTH)
        self.assertLessEqual(more, 0)

    def compare_with_undisturbed(self):
        """Number of steps made."""
        sim_client.pause()
        seen = service("step_with_commands", srv.StepWithCommands)(1, [])
        other = rospy.ServiceProxy("/undisturbed/step_with_commands", srv.StepWithCommands)
        alone = other(seen.step - other(0, []).step, [])
        self.assertEqual(seen.step, alone.step)
        self.assertEqual(seen.models, alone.models)
        self.assertEqual([robot.joints for robot in seen.robots], [robot.joints for robot in alone.robots])
        return seen.step


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--cycles", type=int, default=40)
    SpawnCyclesTest.cycles = parser.parse_known_args()[0].cycles
    rospy.init_node("spawn_cycles_test", disable_rostime=True)
    rostest.rosrun("blem_sim", "spawn_cycles", SpawnCyclesTest)
