# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Elements that are read many at a time are those that are read one by one.

Reading one by one knows all rules; reading many at a time has to leave to it whatever is odd.
"""

from pathlib import Path
import sys

from hypothesis import given
from hypothesis import HealthCheck
from hypothesis import settings
from hypothesis import strategies as st
import pytest
from random_scenes import random_scenes
from sdf_texts import model_file
from sdf_texts import world_file

import sdf_pose_bridge
from sdf_pose_bridge import document_reading
from sdf_pose_bridge import regular_part

HERE = Path(__file__).parent
FILES = sorted([*HERE.glob('semantics/*.sdf'), *HERE.parent.glob('examples/**/*.sdf')])

LINK = '<link name="l"><pose>1 2 3 0 0 0</pose></link>'
JOINT = '<joint name="j" type="fixed"><parent>l</parent><child>k</child></joint>'
ODDITIES = (
    '<link name=" k "/>', '<link name="l"/>', '<link/>', '<link name=""/>', '<link name="__k__"/>',
    '<link name="world"/>', '<link name="a b"/>', '<link name="a\tb"/>', '<link name="a&#10;b"/>',
    '<link name="a&amp;b"/>', '<link name="a::b"/>', "<link name='k'/>", '<link name = "k" />',
    '<link a="1" name="k" b="2"/>', '<link xname="x" name="k"/>', '<link\nname="k"\n/>',
    '<link name="größe"/>', '<link name="k>"/>', '<gz:link name="k"/>', '<Link name="k"/>',
    '<link name="k"><pose/></link>', '<link name="k"><pose> </pose></link>',
    '<link name="k"><pose><!-- c -->1 2 3 0 0 0</pose></link>',
    '<link name="k"><pose>1 2 3 <!-- c --> 0 0 0</pose></link>',
    '<link name="k"><pose>1 2 3 0 0</pose></link>', '<link name="k"><pose>a</pose></link>',
    '<link name="k"><pose>&#49; 2 3 0 0 0</pose></link>',
    '<link name="k"><pose><![CDATA[1 2 3 0 0 0]]></pose></link>',
    '<link name="k"><pose>1 2 3 0 0 0</pose><pose>4 5 6 0 0 0</pose></link>',
    '<link name="k"><visual name="v"/><pose>1 2 3 0 0 0</pose></link>',
    '<link name="k"><pose relative_to="l">1 2 3 0 0 0</pose></link>',
    '<link name="k"><pose relative_to=" l ">1 2 3 0 0 0</pose></link>',
    '<link name="k"><pose relative_to="x">1 2 3 0 0 0</pose></link>',
    '<link name="k"><pose relative_to="">1 2 3 0 0 0</pose></link>',
    '<link name="k"><pose relative_to="__root__">1 2 3 0 0 0</pose></link>',
    "<link name=\"k\"><pose relative_to='l'>1 2 3 0 0 0</pose></link>",
    '<link name="k"><pose relative_to="&#108;">1 2 3 0 0 0</pose></link>',
    '<link name="k"><pose degrees="true">1 2 3 90 0 0</pose></link>',
    '<link name="k"><pose degrees=" 1 ">1 2 3 90 0 0</pose></link>',
    '<link name="k"><pose degrees="maybe">1 2 3 90 0 0</pose></link>',
    '<link name="k"><pose rotation_format="quat_xyzw">1 2 3 0 0 0 1</pose></link>',
    '<link name="k"><pose rotation_format="quat_xyzw" degrees="1">1 2 3 0 0 0 1</pose></link>',
    '<link name="k"><pose rotation_format="?">1 2 3 0 0 0</pose></link>',
    '<link name="k"><pose frame="l">1 2 3 0 0 0</pose></link>',
    '<link name="k"><inertial><pose relative_to="l">0 0 1 0 0 0</pose></inertial></link>',
    '<link name="k"><inertial/><inertial><pose>0 0 1 0 0 0</pose></inertial></link>',
    '<link name="k"><visual name="v"/><visual name="v"/><collision name="v"/></link>',
    '<link name="k"><visual name="v"><pose relative_to="x">0 0 1 0 0 0</pose></visual></link>',
    ('<link name="k"><sensor name="s" type="x"><camera><optical_frame_id>o</optical_frame_id>'
     '</camera></sensor></link>'),
    '<link name="k"><sensor type="imu" name="s"><gz_frame_id> i </gz_frame_id></sensor></link>',
    '<link name="k"><visual name="v"><visual name="w"/></visual></link>',
    '<link name="k"/>' + JOINT,
    '<link name="k"/>' + JOINT.replace('fixed', 'Fixed'),
    '<link name="k"/>' + JOINT.replace('fixed', 'wrong'),
    '<link name="k"/>' + JOINT.replace('type="fixed"', ''),
    '<link name="k"/>' + JOINT.replace('<parent>l</parent>', ''),
    '<link name="k"/>' + JOINT.replace('>l<', '> l <'),
    '<link name="k"/>' + JOINT.replace('>l<', '>l\nl<'),
    '<link name="k"/>' + JOINT.replace('>l<', '><!-- c -->l<'),
    '<link name="k"/>' + JOINT.replace('>l<', '>world<'),
    '<link name="k"/>' + JOINT.replace('>l<', '>__root__<'),
    '<link name="k"/>' + JOINT.replace('>l<', '>__model__<'),
    '<link name="k"/>' + JOINT.replace('>l<', '><x/><'),
    '<link name="k"/>' + JOINT.replace('>k<', '>l<'),
    '<link name="k"/>' + JOINT.replace('</child>', '</child><child>l</child>'),
    '<link name="k"/>' + JOINT.replace(
        '</joint>', '<axis><xyz expressed_in="k">0 0 1</xyz></axis></joint>'),
    '<link name="k"/>' + JOINT.replace(
        '</joint>', '<axis><xyz expressed_in=" x ">0 0 1</xyz></axis></joint>'),
    '<link name="k"/>' + JOINT.replace(
        '</joint>', '<axis><xyz>0 0 1</xyz>'
        '<use_parent_model_frame>true</use_parent_model_frame></axis></joint>'),
    '<link name="k"/>' + JOINT.replace(
        '</joint>', '<axis><use_parent_model_frame>0</use_parent_model_frame>'
        '<xyz expressed_in="x">0 0 1</xyz></axis><axis2><xyz>0 1 0</xyz></axis2></joint>'),
    '<link name="k"/>' + JOINT.replace(
        '</joint>', '<axis><use_parent_model_frame>tr<!-- -->ue</use_parent_model_frame>'
        '<xyz expressed_in="x">0 0 1</xyz></axis></joint>'),
    '<link name="k"/>' + JOINT.replace(
        '</joint>', '<axis><xyz>0 0 1</xyz><xyz expressed_in="x">0 0 1</xyz></axis></joint>'),
    '<link name="k"><sensor name="s" type="a&amp;b"><gz_frame_id>i</gz_frame_id></sensor></link>',
    ('<link name="k"><sensor name="s" type="imu"><ignition_frame_id>j</ignition_frame_id>'
     '<gz_frame_id/><gz_frame_id>i</gz_frame_id></sensor></link>'),
    ('<link name="k"><sensor name="s" type=" camera "><gz_frame_id>a&amp;b</gz_frame_id><camera/>'
     '<camera><optical_frame_id>o</optical_frame_id></camera></sensor></link>'),
    ('<link name="k"><sensor name="s" type="x"><camera/><camera><optical_frame_id>o'
     '</optical_frame_id></camera></sensor></link>'),
    '<link name="k"/>' + JOINT.replace(
        '</joint>', '<axis><xyz>0 0 1</xyz><use_parent_model_frame>1<plugin name="p"/>'
        '</use_parent_model_frame></axis></joint>'),
    *(f'<link name="k">{"<a>" * depth}{"</a>" * depth}</link>' for depth in (252, 253, 254)),
    '<link name="k"><visual name="v"><uri>&bogus;</uri></visual></link>',
    '<link name="k"><visual name="v"><uri>\1</uri></visual></link>',
    '<link name="k"><visual name="v"><uri a=1/></visual></link>',
    '<link name="k"><visual name="v"><uri a="1" a="2"/></visual></link>',
    '<link name="k"><visual name="v"><uri></url></visual></link>',
    '<link name="k"><visual name="v" xml:id="i"/><visual name="w" xml:id="i"/></link>',
    '<frame name="f"/>', '<frame name="f" attached_to="l"/>', '<frame name="f" attached_to=""/>',
    '<frame attached_to="l" name="f"/>', '<frame name="f" attached_to=" l"/>',
    '<frame name="f" attached_to="f"/>', '<frame name="f" attached_to="__root__"/>',
    '<frame name="f" attached_to="l" more="x"/>',
    '<model name="n"><static>true</static></model>',
    '<model name="n"><static> 1 </static></model>',
    '<model name="n"><static>x</static></model>',
    '<model name="n"><static/></model>', '<model name="n"/>',
    '<model name="n" canonical_link="k"><link name="i"/><link name="k"/></model>',
    '<model name="n" canonical_link="x"><link name="i"/></model>',
    ('<model name="n" placement_frame="k"><pose>1 0 0 0 0 0</pose><link name="k">'
     '<pose>0 1 0 0 0 0</pose></link></model>'),
    '<model name="n" placement_frame="__root__"><link name="k"/></model>',
    '<model name="n"><model name="o"><link name=""/></model><link name="k"/></model>',
    '<plugin name="p" filename="f"><link name="l"><pose>x</pose></link></plugin>',
    '<state><link name="l"><pose>1 2 3 0 0 0</pose></link></state>',
    '<light name="l"/>', '<actor name="a"/>', '<world name="w"/>',
    '<include><uri>missing</uri></include>',
    '<!-- <link name="k"/> -->', '<!--\n\n--><link name="k"/>',
    '<link name="k"><inertial><mass>x</mass></inertial></link>',
    '<link name="k"><inertial><mass><!-- --> 1</mass></inertial></link>',
    '<link name="k"><inertial><mass>1<!-- -->x</mass></inertial></link>',
    '<link name="k"><inertial><mass>&#49;</mass></inertial></link>',
)


def outcome(text):
    """Return all that there is to know of a scene, or all that is wrong with it."""
    try:
        scene = sdf_pose_bridge.load_text(text, str(HERE / 'x.sdf'), on_missing_include='skip')
    except sdf_pose_bridge.SdfError as error:
        return [(each.code, each.message, each.place) for each in error.errors], error.warnings
    arrays = (
        scene.kinds, scene.parents, scene.roots, scene.attachments, scene.bodies,
        scene.canonical_links, scene.lines, scene.file_indices, scene.poses)
    return (scene.names, scene.joints, dict(scene.sensors), scene.static_models, scene.warnings,
            *(array.tolist() for array in arrays))


def outcome_if_large_from(size, text):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(document_reading, '_LARGE', size)
        return outcome(text)


def assert_same_one_by_one(text):
    one_by_one = outcome_if_large_from(sys.maxsize, text)
    without_regular_part = outcome_if_large_from(0, text)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(regular_part, 'documents_without_regular_part', lambda contents: {})
        whole = outcome_if_large_from(0, text)
    assert whole == one_by_one
    assert without_regular_part == one_by_one


@pytest.mark.parametrize('version', ['1.9', '1.6', '1.4'])
@pytest.mark.parametrize('oddity', ODDITIES)
def test_something_odd(oddity, version):
    assert_same_one_by_one(model_file(LINK + oddity, version=version))


@pytest.mark.parametrize('oddity', ODDITIES)
def test_something_odd_among_models(oddity):
    models = ''.join(f'<model name="m{i}">{LINK}</model>' for i in range(3))
    assert_same_one_by_one(
        world_file(f'{models}<model name="n">{LINK}{oddity}</model>{oddity}'
                   f'<frame name="f"/><model name="m1">{LINK}</model>'))


@pytest.mark.parametrize('oddity', ODDITIES)
def test_something_odd_in_a_file_without_double_quotes(oddity):
    assert_same_one_by_one(model_file(LINK + oddity).replace('"', "'"))


@pytest.mark.parametrize('tail', [
    ' \n', 'x', '<!-- c -->', '<!-- c -->x', '<x/>', '<link name="k"/>'])
@pytest.mark.parametrize('content', ['', '<undeclared:element/>'])
def test_something_behind_the_outermost_element(tail, content):
    assert_same_one_by_one(model_file(f'<link name="l">{content}</link>') + tail)


@pytest.mark.parametrize('path', FILES, ids=lambda path: path.name)
def test_files(path):
    assert_same_one_by_one(path.read_bytes())


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(random_scenes(), st.data())
def test_random_scenes_with_something_odd(drawn, data):
    text = drawn.text()
    place = data.draw(st.sampled_from([i + 1 for i, each in enumerate(text) if each == '>']))
    oddity = data.draw(st.sampled_from(['', *ODDITIES]))
    assert_same_one_by_one(text[:place] + oddity + text[place:])
