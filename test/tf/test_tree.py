# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The tree of TF frames: clashes, options, and poses that stay what the scene says."""

from pathlib import Path

from matrices import assert_same_pose, matrix_from_pose
import pytest
from random_scenes import random_scenes
from sdf_texts import fixed_joint, joint, model_file, world_file
from tf_checks import (
    assert_is_tree,
    model,
    only_tree_error,
    parents_of,
    pose_of,
    tree_errors_of,
    tree_of,
)
import urdf_texts as urdf

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given, HealthCheck, settings
from hypothesis import strategies as st

from sdf_pose_bridge import Kind, load, load_text
from sdf_pose_bridge.tf.anchors import AnchorModels
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

EXAMPLES = sorted((Path(__file__).parents[2] / 'examples').rglob('*.sdf'))
ALL_KINDS = frozenset(Kind) - {Kind.ROOT, Kind.WORLD}
LINK = '<link name="l"/>'


def assert_has_poses_of(tree, scene, ids):
    """Check the poses of frames against the scene; ids has the frame id of each element."""
    for index, frame_id in ids.items():
        assert_same_pose(
            pose_of(tree, frame_id), matrix_from_pose(scene.poses[index].tolist()),
            name=scene.names[index])


def scoped_ids(scene, kinds):
    """Name all elements of some kinds by the documented rule, where no sensor sets an id."""
    ids = {}
    for index, name in enumerate(scene.names):
        kind = Kind(scene.kinds[index])
        if kind not in kinds or scene.roots[index]:
            continue
        parts = name.split('::')
        if kind in {Kind.VISUAL, Kind.COLLISION, Kind.LIGHT, Kind.PARTICLE_EMITTER,
                    Kind.PROJECTOR, Kind.ACTOR}:
            parts.insert(-1, kind.label)
        ids[index] = '/'.join(parts)
    return ids


# Frame ids that are not unique or not valid

@pytest.mark.parametrize(('text', 'options', 'frame_id'), [
    (model_file('<link name="a/b"/><model name="a"><link name="b"/></model>'), {}, 'a/b'),
    (world_file(model('m/x', LINK) + model('m', '<link name="x"/><link name="x/l"/>')), {},
     'm/x/l'),
    (model_file('<link name="m"/>'), {'frame_names': FrameNames.RELATIVE}, 'm'),
    (world_file(model('p', LINK) + model('q', LINK)), {'frame_names': FrameNames.RELATIVE}, 'l'),
    (model_file('<link name="/a"/><link name="a"/>'), {}, 'a'),
    (model_file('<link name="a_b"/><model name="a"><link name="b"/></model>'),
     {'frame_separator': '_'}, 'a_b'),
    (model_file('<link name="l"><visual name="x"/></link><model name="l2"><link name="k"/>'
                '</model><link name="l/visual/x"/>'), {'kinds': ALL_KINDS}, 'l/visual/x'),
])
def test_two_elements_would_share_an_id(text, options, frame_id):
    error = tree_errors_of(text, **options)[-1]
    assert error.code == 'DUPLICATE_NAME'
    assert f'"{frame_id}"' in error.message


def test_ids_are_scoped_if_a_link_has_the_name_of_the_model():
    tree = tf_tree_from_scene(load_text(
        model_file('<link name="m"/><link name="l"/>')))
    assert set(tree.frame_ids) == {'m', 'm/m', 'm/l'}
    (warning,) = tree.warnings
    assert 'has the name of the model, "m"' in warning.message


@pytest.mark.parametrize(('name', 'root_frame'), [
    ('m7/l', 'world'), ('map', 'map'), ('//', 'world')])
def test_one_bad_id_among_many(name, root_frame):
    models = ''.join(model(f'm{number}', LINK) for number in range(1000))
    error = only_tree_error(world_file(f'{models}<frame name="{name}"/>'), root_frame=root_frame)
    assert f'"{name}"' in error.message


def test_a_clash_names_both_and_their_lines():
    error = only_tree_error(
        '<sdf version="1.9"><model name="m">\n<link name="a">\n<sensor name="b" type="imu"/>'
        '</link>\n<link name="a/b"/></model></sdf>')
    assert str(error) == (
        'file.sdf:4: DUPLICATE_NAME: link "m::a/b" and sensor "m::a::b" (line 3) would share the '
        'frame id "a/b"; frame_names "scoped", or another frame_separator, can tell them apart')


IN_MAP = world_file(model('map', LINK))


@pytest.mark.parametrize(('text', 'options', 'words'), [
    (IN_MAP, {'root_frame': 'map'}, 'id "map", which is that of the root'),
    (model_file('<link name="base"/>'), {'root_frame': 'base'}, 'id "base", which is that of the'),
    (model_file('<link name="a"><sensor name="s" type="imu"/></link>'), {'root_frame': 'a/s'},
     'id "a/s", which is that of the root'),
    (model_file('<link name="/"/>'), {}, '"m::/" leaves no frame id'),
    (model_file('<link name="/"/>'), {'frame_prefix': 'r/'}, '"m::/" leaves no frame id')])
