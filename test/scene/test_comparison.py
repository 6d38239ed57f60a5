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


def test_scenes_of_the_same_text_are_the_same():
    assert differences(A + B, A + B) == []


def test_what_depends_on_a_moved_frame_moves_too():
    assert differences(A + B, A.replace('1 0 0 0', '1 0 0 0.1') + B) == [
        ('moved', 'm::a', 'm::a'), ('moved', 'm::b', 'm::b')]


def test_in_a_frame_that_moves_too_nothing_has_moved():
    moved = A.replace('1 0 0', '1 0 5') + B
    assert differences(A + B, moved, relative_to='m::a') == [
        ('moved', 'm', 'm')]


def test_distance_and_angle_of_a_movement():
    old, new = (load_text(model_file(posed('link', 'a', f'{x} 0 0 0 0 {yaw}')))
                for x, yaw in ((1, 3.0), (1.5, -3.0)))
    moved, = differences_of_scenes(old, new)
    assert moved.distance_m == pytest.approx(0.5)
    assert moved.angle_rad == pytest.approx(2 * math.pi - 6.0)


def test_tolerance():
    new = A.replace('1 0 0', '1.01 0 0')
    assert differences(A, new, tolerance=0.02) == []
    assert differences(A, new, tolerance=0.005) == [('moved', 'm::a', 'm::a')]


def test_added_and_removed():
    assert differences(A, A + B) == [('added', 'm::b', '')]
    assert differences(A + B, A) == [('removed', 'm::b', 'm::b')]


def test_renamed_with_what_it_holds():
    old = A + '<model name="n"><link name="k"/></model>'
    assert differences(old, old.replace('name="n"', 'name="o"')) == [
        ('renamed', 'm::o', 'm::n'), ('renamed', 'm::o::k', 'm::n::k')]


def test_of_two_in_one_place_none_is_renamed_for_certain():
    pair = '<link name="l"/><frame name="{}"/><frame name="{}"/>'
    assert differences(pair.format('a', 'b'), pair.format('c', 'd')) == [
        ('removed', 'm::a', 'm::a'), ('removed', 'm::b', 'm::b'), ('added', 'm::c', ''),
        ('added', 'm::d', '')]


def test_worlds_are_told_apart():
    text = world_file('<frame name="f"><pose>0 0 1 0 0 0</pose></frame>')
    scenes = load_text(text), load_text(text.replace('"w"', '"v"'))
    assert [each.change.value for each in differences_of_scenes(*scenes)] == [
        'removed', 'added']


def test_an_unknown_frame_is_refused():
    with pytest.raises(UnknownFrameError, match='did you mean "m::a"'):
        differences(A, A, relative_to='m::aa')
