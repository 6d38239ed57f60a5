# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What tests do to a running bridge, and what they see of it."""

from pathlib import Path
import re
import time

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from listener import latched
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.srv import (
    GetParameters,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)
from rclpy.parameter import Parameter
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

from sdf_pose_bridge_interfaces.srv import LookupPose

BRIDGE = '/sdf_pose_bridge'


def world(x, name='crate', extra=''):
    """Return a file with a model that has one link at x."""
    return f"""<sdf version="1.10">
  <world name="w">
    <model name="{name}"><pose>{x} 0 0 0 0 0</pose><link name="body"/></model>{extra}
  </world>
</sdf>
"""


def replace(path, text):
    """Write a file as editors do: beside it, and then in its place."""
    new = path.with_suffix('.new')
    new.write_text(text)
    new.replace(path)


def listen_to_tf(listener, depth=100):
    listener.node.create_subscription(
        TFMessage, '/tf_static', listener.tf_messages.append, latched(depth))


def last_x(listener, frame='crate/body'):
    found = [each.transform.translation.x for message in listener.tf_messages[-1:]
             for each in message.transforms if each.child_frame_id == frame]
    return found[0] if found else None


def wait_for_x(listener, x, frame='crate/body'):
    listener.wait(lambda: last_x(listener, frame) == x, f'x = {x}')


def asked(listener, service_type, node=BRIDGE, **fields):
    """Call the service that has the name of its type; return the future answer."""
    name = re.sub('(?<=[a-z])(?=[A-Z])', '_', service_type.__name__).lower()
    return listener.ask(service_type, f'{node}/{name}', service_type.Request(**fields))


def call(listener, service_type, **fields):
    """Call that service of the bridge; return the answer."""
    return listener.response(asked(listener, service_type, **fields))


def parameter_value(listener, name):
    (value,) = call(listener, GetParameters, names=[name]).values
    return value


def asked_to_set(listener, node=BRIDGE, **values):
    """Return the future answer to a call that sets parameters."""
    return asked(listener, SetParameters, node, parameters=[
        Parameter(name, value=value).to_parameter_msg() for name, value in values.items()])


def results_of_setting(listener, node=BRIDGE, **values):
    results = listener.response(asked_to_set(listener, node, **values)).results
    assert len(results) == len(values)
    return results


def set_parameters(listener, node=BRIDGE, **values):
    """Set parameters, each of which is accepted."""
    for result in results_of_setting(listener, node, **values):
        assert result.successful, result.reason


def reason_for_refusal(listener, **values):
    """Set parameters, all of which are refused; return the reason."""
    results = results_of_setting(listener, **values)
    assert not any(result.successful for result in results), results
    (reason,) = {result.reason for result in results}
    return reason


def asked_to_reload(listener):
    """Return the future answer to a call that has the file read again."""
    return listener.ask(Trigger, f'{BRIDGE}/reload', Trigger.Request())


def reload(listener):
    return listener.response(asked_to_reload(listener))


class SharedBridge:
    """
    A bridge that is set back to the parameters that it was started with.

    :param process: the bridge.
    :param listener: what sets them.
    """

    def __init__(self, process, listener):
        self._process = process
        self._listener = listener
        names = call(listener, ListParameters).result.names
        values = call(listener, GetParameters, names=names).values
        self._parameters = {
            name: ParameterMessage(name=name, value=value)
            for name, value in zip(names, values, strict=True)}

    def on(self, file):
        """Publish a file, with nothing set and logged before."""
        self._parameters['sdf_file'] = Parameter('sdf_file', value=str(file)).to_parameter_msg()
        # A file that has just been written is read a second time.
        while time.time_ns() - file.stat().st_ctime_ns < 30_000_000:
            time.sleep(0.005)
        answer = call(
            self._listener, SetParametersAtomically, parameters=list(self._parameters.values()))
        assert answer.result.successful, answer.result.reason
        line = self._process.wait_for_line(f' of {file} with ')
        del self._process.lines[:self._process.lines.index(line)]
        return self._process


class Monitor:
    """Keeps the last diagnostic status."""

    def __init__(self, listener):
        self._listener = listener
        self.status = DiagnosticStatus()
        self.count = 0
        listener.node.create_subscription(DiagnosticArray, '/diagnostics', self._take, 10)

    def _take(self, message):
        (self.status,) = message.status
        self.count += 1

    def wait_for(self, level):
        self._listener.wait(lambda: self.status.level == level and self.status.name,
                            lambda: f'level {level}, last was {self.status}')

    def wait_for_more(self):
        """Wait for a status that is sent after this call."""
        count = self.count
        self._listener.wait(lambda: self.count > count + 1, 'diagnostics')
        return self.status


def usage_of(pid):
    """Return resident memory in kB, number of threads and of descriptors of a process."""
    process = Path('/proc', str(pid))
    status = dict(line.split(':', 1) for line in (process / 'status').read_text().splitlines())
    return (int(status['VmRSS'].split()[0]), int(status['Threads']),
            len(list((process / 'fd').iterdir())))


def pose_of(tf, frame):
    """Return the position of a frame in the root, as the bridge looks it up."""
    answer = call(tf.listener, LookupPose, frame=frame)
    assert answer.success, answer.message
    return answer.pose.pose.position
