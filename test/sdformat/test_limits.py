# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Small files that would take all memory are refused with the limit that they exceed."""

import contextlib
import os
import time

import pytest
from sdf_texts import errors_of_file, LINK, model_file, names_of, world_file, write_files

from sdf_pose_bridge import Limits, load, load_text, SdfError
from sdf_pose_bridge.problems import MOST_PROBLEMS

FILES = 30
TWICE = ('<include><name>a</name><uri>{0}.sdf</uri></include>'
         '<include><name>b</name><uri>{0}.sdf</uri></include>')
ADDED = (
    '<link name="l"/><include><name>i</name><uri>empty.sdf</uri><experimental:params>'
    f'<model element_id="n" name="m" action="add">{TWICE}</model></experimental:params></include>')
MERGED = ''.join(
    f'<model name="{name}"><include merge="true"><uri>{{0}}.sdf</uri></include></model>'
    for name in 'ab')


def exceeded_limit(path, **options):
    """Load a file that exceeds a limit; return the name of the limit."""
    (error,) = errors_of_file(path, **options)
    assert error.code == 'LIMIT'
    return error.message.split()[-3]


# The limit that a load has by itself is exceeded once, as that takes a second.
@pytest.mark.parametrize(('content', 'limits'), [
    (TWICE, Limits()), (ADDED, Limits(copied_elements=10_000)),
    (MERGED, Limits(copied_elements=10_000)),
], ids=['include', 'params', 'merge'])
def test_includes_that_double_thirty_times_are_refused(tmp_path, content, limits):
    write_files(tmp_path, empty=model_file(f'<model name="n">{LINK}</model>'), **{
        str(number): model_file(content.format(number + 1) if number < FILES - 1 else LINK)
        for number in range(FILES)})
    assert exceeded_limit(tmp_path / '0.sdf', limits=limits) == 'copied_elements'


def test_too_many_elements_are_refused_before_they_are_parsed(tmp_path):
    write_files(tmp_path, flat=model_file('<a/>' * 10_000_000))
    assert exceeded_limit(tmp_path / 'flat.sdf') == 'elements'


def test_errors_in_a_long_name_take_no_long_time_and_are_short(tmp_path):
    links = '<link name="l"/>' * 20_000
    write_files(tmp_path, long=model_file(links).replace('"m"', f'"{"m" * 350_000}"'))
    text = '<sdf version="1.9">' + ''.join(
        f'<world name="{"w" * 200}{number}"/>' * 2 for number in range(2000)) + '</sdf>'
    (tmp_path / 'many.sdf').write_text(text)
    assert len(str(errors_of_file(tmp_path / 'long.sdf')[0])) < 1000
    assert len(errors_of_file(tmp_path / 'many.sdf')) == MOST_PROBLEMS + 1


@pytest.mark.parametrize(('name', 'is_checked_again'), [('', False), ('<name>n#</name>', True)])
def test_each_check_of_a_merged_model_counts(tmp_path, name, is_checked_again):
    include = f'<include merge="true"><uri>leaf.sdf</uri>{name}</include>'
    merges = ''.join(
        f'<model name="m{i}">{include.replace("#", str(i))}</model>' for i in range(9))
    write_files(tmp_path, leaf=model_file(LINK), main=world_file(merges))
    # Each model has two elements, and a check of it reads the <sdf> around it too.
    with pytest.raises(SdfError) if is_checked_again else contextlib.nullcontext():
        load(tmp_path / 'main.sdf', limits=Limits(copied_elements=2 * 9 + 2 + 1))


def test_three_hundred_robots_of_a_thousand_elements_are_read(tmp_path):
    robots = ''.join(
        f'<include><name>r{number}</name><uri>robot.sdf</uri></include>' for number in range(300))
    plugin = f'<plugin name="p" filename="p">{"<a/>" * 997}</plugin>'
    write_files(tmp_path, main=world_file(robots), robot=model_file(f'{LINK}{plugin}'))
    assert len(load(tmp_path / 'main.sdf').names) == 1 + 2 * 300


def test_included_pipe_is_refused(tmp_path):
    os.mkfifo(tmp_path / 'pipe.sdf')
    write_files(tmp_path, main=world_file('<include><uri>pipe.sdf</uri></include>'))
    (error,) = errors_of_file(tmp_path / 'main.sdf')
    assert (error.code, error.file) == ('FILE_READ', str(tmp_path / 'pipe.sdf'))


