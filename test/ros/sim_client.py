"""What the rostests share: a recorder of topics, and the simulation's services."""
import tempfile
import threading
import time
from xmlrpc.client import ServerProxy

import rosgraph
import rospy
from std_srvs.srv import Empty

from blem_sim.srv import LoadEnvironment, Step, UnloadEnvironment

NODE = "/blem_sim"
# [s] wall time after which a test gives up waiting; long, since machines are shared.
PATIENCE = 60.0
SETTLE = 0.3  # [s] until what was published before a pause has come


class Recorder(object):
    """Keeps every message of a topic."""

    def __init__(self, topic, message_type):
        self.topic = topic
        self._messages = []
        self._lock = threading.Lock()
        self._subscriber = rospy.Subscriber(topic, message_type, self._on_message)

    def _on_message(self, message):
        with self._lock:
            self._messages.append(message)

    def messages(self):
        with self._lock:
            return list(self._messages)

    def clear(self):
        with self._lock:
            self._messages = []

    def connected(self):
        """Whether messages come through: the node's side of a connection stands a moment after the subscriber's."""
        return self._subscriber.get_num_connections() > 0 and (not publishes(NODE, self.topic) or sends_here(NODE, self.topic))

    def wait_for(self, count):
        """The first `count` messages; fails the test if they do not come."""
        wait_until(lambda: len(self.messages()) >= count, "%d messages on %s, got %%s" % (count, self.topic), lambda: len(self.messages()))
        return self.messages()

    def stop(self):
        self._subscriber.unregister()


def newest_status(diagnostics, name):
    """Values of the node's status that ends in this name, as they are from now on. diagnostics: Recorder of /diagnostics"""
    diagnostics.clear()

    def latest():
        statuses = [status for message in diagnostics.messages() for status in message.status if status.name.endswith(name)]
        return {pair.key: pair.value for pair in statuses[-1].values} if statuses else None

    wait_until(latest, "diagnostics of " + name)
    return latest()


def master():
    return rosgraph.Master(rospy.get_name())


def publishes(node, topic):
    publishers, _, _ = master().getSystemState()
    return node in dict(publishers).get(rospy.resolve_name(topic), [])


def sends_here(node, topic):
    """Whether a node's side of a connection to this process stands."""
    code, text, connections = ServerProxy(master().lookupNode(node)).getBusInfo(rospy.get_name())
    assert code == 1, text
    return any(to == rospy.get_name() and way == "o" and name == rospy.resolve_name(topic) for _, to, way, _, name, *_ in connections)


def record(topic, message_type, count=1):
    """The first messages of a topic, `count` at least."""
    recorder = Recorder(topic, message_type)
    messages = recorder.wait_for(count)
    recorder.stop()
    return messages


def wait_until(condition, text, detail=lambda: ""):
    """Polls on the wall clock; raises AssertionError after PATIENCE."""
    deadline = time.time() + PATIENCE
    while not condition():
        if time.time() > deadline:
            raise AssertionError("waited in vain for " + (text % detail() if "%s" in text else text))
        time.sleep(0.01)


def temporary_folder(test):
    """Path of a folder that goes with the test, below /tmp as the file_roots of the tests' nodes."""
    folder = tempfile.TemporaryDirectory(dir="/tmp")
    test.addCleanup(folder.cleanup)
    return folder.name


def service(name, service_type):
    full_name = NODE + "/" + name
    rospy.wait_for_service(full_name, PATIENCE)
    return rospy.ServiceProxy(full_name, service_type)


def pause():
    service("pause_physics", Empty)()
    time.sleep(SETTLE)


def unpause():
    service("unpause_physics", Empty)()


def step(count):
    answer = service("step", Step)(count)
    assert answer.success, answer.status_message
    return answer


def reset_world():
    service("reset_world", Empty)()


def reset_simulation():
    service("reset_simulation", Empty)()


def load_environment(**request):
    return service("load_environment", LoadEnvironment)(**request)


def unload_environment(name):
    return service("unload_environment", UnloadEnvironment)(name)


def stamps(messages):
    """[s] of messages with a header."""
    return [message.header.stamp.to_sec() for message in messages]
