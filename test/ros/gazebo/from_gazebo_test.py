#!/usr/bin/python3
"""The table of Gazebo's ROS API in docs/from_gazebo.md, held against a running node."""
import collections
import os
import sys
import unittest

import rosgraph
import roslib.message
import rospkg
import rospy
import rosservice
import rostest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from blem_sim import srv
from sim_client import service

sim_client.NODE = "/gazebo"
PACKAGE = rospkg.RosPack().get_path("blem_sim")
PAGE = os.path.join(PACKAGE, "docs", "from_gazebo.md")

Row = collections.namedtuple("Row", "name kind type md5 here why")


def rows():
    """Of the table below the last heading; cells without their marks."""
    with open(PAGE) as stream:
        table = stream.read().split("## Gazebo's ROS API")[1]
    cells = [[cell.strip().strip("`") for cell in line.strip().strip("|").split("|")] for line in table.splitlines() if line.startswith("|")]
    return [Row(*row) for row in cells[2:]]


def full_name(row):
    return row.name if row.name.startswith("/") else "/gazebo/" + row.name


def offered():
    """{kind: names} of what the node has."""
    published, subscribed, services = rosgraph.Master("/test").getSystemState()
    mine = lambda table: {name for name, nodes in table if "/gazebo" in nodes}
    return {"publishes": mine(published), "subscribes": mine(subscribed), "service": mine(services)}


def topic_sum(name):
    types = dict(rosgraph.Master("/test").getTopicTypes())
    return roslib.message.get_message_class(types[name])._md5sum


def service_sum(name):
    return rosservice.get_service_headers(name, rosservice.get_service_uri(name))["md5sum"]


class FromGazeboTest(unittest.TestCase):
    def setUp(self):
        rospy.wait_for_service("/gazebo/get_world_properties", sim_client.PATIENCE)
        self.assertGreater(len(rows()), 35)
        for row in rows():
            self.assertIn(row.kind, ("publishes", "subscribes", "service"), row)
            self.assertIn(row.here, ("same", "differs", "refused", "absent"), row)
            self.assertTrue(row.here == "same" or row.why, row)

    def test_rows_have_their_md5(self):
        names = offered()
        for row in rows():
            if row.here == "absent":
                self.assertNotIn(full_name(row), names[row.kind], row)
                continue
            self.assertIn(full_name(row), names[row.kind], row)
            self.assertEqual((service_sum if row.kind == "service" else topic_sum)(full_name(row)), row.md5, row)

    def test_refused_rows_answer_in_words(self):
        refused = [row for row in rows() if row.here == "refused"]
        self.assertEqual(len(refused), 4)
        for row in refused:
            answer = service(row.name, getattr(srv, row.type.split("/")[1]))()
            self.assertFalse(answer.success, row)
            self.assertGreater(len(answer.status_message.split()), 5, row)

    def test_every_service_is_in_the_docs(self):
        with open(os.path.join(PACKAGE, "docs", "services.md")) as stream:
            known = stream.read() + " ".join("`%s`" % row.name for row in rows())
        for name in offered()["service"]:
            if name.startswith("/gazebo/"):
                self.assertIn("`%s`" % name[len("/gazebo/"):], known)


if __name__ == "__main__":
    rospy.init_node("from_gazebo_test", disable_rostime=True)
    rostest.rosrun("blem_sim", "from_gazebo", FromGazeboTest)