def test_an_id_is_that_of_the_root_or_empty(text, options, words):
    error = only_tree_error(text, **options)
    assert error.code == ('ELEMENT_INVALID' if 'leaves' in words else 'DUPLICATE_NAME')
    assert words in error.message


def test_blanks_are_kept_with_one_warning():
    tree = tree_of(world_file('<frame name="f"/>' + ''.join(
        model(f'cone {number}', LINK) for number in range(9))))
    assert 'cone 8/l' in tree.frame_ids
    (warning,) = tree.warnings
    assert warning.message.endswith('"cone 1", "cone 1/l", "cone 2" and 13 more')


# Options

CELL = world_file(
    '<frame name="corner"/>'
    + model('table', '<static>1</static>' + LINK)
    + model('free', LINK + '<frame name="f"/>', '<pose>1 0 0 0 0 0</pose>')
    + model('bolted', LINK + fixed_joint('j', 'world', 'l'))
    + model('held', LINK) + fixed_joint('k', 'bolted', 'held'))


@pytest.mark.parametrize(('anchor', 'on_root'), [
    (AnchorModels.ALL, {'corner', 'table/l', 'free/l', 'bolted/l'}),
    (AnchorModels.STATIC, {'corner', 'table/l', 'bolted/l'}),
    (AnchorModels.NONE, {'corner'}),
])
def test_which_models_are_anchored(anchor, on_root):
    for follows_models in (False, True):
        parents = parents_of(CELL, anchor_models=anchor, follows_models=follows_models)
        assert {name for name, parent in parents.items() if parent == 'world'} == on_root
        assert parents['held/l'] == 'bolted/l'


URDF = (
    '<robot name="r"><link name="l"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" '
    'ixy="0" ixz="0" iyz="0"/></inertial></link></robot>')


@pytest.mark.parametrize(('text', 'on_root'), [
    (world_file('<model name="m"><link name="l"/></model>'), {'m/l'}),
    (model_file('<link name="l"/>'), set()),
    (model_file('<static>true</static><link name="l"/>'), {'l'}),
    (model_file('<link name="l"/>' + fixed_joint('j', 'world', 'l')), {'l'}),
    (URDF, set()),
    (f'<sdf version="1.10">{model("m", LINK)}<world name="w"/></sdf>', set()),
])
def test_a_model_file_that_can_move_is_not_anchored_by_default(text, on_root):
    assert {child for child, parent in parents_of(text).items() if parent == 'world'} == on_root
    assert (tree_of(text).fixed_frame == 'world') is bool(on_root)
    assert tree_of(text, follows_models=True).fixed_frame == 'world'


@given(st.data(), st.sampled_from(['base', 'world']), st.sampled_from(['', 'left/']),
       st.sampled_from(AnchorModels))
def test_a_urdf_keeps_its_own_tree(data, root, prefix, anchor):
    links, joints, expected = [root], [], {}
    for number in range(data.draw(st.integers(0, 6))):
        name, parent = f'l{number}', data.draw(st.sampled_from(links))
        joint_type = data.draw(st.sampled_from(['fixed', 'continuous', 'planar', 'floating']))
        joints.append(urdf.joint(f'j{number}', parent, name, joint_type, urdf.origin('1 2 3')))
        links.append(name)
        if joint_type != 'floating':
            expected[prefix + name] = prefix + parent
    text = urdf.robot(''.join(data.draw(st.permutations(
        [f'<link name="{name}"/>' for name in links] + joints))))
    found = parents_of(text, frame_prefix=prefix, anchor_models=anchor, kinds=None)
    assert {*found, *found.values(), 'world', ''} == {
        *(prefix + name for name in links), 'world', ''}
    if anchor is AnchorModels.ALL:
        # The link "world" stands for the root, below which what floats is.
        above = prefix + 'world' if root == 'world' else 'world'
        expected = {**dict.fromkeys(found, above), **expected}
        if prefix + root in found:
            expected[prefix + root] = 'world'
    assert {child: parent for child, parent in found.items() if parent} == expected


TWO_MODELS = world_file(model('p', LINK) + model('q', LINK))
FRAME_ON_FRAME = world_file(
    '<frame name="f"/><frame name="g" attached_to="f"/>' + model('m', LINK)
    + fixed_joint('j', 'world', 'm'))
NESTED = world_file(model('m', LINK + model('n', '<link name="k"/>', '<pose>1 0 0 0 0 0</pose>')))
URDF_IN_WORLD = urdf.robot(
    '<link name="world"/><link name="a"/>' + urdf.joint('j', 'world', 'a', 'fixed'))
