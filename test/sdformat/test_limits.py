# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Small files that would take all memory are refused with the limit that they exceed."""

import contextlib
from functools import partial
import os

from growth.families import files_of, write
from growth.turns import fault_of_growth
import pytest
from sdf_texts import errors_of_file, LINK, model_file, names_of, world_file, write_files

from sdf_pose_bridge import Limits, load, load_text, SdfError
from sdf_pose_bridge.names import ROOT_FRAME
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


def test_errors_in_a_long_name_are_short(tmp_path):
    links = '<link name="l"/>' * 200
    write_files(tmp_path, long=model_file(links).replace('"m"', f'"{"m" * 350_000}"'))
    text = '<sdf version="1.9">' + ''.join(
        f'<world name="{"w" * 200}{number}"/>' * 2 for number in range(200)) + '</sdf>'
    (tmp_path / 'many.sdf').write_text(text)
    assert len(str(errors_of_file(tmp_path / 'long.sdf')[0])) < 1000
    assert len(errors_of_file(tmp_path / 'many.sdf')) == MOST_PROBLEMS + 1


@pytest.mark.parametrize(('content', 'is_checked_again'), [
    ('', False), ('<name>n#</name>', False), ('<pose># 0 0 0 0 0</pose>', False),
    ('<plugin name="p#" filename="f"/>', True)])
def test_each_check_of_a_merged_model_counts(tmp_path, content, is_checked_again):
    include = f'<include merge="true"><uri>leaf.sdf</uri>{content}</include>'
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


def test_scoped_names_together_may_have_so_many_characters():
    names = 'l' * 500, 'k' * 400
    text = model_file(''.join(f'<link name="{name}"/>' for name in names))
    most = len('m') + sum(len(f'm::{name}') for name in names) + len(ROOT_FRAME) - 4 * 64
    assert load_text(text, limits=Limits(characters=most)).names
    with pytest.raises(SdfError, match=f'the limit characters is {most - 1}') as caught:
        load_text(text, limits=Limits(characters=most - 1))
    assert caught.value.errors[0].element.startswith('/sdf/model[@name="m"]/link[@name="ll')


def test_limits_that_are_just_met_refuse_nothing(tmp_path):
    write_files(tmp_path, main=world_file('<include><uri>leaf.sdf</uri></include>'),
                leaf=model_file(LINK))
    size = sum(path.stat().st_size for path in tmp_path.iterdir())
    scene = load(tmp_path / 'main.sdf', limits=Limits(
        bytes_read=size, elements=7, copied_elements=2, include_depth=2, depth=3))
    assert names_of(scene) == ['m', 'm::l']


GROWING = {
    'undefined attributes': 20_000,
    'unknown references of visuals': 8000,
    'long names beyond ASCII': 2000,
    'errors in deep models': 12_000,
    'equal errors in deep models': 20_000,
    'equal errors in elements of deep models': 10_000,
    'equal errors of an included deep model': 20_000,
    'equal errors below a long name': 20_000,
    'deep placements at the end of a chain': 5000,
    'flags of an old axis': 20_000,
    'old name of many scopes': 20_000,
    'scopes of an old name': 10_000,
    'scopes of an old name with many elements': 240,
    'references in an old name of many scopes': 10_000,
    'includes of a file with many tops': 2000,
    'merges with names': 1000,
    'params for children': 2000,
    'params for many links': 2000,
    'params for one link of many children': 1000,
    'params that add': 2000,
    'params that modify children': 2000,
    'params that replace': 2000,
    'missing includes beside many files': 1500,
    'sensors of lumped links': 1000,
    'attachments to a missing include': 6000,
    'scopes of a reference into a missing include': 200_000,
    'references into missing includes': 40_000,
    'bytes that are not UTF-8': 200_000,
    'a long tag': 20_000,
}
"""Families of files that grow, and how often each repeats its part."""


def load_or_refuse(path):
    """Load a file; whether it has errors does not matter."""
    with contextlib.suppress(SdfError):
        load(path)


@pytest.mark.parametrize('family', GROWING)
def test_time_grows_with_the_size_of_a_file_and_not_faster(tmp_path, family):
    n = GROWING[family]
    files = files_of(family, n)
    text = ''.join(files.values())
    # A plain file has as many elements or bytes; a link with its pose has 60.
    links = max(text.count('<') - text.count('</'), len(text) // 30) // 2
    paths = [write(each, tmp_path / str(number)) for number, each in enumerate((
        files, files_of(family, n // 2), files_of('links with poses', links)))]
    fault = fault_of_growth(*(partial(load_or_refuse, path) for path in paths))
    assert not fault, fault