def test_error_about_a_limit_follows_the_other_errors(tmp_path):
    write_files(tmp_path, main=world_file(
        '<include/><include><uri>leaf.sdf</uri></include>'), leaf=model_file(LINK))
    errors = errors_of_file(tmp_path / 'main.sdf', limits=Limits(copied_elements=1))
    assert [error.code for error in errors] == ['ATTRIBUTE_MISSING', 'LIMIT']


@pytest.mark.parametrize('limit', ['elements', 'bytes_read', 'depth'])
def test_limits_can_be_set(limit):
    text = model_file(LINK)
    with pytest.raises(SdfError, match=f'the limit {limit} is 1'):
        load_text(text, limits=Limits()._replace(**{limit: 1}))


def test_limits_that_are_just_met_refuse_nothing(tmp_path):
    write_files(tmp_path, main=world_file('<include><uri>leaf.sdf</uri></include>'),
                leaf=model_file(LINK))
    size = sum(path.stat().st_size for path in tmp_path.iterdir())
    scene = load(tmp_path / 'main.sdf', limits=Limits(
        bytes_read=size, elements=7, copied_elements=2, include_depth=2, depth=3))
    assert names_of(scene) == ['m', 'm::l']


CHAIN = ''.join(f'<frame name="f{i}" attached_to="f{i + 1}"/>' for i in range(10_000))
DEEP_PLACEMENTS = '<sdf version="1.9">' + ''.join(
    f'<model name="n" placement_frame="{"n::" * (199 - depth)}f0">{LINK}' for depth in range(200)
) + CHAIN.replace(' attached_to="f10000"', '') + '</model>' * 200 + '</sdf>'
OLD_FLAG = '<use_parent_model_frame>1</use_parent_model_frame>'
MISSING = '<include><uri>none.sdf</uri><name>x</name></include>'


@pytest.mark.parametrize('text', [
    world_file(f'{MISSING}{CHAIN}<frame name="f10000" attached_to="x"/>'),
    world_file(f'{MISSING}<frame name="f" attached_to="{"a::" * 200_000}b"/>'),
    model_file('<link name="l" ' + ' '.join(f'a{i}=""' for i in range(30_000)) + '/>'),
    b'<sdf version="1.9">' + b'\xff' * 200_000 + model_file(LINK).encode()[19:],
    '<' + 'a' * 200_000,
    DEEP_PLACEMENTS,
    '<sdf version="1.9">' + ''.join(f'<model name="m{i}">' for i in range(240)) + LINK
    + ''.join(f'<frame name="f{i}" attached_to="g"/>' for i in range(9000))
    + '</model>' * 240 + '</sdf>',
    model_file(f'{LINK}<link name="c"/><joint name="j" type="revolute"><parent>l</parent>'
               f'<child>c</child><axis>{OLD_FLAG * 30_000}'
               '</axis></joint>', version='1.6'),
    world_file(f'<model name="m"><link name="{"a::" * 240}l">{"<a/>" * 30_000}</link></model>',
               version='1.7'),
    world_file(f'<model name="m"><link name="{"a::" * 5000}l"/></model>', version='1.7'),
    model_file(f'<model name="{"Ω" * 370}">{LINK}' + ''.join(
        f'<frame name="ß{i}"/>' for i in range(2000)) + ''.join(
        f'<frame name="f{i}" attached_to="λ{i}"/>' for i in range(50)) + '</model>'),
    model_file(f'{MISSING}<model name="{"n" * 300}">{LINK}' + ''.join(
        f'<frame name="f{i}" attached_to="{"a::" * 300}x"/>' for i in range(1000)) + '</model>'),
    model_file('<link name="l">' + ''.join(
        f'<visual name="v{i}"><pose relative_to="n{i}"/></visual>' for i in range(15_000))
        + '</link>'),
], ids=['chain to a missing file', 'long path to a missing file', 'attributes', 'not UTF-8',
        'long tag', 'placement frames at the end of a chain', 'errors in deep models',
        'flags of an old axis', 'old name of many scopes',
        'old name of too many scopes', 'hints from names beyond ASCII',
        'long references to a missing file', 'unknown references'])
def test_time_grows_with_the_size_of_a_file_and_not_faster(text):
    begin = time.thread_time()
    with contextlib.suppress(SdfError):
        load_text(text)
    # Of the processor, which may have other work to do; 8 to 100 s where it is quadratic.
    assert time.thread_time() - begin < 5.0