URDF_WITH_CAMERA = """
    <robot name="r">
      <link name="r"/>
      <link name="a"/>
      <joint name="j" type="fixed"><parent link="r"/><child link="a"/></joint>
      <gazebo reference="a"><sensor name="eye" type="camera"/></gazebo>
      <gazebo><frame name="f"/></gazebo>
    </robot>"""
SHAPES = model_file(
    '<link name="l"><inertial/><visual name="x"/><collision name="x"/></link>'
    '<link name="k"/>' + fixed_joint('j', 'l', 'k'))


@pytest.mark.parametrize(('text', 'options', 'parents'), [
    (IN_MAP, {'root_frame': 'top'}, {'map': 'map/l', 'map/l': 'top'}),
    # A prefix tells a frame from the root.
    (IN_MAP, {'root_frame': 'map', 'frame_prefix': 'r/'}, {'r/map': 'r/map/l', 'r/map/l': 'map'}),
    (CELL, {'model': 'free'}, {'free': 'free/l', 'free/l': 'world', 'free/f': 'free'}),
    (CELL, {'model': 'free', 'anchor_models': AnchorModels.STATIC},
     {'free': 'free/l', 'free/l': '', 'free/f': 'free'}),
    # The other model that holds it is not published.
    (CELL, {'model': 'held', 'kinds': None}, {'held': 'held/l', 'held/l': 'world'}),
    (NESTED, {'model': 'm::n'}, {'m/n': 'm/n/k', 'm/n/k': 'world'}),
    # Frames that are not published are skipped.
    (FRAME_ON_FRAME, {'kinds': frozenset({Kind.FRAME})}, {'f': 'world', 'g': 'f'}),
    (FRAME_ON_FRAME, {'kinds': frozenset({Kind.JOINT})}, {'j': 'world'}),
    (FRAME_ON_FRAME, {'kinds': frozenset()}, {}),
    # An id may be that of a frame that is not published.
    (TWO_MODELS, {'frame_names': FrameNames.RELATIVE, 'model': 'p'}, {'p': 'l', 'l': 'world'}),
    (TWO_MODELS, {'frame_names': FrameNames.RELATIVE, 'kinds': frozenset({Kind.MODEL})},
     {'p': 'world', 'q': 'world'}),
    (world_file(model('m', '<static>1</static><frame name="f"/>')),
     {'anchor_models': AnchorModels.NONE}, {'m': '', 'm/f': 'm'}),
    (SHAPES, {'kinds': frozenset(Kind)}, {
        'm': 'l', 'l': '', 'l/inertial': 'l', 'l/visual/x': 'l', 'l/collision/x': 'l',
        'k': 'l', 'j': 'k'}),
    # The link "world" of a URDF has the prefix, and the world itself has not.
    (URDF_IN_WORLD, {}, {'a': 'world'}),
    (URDF_IN_WORLD, {'frame_prefix': 'r/'}, {'r/world': '', 'r/a': 'r/world'}),
    (URDF_IN_WORLD, {'root_frame': 'map', 'anchor_models': AnchorModels.ALL},
     {'world': 'map', 'a': 'world'}),
    (URDF_IN_WORLD, {'root_frame': 'r/world', 'frame_prefix': 'r/'}, {'r/a': 'r/world'}),
    (URDF_IN_WORLD, {'kinds': frozenset({Kind.JOINT}), 'frame_prefix': 'r/'}, {'r/j': 'world'}),
    (urdf.robot('<link name="world"/><gazebo><frame name="f"/></gazebo>'),
     {'anchor_models': AnchorModels.ALL}, {'f': 'world'}),
    # Sensors of a URDF are leaves below its links, and joints come on demand.
    (URDF_WITH_CAMERA, {}, {
        'r': '', 'a': 'r', 'a/eye': 'a', 'f': 'r', 'a/eye_optical': 'a/eye'}),
    (URDF_WITH_CAMERA, {'kinds': None}, {'r': '', 'a': 'r'}),
    (URDF_WITH_CAMERA, {'kinds': frozenset({Kind.LINK, Kind.JOINT, Kind.MODEL})},
     {'r': '', 'j': 'a', 'a': 'r'}),
])
def test_parents(text, options, parents):
    assert [*parents_of(text, **options).items()] == [*parents.items()]


@pytest.mark.parametrize(('kinds', 'anchor', 'nearest'), [
    ({Kind.LINK}, AnchorModels.NONE, {
        'world': 'world', 'free': 'free/l', 'free::l': 'free/l', 'free::f': 'free/l',
        'held::l': 'held/l'}),
    ({Kind.FRAME}, AnchorModels.STATIC, {
        'table::l': 'world', 'free': '', 'free::l': '', 'free::f': 'free/f',
        'bolted::l': 'world', 'held::l': 'world'}),
])
def test_nearest_frame_of_each_element(kinds, anchor, nearest):
    scene = load_text(CELL)
    tree = tf_tree_from_scene(scene, TfOptions(kinds=frozenset(kinds), anchor_models=anchor))
    # The last two serve the two negative indices.
    ids = (*tree.frame_ids, '', tree.root_frame)
    assert {
        name: ids[tree.nearest_frames[scene.index(name)]] for name in nearest} == nearest


