# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose check``: errors, warnings and the exit code."""

import os

import pytest
from sdf_texts import model_file


@pytest.fixture
def lines_of(run_main, files):
    """Lines that ``check`` prints for a text, or for URDF."""
    def lines(text, *arguments):
        name = 'arm.urdf' if text.startswith('<robot') else 'arm.sdf'
        (files / name).write_text(text)
        return run_main('check', *arguments, name).stdout.splitlines()
    return lines


def test_check_prints_errors_in_the_order_of_the_file(run_main):
    done = run_main('check', 'bad.sdf')
    assert done.returncode == 1
    assert '\x1b' not in done.stdout
    first, second = done.stdout.splitlines()
    assert first.startswith('bad.sdf:3: ELEMENT_INVALID: ')
    assert second.startswith('bad.sdf:4: POSE_RELATIVE_TO_INVALID: relative_to="ff" names no ')


def test_check_prints_warnings_and_exits_with_0(run_main):
    done = run_main('check', 'warned.sdf')
    assert done.returncode == 0
    assert done.stdout.startswith('warned.sdf:5: WARNING: POSE_RELATIVE_TO_INVALID: ')


def test_check_continues_after_an_invalid_file(run_main):
    done = run_main('check', 'missing.sdf', 'bad.sdf')
    assert done.returncode == 1
    assert [line.split(':')[0] for line in done.stdout.splitlines()] == [
        'missing.sdf', 'bad.sdf', 'bad.sdf']


@pytest.mark.parametrize(('text', 'shown'), [
    (model_file('<link name="l"/><frame name="f" attached_to="x&#10;b.sdf:1: \x9b\u202e"/>'),
     r'attached_to="x\nb.sdf:1: \x9b\u202e"'),
    ('<sdf version="1.9"><a\u202e></b></sdf>', 'not well-formed XML')])
def test_text_of_a_file_cannot_control_the_terminal(lines_of, text, shown):
    (line,) = lines_of(text)
    assert shown in line
    assert line.isprintable()


def test_process_substitution_is_read(run_main, files):
    reader, writer = os.pipe()
    os.write(writer, (files / 'good.sdf').read_bytes())
    os.close(writer)
    done = run_main('check', f'/dev/fd/{reader}')
    os.close(reader)
    assert (done.returncode, done.stdout) == (0, '')


def test_device_is_refused(run_main):
    assert 'not a regular file' in run_main('check', '/dev/zero').stdout


def test_includes_are_searched_in_given_directories(run_main, files):
    (files / 'models').mkdir()
    (files / 'models' / 'm.sdf').write_text('<sdf version="1.9"><model name="m"><link name="l"/>'
                                            '</model></sdf>')
    (files / 'world.sdf').write_text('<sdf version="1.9"><world name="w"><include><uri>model://m.sdf'
                                     '</uri></include></world></sdf>')
    missing = run_main('check', 'world.sdf')
    assert missing.returncode == 1
    assert missing.stdout.endswith(
        '; here -I adds to resource_paths; --skip-missing leaves it out\n')
    assert run_main('check', '-I', 'models', 'world.sdf').returncode == 0
    skipped = run_main('check', '--skip-missing', 'world.sdf')
    assert skipped.returncode == 0
    assert 'WARNING: "model://m.sdf" cannot be included' in skipped.stdout


@pytest.mark.parametrize(('arguments', 'code'), [
    (('--strict', 'warned.sdf'), 1), (('--strict', 'good.sdf'), 0), (('good.sdf',), 0)])
def test_a_warning_counts_in_a_strict_check(run_main, arguments, code):
    done = run_main('check', *arguments)
    assert (done.returncode, bool(done.stdout), done.stderr) == (code, bool(code), '')


@pytest.mark.parametrize('text', [
    """<sdf version="1.9"><model name="m"><link name="l"/>
      <frame name="f" attached_to="x"/>
      <lnk/>
      <frame name="g" attached_to="y"/></model></sdf>""",
    # What the package does not have.
    """<robot name="r"><link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"
      ixy="0" ixz="0" iyz="0"/></inertial><visual><geometry><mesh filename="package://p/1.stl"/>
      </geometry></visual><collision><geometry><mesh filename="package://p/2.stl"/>
      </geometry></collision><visual><geometry><mesh filename="package://p/3.stl"/>
      </geometry></visual></link></robot>"""])
