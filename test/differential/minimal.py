# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Cut a scene down to what still shows a difference."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import islice
from pathlib import Path
import tempfile
from typing import TypeAlias
from xml.etree import ElementTree

from differential.batches import write_scene
from differential.comparison import Difference, difference_between, own_answer
from differential.reference import Reference
from differential.scene_parts import SceneFiles

Files: TypeAlias = dict[str, str]

SIMPLE_POSE = '1 2 3 0.1 0.2 0.3'
MOST_TRIALS = 600
VENDOR = ('vendor:', 'vendor.')


def minimal_scene(scene: SceneFiles, reference: Reference) -> tuple[Files, str]:
    """
    Remove from a scene whatever the difference does not need.

    :param scene: a scene on which the two sides disagree.
    :param reference: libsdformat.
    :return: the remaining files, and what differs in them.
    """
    def judge(files: Files) -> tuple[Difference | None, tuple[str, ...]]:
        with tempfile.TemporaryDirectory(prefix='differential-') as folder:
            path = write_scene(files, Path(folder), 'scene')
            answer = reference.answers([path], Path(folder))[0]
            own = own_answer(path, Path(folder))
        difference = difference_between(own, answer, reference.version, scene.traits)
        return difference, (*own.codes[:1], *answer.codes[:1])

    wanted, wanted_codes = judge(scene.files)
    if wanted is None:
        return scene.files, 'not found again'

    def still_differs(files: Files) -> bool:
        difference, codes = judge(files)
        return difference is not None and difference.kind == wanted.kind and codes == wanted_codes

    files = shrunk(scene.files, still_differs)
    difference = judge(files)[0]
    return files, difference.text if difference else ''


def shrunk(files: Files, still_differs: Callable[[Files], bool]) -> Files:
    """Try smaller and smaller files as long as they differ in the same way."""
    best, position, progress = files, 0, False
    for _ in range(MOST_TRIALS):
        # What stands behind a thing that was taken out has moved up to its place.
        candidate = next(islice(smaller(best), position, None), None)
        if candidate is None:
            if not progress:
                break
            position, progress = 0, False
        elif still_differs(candidate):
            best, progress = candidate, True
        else:
            position += 1
    return best


def smaller(files: Files) -> Iterator[Files]:
    """Yield files with one thing less, large things first."""
    for path in files:
        if path != 'scene.sdf':
            yield {other: text for other, text in files.items() if other != path}
    for path, text in files.items():
        try:
            root = ElementTree.fromstring(text.replace(*VENDOR))
        except ElementTree.ParseError:
            continue
        for change in changes(root):
            undo = change()
            tidy(root)
            result = ElementTree.tostring(root, encoding='unicode').replace(*reversed(VENDOR))
            undo()
            if result != text:
                yield {**files, path: result}


def tidy(root: ElementTree.Element) -> None:
    """Indent a tree, and leave nothing in what is empty."""
    for element in root.iter():
        if not len(element) and element.text and not element.text.strip():
            element.text = None
    ElementTree.indent(root)


def changes(root: ElementTree.Element) -> Iterator[Callable[[], Callable[[], None]]]:
    """Yield functions that change the tree and return one that changes it back."""
    places = [(parent, child) for parent in root.iter() for child in parent]
    for parent, child in sorted(places, key=lambda place: -len(list(place[1].iter()))):
        def remove(parent: ElementTree.Element = parent,
                   child: ElementTree.Element = child) -> Callable[[], None]:
            position = list(parent).index(child)
            parent.remove(child)
            return lambda: parent.insert(position, child)
        yield remove
    for element in root.iter():
        for attribute in list(element.attrib):
            def strip(element: ElementTree.Element = element,
                      attribute: str = attribute) -> Callable[[], None]:
                kept = dict(element.attrib)
                del element.attrib[attribute]
                return lambda: element.attrib.update(kept)
            yield strip
    for pose in root.iter('pose'):
        def simplify(pose: ElementTree.Element = pose) -> Callable[[], None]:
            kept = dict(pose.attrib), pose.text
            for attribute in ('rotation_format', 'degrees'):
                pose.attrib.pop(attribute, None)
            pose.text = SIMPLE_POSE

            def undo() -> None:
                pose.attrib.update(kept[0])
                pose.text = kept[1]
            return undo
        yield simplify
