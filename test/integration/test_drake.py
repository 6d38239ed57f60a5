# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A bridge beside a simulator of physics that reads the same file."""

import json
from pathlib import Path
import subprocess
import sys

from processes import started
import pytest

pytest.importorskip('simulation_interfaces', reason='needs simulation_interfaces')

from matrices import matrix_from_pose
import numpy as np
from simulator import Simulator
from sizes import size

DRAKE = Path(sys.prefix) / 'drake/bin/python'
BALL = """<model name="ball{number}"><pose>{number} 0 2 0.3 0.2 {number}</pose>
<link name="body"><pose>0 0 0.05 0 0 0.4</pose><inertial><mass>1</mass><inertia>
<ixx>0.004</ixx><iyy>0.004</iyy><izz>0.004</izz></inertia></inertial>
<collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>
</link></model>"""
WORLD = f"""<sdf version="1.11"><world name="yard">
<model name="floor"><static>true</static><link name="slab"><pose>0 0 -0.5 0.02 0 0</pose>
  <collision name="c"><geometry><box><size>50 50 1</size></box></geometry></collision></link>
</model>
{''.join(BALL.format(number=number) for number in range(4))}
<model name="cart"><pose>-1 0 0.5 0 0.1 0.2</pose>
  <link name="base"><pose>0 0 0.1 0 0 0</pose>
    <collision name="c"><geometry><box><size>0.4 0.4 0.2</size></box></geometry></collision></link>
  <link name="arm"><pose>0.2 0 0.3 0 0 0</pose></link>
  <joint name="swing" type="revolute"><pose>-0.1 0 -0.1 0 0 0</pose>
    <parent>base</parent><child>arm</child><axis><xyz>0 1 0</xyz></axis></joint>
  <link name="tip"><pose>0.4 0 0.3 0 0.5 0</pose></link>
  <joint name="reach" type="prismatic">
    <parent>arm</parent><child>tip</child><axis><xyz>1 0 0.2</xyz></axis></joint>
  <model name="crate"><pose>0 0 0.6 0 0 0</pose><link name="box">
    <collision name="c"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>
  </link></model>
</model>
</world></sdf>"""


@pytest.mark.skipif(not DRAKE.exists(), reason='needs Drake, which make drake installs')
def test_links_are_where_a_simulator_has_them(start_bridge, tf, joints, tmp_path):
    path = tmp_path / 'yard.sdf'
    path.write_text(WORLD)
    program = Path(__file__).with_name('drake_world.py')
    simulator = Simulator(tf, prefix='')
    start_bridge(
        sdf_file=path, simulator='/', simulator_rate=100.0, use_joint_states=True,
    ).wait_until_started()
    largest = 0.0
    with started(
            [DRAKE, program, path], env={}, text=True, stdin=subprocess.PIPE,
            stdout=subprocess.PIPE) as drake:
        for step in range(size(10, 300)):
            print(0.01 * step, file=drake.stdin, flush=True)
            state = json.loads(drake.stdout.readline())
            simulator.entities, simulator.sec = state['models'], 10_000 * (step + 1)
            joints.send(state['joints'], sec=simulator.sec, topic='cart/joint_states')
            del state['links']['floor::slab']
            for link, pose in state['links'].items():
                frame, found = link.replace('::', '/'), np.eye(4)
                tf.listener.wait(
                    lambda frame=frame: frame in tf.last and (
                        tf.last[frame].header.stamp.sec >= simulator.sec - 9000),
                    lambda frame=frame: f'{frame}, last were {tf.last}')
                while frame != 'world':
                    last = tf.last[frame]
                    xyz, quat = last.transform.translation, last.transform.rotation
                    found = matrix_from_pose(
                        [xyz.x, xyz.y, xyz.z, quat.x, quat.y, quat.z, quat.w]) @ found
                    frame = last.header.frame_id
                largest = max(largest, np.abs(found - matrix_from_pose(pose)).max())
        drake.stdin.close()
    assert largest < 1e-12