def test_errors_and_warnings_are_in_the_order_of_lines(lines_of, files, text):
    (files / 'p').mkdir()
    assert [line.split(':')[1] for line in lines_of(text, '-I', '.')] == ['2', '3', '4']


def test_frame_ids_that_the_node_rejects_are_warnings(run_main, files):
    (files / 'pipe.sdf').write_text(
        '<sdf version="1.9"><model name="pipe">\n<link name="/a"/><link name="a"/></model></sdf>')
    done = run_main('check', 'pipe.sdf')
    assert done.stdout.startswith(
        'pipe.sdf:2: WARNING: DUPLICATE_NAME: link "pipe::a" and link "pipe::/a" (line 2) would '
        'share the frame id "a"')
    assert done.stdout.endswith('; by default, the node rejects this\n')
    assert done.returncode == 0


def test_a_second_world_is_a_warning(run_main, files):
    (files / 'two.sdf').write_text(
        '<sdf version="1.10"><world name="a"/><world name="b"/></sdf>')
    done = run_main('check', '--strict', 'two.sdf')
    assert (done.returncode, len(done.stdout.splitlines())) == (1, 1)
    assert 'world "b" is not published' in done.stdout


@pytest.mark.parametrize(('folder', 'missing'), [
    ('package://p', '"package://p": no package "p" is installed'),
    ('package://p/q', '"package://p": no package'), ('p', '"p": '), ('file://p/q', '"file://p": '),
    ('a/q', '"a/q": '), ('https://x.org/1.0/o/models/b/tip/files/q',
                         '"https://x.org/1.0/o/models/b/tip": it is not in the cache of'),
])
def test_meshes_of_a_missing_folder_are_one_warning(folder, missing, lines_of, files):
    (files / 'a').mkdir()
    (line,) = lines_of(f"""<sdf version="1.9"><model name="m"><link name="l">
      <visual name="a"><geometry><mesh><uri>{folder}/1.stl</uri></mesh></geometry></visual>
      <visual name="b"><geometry><mesh><uri>{folder}/2.stl</uri></mesh></geometry></visual>
      </link></model></sdf>""")
    assert line.startswith(
        f'arm.sdf:2: WARNING: the mesh "{folder}/1.stl" is not found, like 1 more of {missing}')


def test_shapes_of_a_file_that_is_included_twice_have_one_warning(run_main, files):
    (files / 'part.sdf').write_text("""<sdf version="1.9"><model name="m"><link name="l">
      <visual name="a"><geometry><mesh><uri>none.stl</uri></mesh></geometry></visual>
      <visual name="b"><geometry><sphere><radius>0</radius></sphere></geometry></visual>
      </link></model></sdf>""")
    include = '<include><uri>part.sdf</uri><name>{}</name></include>'
    (files / 'two.sdf').write_text(
        f'<sdf version="1.9"><world name="w">{include.format("a")}{include.format("b")}'
        '</world></sdf>')
    lines = run_main('check', 'two.sdf').stdout.splitlines()
    assert [line.split(':')[1] for line in lines] == ['2', '3']


def test_after_fifty_missing_meshes_no_more_are_looked_for(lines_of):
    meshes = ''.join(
        f'<visual name="v{i}"><geometry><mesh><uri>none{i}.stl</uri></mesh></geometry></visual>'
        for i in range(110))
    lines = lines_of(model_file(f'<link name="l">{meshes}</link>'))
    assert len(lines) == 51
    assert '"none0.stl"' in lines[0]
    assert ' 60 in all, are not looked for' in lines[50]


def test_missing_mesh_and_impossible_sizes_are_warnings(run_main, files):
    (files / 'shapes.sdf').write_text("""<sdf version="1.9"><model name="m"><link name="l">
      <visual name="a"><geometry><mesh><uri>none.stl</uri></mesh></geometry></visual>
      <visual name="b"><geometry><mesh><uri>good.sdf</uri></mesh></geometry></visual>
      <collision name="c"><geometry><box><size>0 -1 1</size></box></geometry></collision>
      <collision name="d"><geometry><box><size>1 1 1</size></box></geometry></collision>
      </link></model></sdf>""")
    done = run_main('check', 'shapes.sdf')
    mesh, box = done.stdout.splitlines()
    assert mesh.startswith('shapes.sdf:2: WARNING: the mesh "none.stl" is not found: it is not in')
    assert box == (
        'shapes.sdf:4: WARNING: a size or the scale of the box is not a positive number (0 -1 1)')
    assert (done.returncode, run_main('check', '--strict', 'shapes.sdf').returncode) == (0, 1)
