#!/usr/bin/python3
"""simulate.launch with a URDF, an environment and Gazebo's node name: the robot is there, its frames too, scripts for Gazebo work."""
import subprocess
import tempfile
import unittest

import rospy
import rostest
import yaml
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

from blem_sim.msg import ModelStates
from sim_client import PATIENCE, Recorder, wait_until


def node_parameters(*arguments):
    """Parameters that a launch file of this package sets, without a start."""
    return yaml.safe_load(subprocess.check_output(["roslaunch", "--dump-params", "blem_sim", *arguments]))


class SimulateLaunchTest(unittest.TestCase):
    def test_yaml_holds_where_no_argument_is_given(self):
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as world:
            world.write("{paused: true, real_time_factor: 0, robots: []}")
            world.flush()
            for launch, argument, node in (("simulate.launch", "config", "/blem_sim"), ("empty_world.launch", "world_name", "/gazebo")):
                chosen = [launch, "%s:=%s" % (argument, world.name)]
                left = node_parameters(*chosen)
                self.assertEqual((left[node + "/paused"], left[node + "/real_time_factor"]), (True, 0), launch)
                given = node_parameters(*chosen, "paused:=false", "real_time_factor:=2")
                self.assertEqual((given[node + "/paused"], given[node + "/real_time_factor"]), (False, 2), launch)

    def test_robot_and_environment_are_there(self):
        models = Recorder("/gazebo/model_states", ModelStates)
        self.assertEqual(set(models.wait_for(1)[0].name), {"arm_on_base", "environment"})
        models.stop()
        joints = Recorder("/joint_states", JointState)
        self.assertEqual(joints.wait_for(1)[0].name, ["shoulder"])
        joints.stop()
        markers = Recorder("/gazebo/environment_markers", MarkerArray)
        self.assertTrue(any(marker.action == Marker.ADD for marker in markers.wait_for(1)[0].markers))
        markers.stop()

    def test_frames_reach_from_the_world_to_the_hand(self):
        parents = {}

        def gather(message):
            parents.update({t.child_frame_id: t.header.frame_id for t in message.transforms})

        moving = rospy.Subscriber("/tf", TFMessage, gather)
        fixed = rospy.Subscriber("/tf_static", TFMessage, gather)
        wait_until(lambda: {"base", "arm", "hand"} <= set(parents), "frames of every link")
        self.assertEqual(parents, {"base": "world", "arm": "base", "hand": "arm"})
        moving.unregister()
        fixed.unregister()

    def test_gazebo_services(self):
        for name in ("pause_physics", "unpause_physics", "reset_world"):
            rospy.wait_for_service("/gazebo/" + name, PATIENCE)
            rospy.ServiceProxy("/gazebo/" + name, Empty)()
        odom = Recorder("/odom", Odometry)
        odom.wait_for(10)
        odom.stop()


if __name__ == "__main__":
    rospy.init_node("simulate_launch_test")
    rostest.rosrun("blem_sim", "simulate_launch", SimulateLaunchTest)
