#!/usr/bin/python3
"""Messages and requests of many kinds that are wrong, to a robot that stands: each is answered in words or counted, none changes a bit."""
import argparse
import os
import random
import resource
import sys
import time
import unittest

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from diagnostic_msgs.msg import DiagnosticArray
from std_srvs.srv import Empty

from blem_sim import msg, srv

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "..")]
import malformed
import sim_client
from sim_client import Recorder, service, temporary_folder, wait_until

UNMOVED = 1e-9  # [m]
ACTION = "/joint_trajectory_controller/follow_joint_trajectory"
TOPICS = {"joint_command": "/joint_command", "joint_trajectory": "/joint_trajectory", "command": "/joint_trajectory_controller/command",
          "set_model_state": "/blem_sim/set_model_state", "set_link_state": "/blem_sim/set_link_state", "points": "/points"}
MESSAGES = {"joint_command": malformed.joint_command, "joint_trajectory": malformed.trajectory, "command": malformed.controller_trajectory,
            "set_model_state": malformed.model_state, "set_link_state": malformed.link_state, "points": malformed.spoiled_cloud}
NAME = lambda kind: lambda rng: kind(malformed.name(rng))
# By kind: name of the service, its type, what makes a request.
REQUESTS = {
    "spawn": ("spawn_urdf_model", srv.SpawnModel, malformed.spawn),
    "spawn in a namespace": ("spawn_urdf_model", srv.SpawnModel, malformed.spawn_names),
    "spawn SDF": ("spawn_sdf_model", srv.SpawnModel, malformed.spawn),
    "delete": ("delete_model", srv.DeleteModel, NAME(srv.DeleteModelRequest)),
    "load environment": ("load_environment", srv.LoadEnvironment, malformed.load_environment),
    "unload environment": ("unload_environment", srv.UnloadEnvironment, NAME(srv.UnloadEnvironmentRequest)),
    "save state outside": ("save_state", srv.SaveState, lambda rng: srv.SaveStateRequest(rng.choice(("", "/etc/a", "/var/tmp/a", "../../../../../../etc/a", "/tmp/../etc/a", "/tmp")))),
    "restore state outside": ("restore_state", srv.RestoreState, lambda rng: srv.RestoreStateRequest(rng.choice(malformed.OUTSIDE + ("",)))),
    "record outside": ("start_record", srv.StartRecord, lambda rng: srv.StartRecordRequest(rng.choice(malformed.OUTSIDE + ("",)))),
    "stop record": ("stop_record", srv.StopRecord, lambda rng: srv.StopRecordRequest()),
    "body wrench": ("apply_body_wrench", srv.ApplyBodyWrench, malformed.wrench),
    "joint effort": ("apply_joint_effort", srv.ApplyJointEffort, malformed.effort),
    "set model state": ("set_model_state", srv.SetModelState, lambda rng: srv.SetModelStateRequest(malformed.model_state(rng))),
    "set link state": ("set_link_state", srv.SetLinkState, lambda rng: srv.SetLinkStateRequest(malformed.link_state(rng))),
    "model configuration": ("set_model_configuration", srv.SetModelConfiguration, malformed.configuration),
    "physics properties": ("set_physics_properties", srv.SetPhysicsProperties, malformed.physics),
    "link properties": ("set_link_properties", srv.SetLinkProperties, malformed.link_properties),
    "joint properties": ("set_joint_properties", srv.SetJointProperties, malformed.joint_properties),
    "get model state": ("get_model_state", srv.GetModelState, lambda rng: srv.GetModelStateRequest(malformed.name(rng), "")),
    "get link state": ("get_link_state", srv.GetLinkState, lambda rng: srv.GetLinkStateRequest("cube::link", rng.choice(malformed.NAMES[1:]))),
    "get model properties": ("get_model_properties", srv.GetModelProperties, NAME(srv.GetModelPropertiesRequest)),
    "get link properties": ("get_link_properties", srv.GetLinkProperties, NAME(srv.GetLinkPropertiesRequest)),
    "get joint properties": ("get_joint_properties", srv.GetJointProperties, NAME(srv.GetJointPropertiesRequest)),
    "light": ("set_light_properties", srv.SetLightProperties, NAME(lambda name: srv.SetLightPropertiesRequest(light_name=name))),
    "delete light": ("delete_light", srv.DeleteLight, NAME(srv.DeleteLightRequest)),
    "step with commands": ("step_with_commands", srv.StepWithCommands, malformed.step_with_commands),
    "attach": ("attach", srv.Attach, lambda rng: srv.AttachRequest(rng.choice(malformed.NAMES + ("ground",)), "arm_on_base::hand", 0.0, 0.0)),
    "attach with limits": ("attach", srv.Attach, lambda rng: srv.AttachRequest("cube", "arm_on_base::hand", rng.choice(malformed.NO_NUMBERS[:1] + (-1.0,)), 0.0)),
    "detach": ("detach", srv.Detach, NAME(srv.DetachRequest)),
    "reset model": ("reset_model", srv.ResetModel, NAME(srv.ResetModelRequest)),
    "switch controller": ("/controller_manager/switch_controller", srv.SwitchController, malformed.switch),
    "load controller": ("/controller_manager/load_controller", srv.LoadController, NAME(srv.LoadControllerRequest)),
    "unload controller": ("/controller_manager/unload_controller", srv.UnloadController, NAME(srv.UnloadControllerRequest)),
}
LYING = ("spawn_urdf_model", "load_environment", "apply_body_wrench", "set_model_configuration", "step_with_commands", "get_model_state")


