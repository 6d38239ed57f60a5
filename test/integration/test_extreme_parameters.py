# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Every parameter with extreme values, while somebody else asks."""

import math
import os
from pathlib import Path

from changes import asked, asked_to_set, call, world
from rcl_interfaces.srv import GetParameters

from sdf_pose_bridge.ros.parameters.declarations import DECLARATIONS
from sdf_pose_bridge.ros.parameters.rules import MOST_VALUES
from sdf_pose_bridge_interfaces.srv import LookupPose

MODELS = 20_000
LARGEST_RATIO = 10.0
"""Largest ratio of the processor time for the longest texts to that for the shortest ones."""

TEXTS = ('x', '*', '::', '{model}', '/', 'x,', '<')


def repeated(text, length):
    """Return a text of a length that repeats another one."""
    return (text * (length // len(text) + 1))[:length]


def extreme_values(declaration):
    """Return values of the type of a parameter; the last one is too large if one can be."""
    default, most = declaration.default, declaration.most_characters
    if isinstance(default, bool):
        return [not default, default]
    if isinstance(default, float):
        return [0.0, declaration.maximum, -1.0, 1e-300, math.nan, math.inf, 1e300]
    texts = [repeated(each, most) for each in TEXTS]
    if isinstance(default, str):
        return ['', *texts, 'x' * (most + 1)]
    return [[], *([each] * MOST_VALUES for each in texts), [''] * (MOST_VALUES + 1),
            ['x' * (most + 1)]]


def response_while_others_ask(listener, **values):
    """Set parameters while another client asks; return the result when both are answered."""
    answers = [asked_to_set(listener, **values), asked(listener, GetParameters, names=['watch'])]
    results, other = map(listener.response, answers)
    assert len(other.values) == 1
    assert len({each.successful for each in results.results}) == 1
    return results.results[0]


def accepted_values(listener):
    """Set each parameter to each extreme value; return those of each that are accepted."""
    accepted = {name: [] for name in DECLARATIONS}
    for name, declaration in DECLARATIONS.items():
        for value in extreme_values(declaration):
            # The file is that of the other parameter.
            others = {'sdf_file': ''} if name == 'robot_description' and value else {}
            result = response_while_others_ask(listener, **{name: value, **others})
            if result.successful:
                accepted[name].append(value)
            else:
                assert 0 < len(result.reason) < 2000
    return accepted


def processor_s(pid):
    """Return the processor time of a process and of those that it has started."""
    stat = Path(f'/proc/{pid}/stat').read_text(encoding='ascii').rpartition(')')[2].split()
    children = Path(f'/proc/{pid}/task/{pid}/children').read_text(encoding='ascii').split()
    own = sum(map(int, stat[11:15])) / os.sysconf('SC_CLK_TCK')
    return own + sum(map(processor_s, children))


def shortened(value):
    """Return a value with one short text instead of others."""
    if isinstance(value, list):
        return [shortened(each) for each in value[:1]]
    return value[:1] if isinstance(value, str) else value


def test_extreme_values_are_answered_while_others_ask(
        start_bridge, start_listener, tmp_path, file):
    bridge, listener = start_bridge(sdf_file=file).wait_until_started(), start_listener()
    accepted = accepted_values(listener)
    large = tmp_path / 'large.sdf'
    large.write_text(world(1, extra=''.join(
        f'<model name="m{number}"><link name="l"/></model>' for number in range(MODELS))))
    always = {'sdf_file': str(large), 'model_pose_topics': ['/poses']}
    calls = [
        {name: values[number % len(values)] for name, values in accepted.items() if values}
        for number in range(max(map(len, accepted.values())))]
    spent = []
    for values in ({name: shortened(value) for name, value in calls[1].items()}, *calls):
        before = processor_s(bridge.pid)
        result = response_while_others_ask(listener, **{**values, **always})
        assert result.successful, result.reason
        call(listener, LookupPose, frame='m1')
        spent.append(processor_s(bridge.pid) - before)
    assert max(spent) < LARGEST_RATIO * spent[0]
    assert bridge.is_running
    assert bridge.count_of('internal error') == 0
