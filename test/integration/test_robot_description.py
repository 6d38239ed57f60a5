# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Text instead of a file, and the topic that has it, seen by listeners in another process."""

from changes import (
    listen_to_tf,
    reason_for_refusal,
    reload,
    replace,
    set_parameters,
    wait_for_x,
    world,
)
from listener import latched
import pytest
from std_msgs.msg import String


def model(x):
    return (
        '<sdf version="1.10">\n<model name="crate"><static>true</static>\n'
        f'<link name="body"><pose>{x} 0 0 0 0 0</pose></link></model></sdf>')


FILE_TEXT = model(1)


def texts_of(listener):
    texts = []
    listener.node.create_subscription(
        String, '/robot_description', lambda message: texts.append(message.data), latched(1))
    return texts


def wait_for_text(listener, texts, text):
    listener.wait(lambda: texts[-1:] == [text], texts)


def topics_of(listener):
    return [name for name, _ in listener.node.get_topic_names_and_types()]


@pytest.fixture
def listener(bridge, start_listener):
    listener = start_listener()
    listen_to_tf(listener)
    wait_for_x(listener, 1.0, 'body')
    return listener


def test_the_text_of_a_file_is_published_again_after_a_reload(file, listener, start_listener):
    set_parameters(listener, watch=False)
    texts = texts_of(listener)
    wait_for_text(listener, texts, model(1))
    replace(file, model(2))
    assert reload(listener).success
    wait_for_text(listener, texts, model(2))
    late = start_listener()
    wait_for_text(late, texts_of(late), model(2))
    # An included file may be another one, of which the text says nothing.
    texts.clear()
    assert reload(listener).success
    wait_for_text(listener, texts, model(2))


def test_a_text_takes_the_place_of_a_file_and_is_judged_before(file, listener):
    texts = texts_of(listener)
    assert 'sdf_file and robot_description are both set' in reason_for_refusal(
        listener, robot_description=model(2))
    wrong = model(2).replace('<pose>', '<pose relative_to="x">')
    assert reason_for_refusal(listener, sdf_file='', robot_description=wrong).startswith(
        'robot_description:3: POSE_RELATIVE_TO_INVALID')
    set_parameters(listener, sdf_file='', robot_description=model(2))
    wait_for_x(listener, 2.0, 'body')
    wait_for_text(listener, texts, model(2))
    set_parameters(listener, sdf_file=str(file), robot_description='')
    wait_for_x(listener, 1.0, 'body')
    wait_for_text(listener, texts, model(1))
    assert wrong not in texts


def test_there_is_no_topic_for_a_world_or_if_it_is_switched_off(file, listener):
    def has_topic():
        return '/robot_description' in topics_of(listener)

    listener.wait(has_topic, lambda: topics_of(listener))
    set_parameters(listener, publish_robot_description=False)
    listener.wait(lambda: not has_topic(), lambda: topics_of(listener))
    set_parameters(listener, publish_robot_description=True)
    listener.wait(has_topic, lambda: topics_of(listener))
    replace(file, world(1))
    listener.wait(lambda: not has_topic(), lambda: topics_of(listener))


def test_urdf_is_made_of_the_model_and_again_after_each_change(
        bridge, file, listener, start_listener):
    texts = texts_of(listener)
    wait_for_text(listener, texts, model(1))
    set_parameters(listener, description_format='urdf')
    listener.wait(lambda: '<origin xyz="1 0 0" rpy="0 0 0"/>' in texts[-1], texts)
    assert texts[-1].startswith('<?xml version="1.0"?>\n<robot name="crate">')
    replace(file, model(2))
    listener.wait(lambda: '<origin xyz="2 0 0" rpy="0 0 0"/>' in texts[-1], texts)
    # What cannot be URDF has no topic, and its frames are published all the same.
    replace(file, world(3).replace('</world>', '<model name="n"><link name="l"/></model></world>'))
    bridge.wait_for_line('there is no robot_description, because no URDF can be made')
    wait_for_x(listener, 3.0)
    late = start_listener()
    late_texts = texts_of(late)
    set_parameters(listener, model='n')
    late.wait(lambda: late_texts and '<robot name="n">' in late_texts[-1], lambda: late_texts)