def raw_service(kind):
    """A service type whose requests are bytes."""
    raw = malformed.raw_type(kind._request_class)
    return type(kind.__name__, (kind,), {"_request_class": raw}), raw


class Hostile(object):
    """Sends what is wrong, and counts what is answered and what was sent to topics."""

    def __init__(self, seed, folder):
        self.rng = random.Random(seed)
        self.sent, self.answered, self.unanswered = {}, {}, []
        valid = malformed.valid_messages()
        self.raw = {topic: malformed.raw_type(type(message)) for topic, message in valid.items()}
        self.publishers = {topic: rospy.Publisher(name, self.raw[topic], queue_size=100) for topic, name in TOPICS.items()}
        # Not by a SimpleActionClient, which loses a result that comes before its send_goal is through.
        self.goals = rospy.Publisher(ACTION + "/goal", msg.FollowJointTrajectoryActionGoal, queue_size=10)
        self.results = Recorder(ACTION + "/result", msg.FollowJointTrajectoryActionResult)
        wait_until(lambda: self.goals.get_num_connections() and self.results.connected(), "the action's server")
        wait_until(lambda: all(publisher.get_num_connections() for publisher in self.publishers.values()), "the node to listen")
        self.state_file = os.path.join(folder, "spoiled.state")
        state = os.path.join(folder, "whole.state")
        answer = service("save_state", srv.SaveState)(state)
        assert answer.success, answer.status_message
        with open(state, "rb") as stream:
            self.state = stream.read()

    def kinds(self):
        kinds = {"message " + topic: lambda topic=topic: self.send(topic, MESSAGES[topic](self.rng)) for topic in TOPICS}
        kinds.update({"lying message " + topic: lambda topic=topic: self.lie(topic) for topic in TOPICS})
        kinds.update({kind: lambda kind=kind: self.call(kind, *REQUESTS[kind]) for kind in REQUESTS})
        kinds.update({"lying request " + name: lambda name=name: self.lie_to_service(name) for name in LYING})
        kinds["restore state"] = self.restore
        kinds["goal"] = self.goal
        return kinds

    def send(self, topic, message, raw=None):
        out = self.raw[topic]()
        buff = malformed.io.BytesIO()
        message.serialize(buff)
        out.raw = buff.getvalue() if raw is None else raw
        self.sent[topic] = self.sent.get(topic, 0) + 1
        self.publishers[topic].publish(out)

    def lie(self, topic):
        message = malformed.valid_messages()[topic]
        self.send(topic, message, malformed.lying(message, self.rng))

    def note(self, kind, refused, text):
        self.answered[kind] = self.answered.get(kind, 0) + 1
        if not refused or "\n" in text or len(text) > 3000:
            self.unanswered.append("%s: %.300s" % (kind, text))

    def call(self, kind, name, service_type, make):
        request = make(self.rng)
        answer = rospy.ServiceProxy(name if name.startswith("/") else sim_client.NODE + "/" + name, service_type)(request)
        if hasattr(answer, "ok"):
            return self.note(kind, not answer.ok, "ok: %s" % answer.ok)
        self.note(kind, not answer.success and len(answer.status_message) > 10, answer.status_message + "" if not answer.success else "taken: %.300r" % request)

    def lie_to_service(self, name):
        kind = next(row for row in REQUESTS.values() if row[0] == name)[1]
        request = kind._request_class()
        for slot in request.__slots__:
            if isinstance(getattr(request, slot), str):
                setattr(request, slot, "text")
            elif slot in ("joint_names", "joint_positions"):
                setattr(request, slot, ["shoulder"] if slot == "joint_names" else [0.5])
        if name == "step_with_commands":
            request.commands = [msg.RobotCommand("arm_on_base", malformed.valid_messages()["joint_command"])]
        raw_type, raw = raw_service(kind)
        out = raw()
        out.raw = malformed.lying(request, self.rng)
        try:
            answer = rospy.ServiceProxy(sim_client.NODE + "/" + name, raw_type)(out)
            self.note("lying request", not answer.success, answer.status_message)
        except rospy.ServiceException as error:
            self.note("lying request", True, str(error).replace("\n", " "))

    def restore(self):
        with open(self.state_file, "wb") as stream:
            stream.write(malformed.spoiled_state(self.state, self.rng))
        answer = service("restore_state", srv.RestoreState)(self.state_file)
        self.note("restore state", not answer.success and len(answer.status_message) > 10, answer.status_message)

    def goal(self):
        goal = msg.FollowJointTrajectoryActionGoal(goal=malformed.goal(self.rng))
        goal.goal_id.id = "goal %d" % self.answered.get("goal", 0)
        mine = lambda: [result.status for result in self.results.messages() if result.status.goal_id.id == goal.goal_id.id]
        self.goals.publish(goal)
        wait_until(mine, "an answer to %s" % goal.goal)
        refused = mine()[0].status == GoalStatus.REJECTED and len(mine()[0].text) > 10
        self.note("goal", refused, mine()[0].text if refused else "taken: %.500s" % str(goal.goal).replace("\n", " "))
        self.results.clear()


