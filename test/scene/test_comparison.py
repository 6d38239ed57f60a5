# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What is different between two scenes."""

import math

import pytest
from sdf_texts import model_file, posed, world_file

from sdf_pose_bridge import load_text, UnknownFrameError
from sdf_pose_bridge.scene.comparison import differences_of_scenes

A = '<link name="a"><pose>1 0 0 0 0 0</pose></link>'
B = '<frame name="b"><pose relative_to="a">0 0 1 0 0 0</pose></frame>'


def differences(old, new, **options):
    return [
        (each.change.value, each.name, each.old_name)
        for each in differences_of_scenes(
            load_text(model_file(old)), load_text(model_file(new)), **options)]


def test_what_depends_on_a_moved_frame_moves_too():
    assert differences(A + B, A.replace('1 0 0 0', '1 0 0 0.1') + B) == [
        ('moved', 'm::a', 'm::a'), ('moved', 'm::b', 'm::b')]


def test_in_a_frame_that_moves_too_nothing_has_moved():
    moved = A.replace('1 0 0', '1 0 5') + B
    assert differences(A + B + '<frame name="f"/>', moved + '<frame name="g"/>',
                       relative_to='m::a') == [
        ('moved', 'm', 'm'), ('renamed', 'm::g', 'm::f'), ('moved', 'm::g', 'm::f')]


def test_distance_and_angle_of_a_movement():
    old, new = (load_text(model_file(posed('link', 'a', f'{x} 0 0 0 0 {yaw}')))
                for x, yaw in ((1, 3.0), (1.5, -3.0)))
    moved, = differences_of_scenes(old, new)
    assert moved.distance_m == pytest.approx(0.5)
    assert moved.angle_rad == pytest.approx(2 * math.pi - 6.0)


@pytest.mark.parametrize(('x', 'tolerance', 'changes'), [
    (1, 0.0, []), (1.01, 0.02, []), (1.01, 0.005, [('moved', 'm::a', 'm::a')])])
def test_tolerance(x, tolerance, changes):
    assert differences(A, A.replace('1 0', f'{x} 0'), tolerance=tolerance) == changes


def test_renamed_with_what_it_holds():
    old = A + '<model name="n"><link name="k"/></model>'
    assert differences(old, old.replace('name="n"', 'name="o"')) == [
        ('renamed', 'm::o', 'm::n'), ('renamed', 'm::o::k', 'm::n::k')]


F = '<frame name="f"/>'
PAIR = '<frame name="{}"/><frame name="{}"/>'
IN_TWO = '<model name="n"><link name="k"/>{}</model><model name="o"><link name="k"/>{}</model>'


@pytest.mark.parametrize(('old', 'new', 'changes'), [
    (F, F.replace('frame', 'link'), ['removed frame m::f m::f', 'added link m::f ']),
    (F, '<link name="g"/>', ['removed frame m::f m::f', 'added link m::g ']),
    (F, posed('frame', 'g', '0 1 0 0 0 0'), ['removed frame m::f m::f', 'added frame m::g ']),
    (IN_TWO.format(F, ''), IN_TWO.format('', F),
     ['removed frame m::n::f m::n::f', 'added frame m::o::f ']),
    # Of two in one place, none is renamed for certain.
    (PAIR.format('b', 'c'), F,
     ['removed frame m::b m::b', 'removed frame m::c m::c', 'added frame m::f ']),
    (F, PAIR.format('b', 'c'),
     ['removed frame m::f m::f', 'added frame m::b ', 'added frame m::c ']),
])
def test_what_is_added_or_removed_is_not_renamed(old, new, changes):
    scenes = (load_text(model_file(A + each)) for each in (old, new))
    assert [f'{each.change.value} {each.kind.label} {each.name} {each.old_name}'
            for each in differences_of_scenes(*scenes)] == changes


def test_worlds_are_told_apart():
    text = world_file('<frame name="f"><pose>0 0 1 0 0 0</pose></frame>')
    scenes = load_text(text), load_text(text.replace('"w"', '"v"'))
    assert [each.change.value for each in differences_of_scenes(*scenes)] == [
        'removed', 'added']


def test_an_unknown_frame_is_refused():
    with pytest.raises(UnknownFrameError, match='did you mean "m::a"'):
        differences(A, A, relative_to='m::aa')