@pytest.mark.parametrize(('name', 'part'), [
    ('fre', '"fre"'), ('free::l', '"free::l"'), ('w', '"w"'), ('world', '"world"'),
    ('corner', '"corner"'), ('boltd', 'did you mean "bolted"')])
def test_an_unknown_model(name, part):
    message = only_tree_error(CELL, model=name).message
    assert part in message
    assert '; the models are "' in message


def test_of_several_worlds_the_first():
    text = ('<sdf version="1.10"><world name="day">' + model('p', LINK)
            + '</world><world name="night">' + model('p', '<link name="k"/>') + '</world></sdf>')
    for name in ('', 'p'):
        tree = tree_of(text, model=name)
        assert tree.frame_ids == ('p', 'p/l')
        (warning,) = tree.warnings
        assert 'world "night" is not published' in warning.message


def test_loops_of_a_model_are_one_warning():
    links = ''.join(f'<link name="{name}"/>' for name in 'abc')
    joints = """
        <joint name="j0" type="fixed"><parent>a</parent><child>b</child></joint>
        <joint name="j1" type="fixed"><parent>b</parent><child>c</child></joint>
        <joint name="j2" type="fixed"><parent>c</parent><child>a</child></joint>
        <joint name="j3" type="fixed"><parent>a</parent><child>c</child></joint>"""
    models = ''.join(model(name, links + joints) for name in 'mn')
    warning, other = tree_of(world_file(models)).warnings
    assert warning.message == (
        'joint "m::j2" closes a loop between "m::c" and "m::a"; TF is a tree, so it moves nothing '
        'there; like "m::j3"')
    assert other.message.startswith('joint "n::j2"')


def test_an_empty_file():
    tree = tree_of('<sdf version="1.9"/>')
    assert tree.frame_ids == ()
    assert tree.transforms.shape == (0, 7)
    assert tree.fixed_frame == 'world'


def test_the_fixed_frame_is_the_first_one_without_a_parent():
    assert tree_of(TWO_MODELS, anchor_models=AnchorModels.NONE).fixed_frame == 'p/l'


# Whatever the scene

@pytest.mark.parametrize('path', EXAMPLES, ids=lambda path: path.stem)
def test_the_examples_need_no_options(path):
    assert_is_tree(tf_tree_from_scene(load(path)))


@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(random_scenes(), st.sampled_from(AnchorModels), st.sets(st.sampled_from(sorted(ALL_KINDS))),
       st.sampled_from(['/', '::']), st.booleans(), st.data())
def test_random_scenes_and_their_models_are_trees(
        drawn, anchor, kinds, separator, optical_frames, data):
    scene = load_text(drawn.text())
    model = data.draw(st.sampled_from(['', *(each.scoped_name for each in drawn.models)]))
    tree = tf_tree_from_scene(scene, TfOptions(
        kinds=frozenset(kinds), anchor_models=anchor, frame_names=FrameNames.SCOPED, model=model,
        frame_separator=separator, optical_frames=optical_frames))
    assert_is_tree(tree)
    if separator == '/':
        ids = {
            index: frame_id for index, frame_id in scoped_ids(scene, kinds).items()
            if not model or f'{scene.names[index]}::'.startswith(f'{model}::')}
        assert_has_poses_of(tree, scene, ids)
        assert {i for i in tree.frame_ids if not i.endswith('_optical')} == set(ids.values())


def test_other_bodies_get_the_frame_ids_that_are_free():
    content = LINK + '<link name="k"/>' + joint(
        '<parent>l</parent><child>k</child><axis><xyz>1 0 0</xyz></axis>', 'j', 'prismatic')
    text = world_file(model('a', content))
    assert tree_of(text, follows_models=True).moving.motion.names == ('a',)
    tree = tree_of(text, use_joint_states=True, follows_models=True,
                   others=('a', '/b::c', '/', 'world', 'b/c', 'x y'))
    assert tree.frame_ids == ('a', 'a/l', 'a/k', 'b/c', 'x y')
    assert tree.parent_ids == ('a/l', 'world', 'a/l', 'world', 'world')
    assert tree.fixed_indices.tolist() == [0]
    values = tree.moving.motion.initial_coordinates.copy()
    values[[0, -7]] = 1.0, 4.0  # the positions of the joint and of "x y" along x
    assert tree.moving.transforms(values)[:, 0].tolist() == [0.0, 1.0, 0.0, 4.0]