def counted(diagnostics):
    """Messages that /diagnostics says were refused, by topic."""
    counts = {}
    for status in [status for message in diagnostics.messages()[-5:] for status in message.status]:
        for value in status.values:
            if "blem_sim" in status.name and value.key.endswith(" refused"):
                counts[value.key[:-len(" refused")]] = int(value.value)
            if "blem_sim" in status.name and value.key in ("live clouds refused", "live clouds overtaken by newer ones", "live clouds accepted"):
                counts[value.key] = int(value.value)
    return counts


class HostileInputTest(unittest.TestCase):
    requests, seed = 800, 1

    def setUp(self):
        self.folder = temporary_folder(self)
        os.symlink("/etc/hostname", os.path.join(self.folder, "link.stl"))
        malformed.OUTSIDE += (os.path.join(self.folder, "link.stl"),)
        self.hostile = Hostile(self.seed, self.folder)
        self.reports = Recorder("/blem_sim/step_report", msg.StepReport)
        self.diagnostics = Recorder("/diagnostics", DiagnosticArray)
        self.reports.wait_for(1)
        service("unpause_physics", Empty)()

    def place(self, node="/blem_sim"):
        return rospy.ServiceProxy(node + "/get_model_state", srv.GetModelState)("arm_on_base", "").pose.position

    def test_nothing_is_lost_moved_or_left_unanswered(self):
        kinds = self.hostile.kinds()
        self.assertGreaterEqual(len(kinds), 40)
        before, start = self.place(), time.time()
        names = sorted(kinds)
        for i in range(self.requests):
            kinds[names[i % len(names)]]()
        seconds = time.time() - start
        self.assertEqual(self.hostile.unanswered, [])
        self.check_counts()
        after = self.place()
        self.assertLess(max(abs(after.x - before.x), abs(after.y - before.y), abs(after.z - before.z)), UNMOVED)
        self.check_steps()
        self.check_bits()
        print("%d requests and messages of %d kinds in %.0f s" % (self.requests, len(kinds), seconds))

    def check_counts(self):
        """Every message to a topic and every goal was counted as refused; clouds that a newer one overtook are counted as such."""
        of_goals = lambda: counted(self.diagnostics).get("/joint_trajectory_controller/follow_joint_trajectory", 0)
        wait_until(lambda: of_goals() == self.hostile.answered["goal"], "%d goals to be counted, got %%s" % self.hostile.answered["goal"], of_goals)
        for topic, sent in self.hostile.sent.items():
            if topic == "points":
                of_clouds = lambda: sum(counted(self.diagnostics).get(key, 0) for key in ("live clouds refused", "live clouds overtaken by newer ones", "/points"))
                wait_until(lambda: of_clouds() == sent, "%d clouds to be counted, got %%s" % sent, of_clouds)
                self.assertEqual(counted(self.diagnostics)["live clouds accepted"], 0)
            else:
                of_topic = lambda: counted(self.diagnostics).get(TOPICS[topic], 0)
                wait_until(lambda: of_topic() == sent, "%d messages on %s to be counted, got %%s" % (sent, topic), of_topic)

    def check_steps(self):
        reports = self.reports.messages()
        self.assertGreater(len(reports), 10)
        for earlier, later in zip(reports, reports[1:]):
            self.assertEqual(later.step, earlier.step + later.steps)

    def check_bits(self):
        sim_client.pause()
        end = service("step_with_commands", srv.StepWithCommands)(1, [])
        twin = rospy.ServiceProxy("/undisturbed/step_with_commands", srv.StepWithCommands)
        made = twin(0, []).step
        seen = twin(end.step - made, [])
        self.assertEqual((seen.step, seen.state_hash), (end.step, end.state_hash))


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--requests", type=int, default=800)
    parser.add_argument("--seed", type=int, default=1)
    arguments, _ = parser.parse_known_args()
    HostileInputTest.requests, HostileInputTest.seed = arguments.requests, arguments.seed
    rospy.init_node("hostile_input_test", disable_rostime=True)
    rostest.rosrun("blem_sim", "hostile_input", HostileInputTest)
