# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Each way in which an element is left out, with each reference by which another one needs it."""

from itertools import product
import re

from deadline import DEADLINE_S
import numpy as np
import pytest
from sdf_texts import (
    element,
    fixed_joint,
    joint,
    LINK,
    model_file,
    world_file,
    write_files,
)

from sdf_pose_bridge import load, SdfError
from sdf_pose_bridge.limited_process import LimitedProcess
from sdf_pose_bridge.process_limits import Allowance
from sdf_pose_bridge.sdformat.grammar import definition_of, PARTS_OF_MODEL

AMPLE = Allowance(processor_s=DEADLINE_S, memory_bytes=2_000_000_000)
"""An endless load exceeds it."""

AT = 'x::tool'
"""The link that each reference names; the model ``x`` is included."""

X = '<link name="tool">{}</link><link name="b"/>' + joint(
    '<parent>tool</parent><child>b</child><axis><xyz>0 0 1</xyz></axis>', 'lift', 'prismatic')
FILES = {
    name: model_file(content).replace('"m"', '"x"') for name, content in {
        'good': X.format(''), 'bad': X.format('<pose>1 2</pose>'),
        'partial': '<link name="b"/><include><uri>none.sdf</uri></include>'}.items()}

GOOD = '<include><uri>good.sdf</uri></include>'
WRONG = '<experimental:params><link element_id="no" action="modify"/></experimental:params>'
WAYS = {
    'kept': (GOOD, ''),
    'missing': ('<include><uri>none.sdf</uri><name>x</name></include>', 'URI_LOOKUP'),
    'missing without a name': ('<include><uri>none.sdf</uri></include>', 'URI_LOOKUP'),
    'missing, merged': ('<include merge="true"><uri>none.sdf</uri></include>', 'URI_LOOKUP'),
    'missing in a model': (
        '<model name="x"><link name="b"/><include><uri>none.sdf</uri></include></model>',
        'URI_LOOKUP'),
    'missing in a file': ('<include><uri>partial.sdf</uri></include>', 'URI_LOOKUP'),
    'fault in the file': ('<include><uri>bad.sdf</uri></include>', 'ELEMENT_INVALID'),
    'refused parameters': (GOOD.replace('</uri>', f'</uri>{WRONG}'), 'ELEMENT_MISSING'),
    'not there': ('', '_INVALID'),
}
"""What stands for the model ``x``, and the end of the code of all errors."""

K = '<link name="k"/>'
ENDS = '<parent>l</parent><child>k</child>'
AXIS = '<axis><xyz>0 0 1</xyz></axis>'
EXPRESSED = AXIS.replace('<xyz', f'<xyz expressed_in="{AT}"')
MIMIC = AXIS.replace(
    '</axis>', '<mimic joint="x::lift"><multiplier>1</multiplier><offset>0</offset>'
    '<reference>0</reference></mimic></axis>')
POSE = f'<pose relative_to="{AT}"/>'

PLACES = {
    'model ./placement_frame': '',
    'model ./canonical_link': '',
    'model pose/./relative_to': element('model', 'p', POSE + LINK),
    'link pose/./relative_to': element('link', 'p', POSE),
    'frame ./attached_to': f'<frame name="p" attached_to="{AT}"/>',
    'frame pose/./relative_to': f'{K}<frame name="p" attached_to="k">{POSE}</frame>',
    'joint pose/./relative_to': K + fixed_joint('p', 'l', 'k', POSE),
    'joint parent/': K + fixed_joint('p', AT, 'k'),
    'joint child/': fixed_joint('p', 'l', AT),
    'joint axis/xyz/./expressed_in': K + joint(ENDS + EXPRESSED, 'p', 'revolute'),
    'joint axis2/xyz/./expressed_in': K + joint(
        ENDS + AXIS + EXPRESSED.replace('axis', 'axis2'), 'p', 'universal'),
    'joint axis/mimic/joint': K + joint(ENDS + MIMIC, 'p', 'revolute'),
}
"""For each reference of SDFormat an element ``p`` of the model that has it."""

FOLLOWERS = {
    '': '',
    'placement_frame="p"': '',
    'placement_frame="f"': '<frame name="f"><pose relative_to="p">1 0 0 0 0 0</pose></frame>',
    'placement_frame="g"': '<frame name="g" attached_to="p"/>',
    'canonical_link="h"': fixed_joint('h', 'l', 'p'),
}
"""Attributes of the model, and elements of which ``p`` is the place."""

DEPENDENTS = re.compile('name="([pfgh])"')

MERGED = '<model name="o"><include merge="true"><uri>inner.sdf</uri></include></model>'
HOSTS = {
    'merged': f'<sdf version="1.10">{MERGED}</sdf>', 'world': world_file(MERGED),
    'included': world_file('<include><uri>inner.sdf</uri></include>')}
"""Files that contain the model."""


def test_each_reference_of_the_grammar_is_a_place():
    found = [f'{tag} {path}/{attribute}' for tag, part in PARTS_OF_MODEL.items()
             for path, attribute in part.references]
    of_models = [f'model ./{name}' for name in definition_of('model').attributes
                 if name.endswith(('_frame', '_link'))]
    assert {*found, *of_models, 'joint axis/mimic/joint'} == set(PLACES)


def problems_with(path, *, skips, code, kept, left_out):
    """
    Load a file.

    :param code: the end of the code of all errors; empty if there is none.
    :param kept: last names of elements that are read.
    :param left_out: last names of elements that are not.
    :return: what is not as it must be.
    """
    try:
        scene = load(path, on_missing_include='skip' if skips else 'error')
    except SdfError as error:
        return [str(each) for each in error.errors if not code or not each.code.endswith(code)]
    names = {name.rpartition('::')[2] for name in scene.names}
    is_whole = np.isfinite(scene.poses).all(axis=1) & (
        (scene.references >= 0) == (scene.parents >= 0))
    return [*(['it is read'] if code else []), *kept - names, *left_out & names, *(
        name for name, each in zip(scene.names, is_whole, strict=True) if not each)]


def all_problems(folder, way, place):
    """Load all files for a way and a place; return what is not as it must be."""
    text, code = WAYS[way]
    of_model = {f'{place[8:]}="{AT}"': ''} if place.startswith('model ./') else FOLLOWERS
    write_files(folder, **FILES)
    found = []
    for attribute, more in of_model.items():
        write_files(folder, **HOSTS, inner=model_file(
            f'{LINK}{text}{PLACES[place]}{more}', attributes=attribute))
        dependents = set(DEPENDENTS.findall(PLACES[place] + more))
        for host, skips in product(('inner', *HOSTS), (False, True)):
            path = folder / f'{host}.sdf'
            if skips and code == 'URI_LOOKUP':
                # With its canonical link or placement frame, the model is left out.
                problems = problems_with(
                    path, skips=skips, code='', kept=set() if attribute else {'l'},
                    left_out=dependents | ({'l'} if attribute else set()))
            else:
                problems = problems_with(
                    path, skips=skips, code=code, kept=dependents | {'l'}, left_out=set())
            found += [(attribute, host, skips, each) for each in problems]
    return found


@pytest.fixture(scope='module', name='process')
def make_process():
    process = LimitedProcess()
    yield process
    process.close()


@pytest.mark.parametrize('place', PLACES)
@pytest.mark.parametrize('way', WAYS)
def test_what_needs_an_element_that_is_left_out(process, tmp_path, way, place):
    assert process.call(AMPLE, all_problems, tmp_path, way, place) == []
