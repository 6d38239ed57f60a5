# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose graph``: nodes, arrows, and the program that draws them."""

import re

import needs
import pytest
from sdf_texts import model_file

from sdf_pose_bridge import Kind, load_text
from sdf_pose_bridge.cli.graph import _STYLES, dot_from_scene

ARM = """
<link name="base"/>
<link name="hand"><pose relative_to="j"/></link>
<joint name="j" type="revolute"><pose relative_to="base"/><parent>base</parent><child>hand</child>
  <axis><xyz>0 0 1</xyz></axis></joint>
<joint name="k" type="fixed"><parent>base</parent><child>eye</child></joint>
<link name="eye"/>
<frame name="tip" attached_to="hand"/>
<frame name="tap" attached_to="hand"><pose relative_to="base"/></frame>
<frame name="top"/>
"""
NODE = re.compile(r' n(\d+) \[label="((?:[^"\\]|\\.)*)"')
EDGE = re.compile(r' n(\d+) -> n(\d+) \[color="([^"]*)"')


def dot_of(content, **options):
    return dot_from_scene(load_text(model_file(content)), **options)


def labels_in(dot):
    return dict(NODE.findall(dot))


def arrows_to(name, dot):
    """Return the names and colors of arrows that lead to a node."""
    labels = {number: label.split(r'\n')[0] for number, label in labels_in(dot).items()}
    return {labels[start]: colors for start, end, colors in EDGE.findall(dot)
            if labels[end] == name}


@pytest.mark.parametrize('kind', _STYLES.keys() - {Kind.ROOT})
def test_legend_explains_the_colour_of_each_kind(kind):
    label = re.search('label="(.*)"', dot_of(ARM))[1]
    assert re.search(f' {kind.label}s[,.\\\\]', label.partition('Boxes')[2])


def test_missing_program_is_an_error_of_one_line(refused, monkeypatch):
    monkeypatch.setenv('PATH', '')
    assert refused('graph', 'good.sdf', '-o', 'graph.svg').startswith(
        'sdf_pose graph: the program dot is not installed; ')


def test_names_are_escaped(run_on):
    dot = run_on(model_file('<link name="&quot;];\\N&#10;x"/>'), 'graph').stdout
    assert r'[label="\"];\\N\\nx" ' in dot


def test_graph_is_written_without_the_program(run_main, files, monkeypatch):
    monkeypatch.setenv('PATH', '')
    assert run_main('graph', 'good.sdf', '-o', 'graph.dot').returncode == 0
    assert (files / 'graph.dot').read_text() == run_main('graph', 'good.sdf').stdout


def test_nodes_are_frames_and_the_root():
    assert sorted(labels_in(dot_of(ARM)).values()) == sorted([
        '__root__', 'm', 'base', 'hand', r'j\nrevolute', r'k\nfixed', 'eye', 'tip', 'tap', 'top'])


def test_arrows_come_from_references_attachments_and_joints():
    dot, arrows = dot_of(ARM), {
        'base': {'m': 'gray70'}, 'top': {'m': 'gray70'}, 'k': {'base': 'black'},
        'eye': {'k': 'black', 'm': 'gray70'}, 'j': {'base': 'black:royalblue'},
        'hand': {'j': 'black:royalblue'}, 'tip': {'hand': 'forestgreen'},
        'tap': {'hand': 'forestgreen', 'base': 'royalblue'}}
    assert {name: arrows_to(name, dot) for name in arrows} == arrows


def test_kinds_are_chosen_with_what_they_are_relative_to():
    dot = dot_of('<link name="l"><visual name="v"><geometry><empty/></geometry></visual></link>',
                 kinds=[Kind.VISUAL])
    assert list(labels_in(dot).values()) == ['l', 'v']


def test_models_are_boxes_in_one_another():
    dot = dot_of('<link name="a"/><model name="n"><link name="b"/></model><link name="c"/>')
    order = [label or box for box, label in re.findall(
        r'(subgraph|^ *}$)|label="(\w+)" shape', dot, re.MULTILINE)]
    assert [word.strip() for word in order] == [
        '__root__', 'subgraph', 'm', 'a', 'subgraph', 'n', 'b', '}', 'c', '}', '}']


@pytest.mark.parametrize(('name', 'start'), [('g.svg', b'<?xml'), ('g.PNG', b'\x89PNG')])
def test_graph_is_drawn(run_main, files, name, start):
    needs.program('dot')
    done = run_main('graph', 'good.sdf', '-o', name)
    assert (done.returncode, done.stderr) == (0, '')
    assert (files / name).read_bytes().startswith(start)
