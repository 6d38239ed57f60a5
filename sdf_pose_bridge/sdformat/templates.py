# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Recognize files that another program has to expand first, such as xacro or Jinja."""

from __future__ import annotations

from collections.abc import Iterator
import os
from pathlib import Path
import re
import shlex
from typing import NamedTuple

from lxml import etree

from sdf_pose_bridge.errors import ParsingError, Place
from sdf_pose_bridge.printed_text import shortened
from sdf_pose_bridge.sdformat.source_formats import SourceFormat
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.xml_tree import text_of, written_tag, XmlElement

_WITHOUT_FRAMES = (
    'plugin', 'ros2_control', 'script', 'transmission', 'xacro:arg', 'xacro:property')
_EXPANDED_PARTS = etree.XPath('descendant-or-self::*[not(ancestor-or-self::*[{}])]'.format(
    ' or '.join(f'name()="{tag}"' for tag in _WITHOUT_FRAMES)))
"""The elements in which an expression that is not expanded would change a frame."""
_XACRO_EXPRESSION = re.compile(r'\$[({]')
_LOCATIONS = ('uri', 'filename', '_map')
"""Ends of tags whose text is a location on which no frame depends, except in an include."""


class _Language(NamedTuple):
    """A language of templates."""

    name: str
    suffixes: tuple[str, ...]
    """Ends of the names of its files."""
    marks: re.Pattern[str]
    """Its expressions and statements, or their beginnings."""


_XACRO = _Language('xacro', ('.xacro',), re.compile('(?!)'))
"""Its expressions are an error, not a doubt, so they have rules of their own."""
_LANGUAGES = (
    _Language('Jinja', ('.jinja', '.jinja2', '.j2'), re.compile('{{|{%')),
    _Language('ERB', ('.erb',), re.compile('<%')),
    _Language('EmPy', ('.em', '.empy'), re.compile(r'@[({\[]')),
    _Language("Python's str.format", (), re.compile(
        r'(?<![$#%]){[A-Za-z_]\w*(?:[.:!\[][^{}"\s]*)?}')),
)


def hint_about_template(path: str, text: bytes) -> str:
    """
    Return the end of a message about a file that is not XML.

    :return: the language of templates that the file is written in, and the file to read instead;
        an empty string if there is none.
    """
    for language in _LANGUAGES:
        if path.endswith(language.suffixes) or language.marks.search(text.decode('latin-1')):
            return f'; the file {_cure(language, path)}'
    return ''


def hint_about_missing_file(path: str) -> str:
    """Return the template beside a missing file that makes it, as the end of a message; or ''."""
    for language in (_XACRO, *_LANGUAGES):
        template = _template(language, path)
        if template:
            return f'; {language.name} makes it of "{template}" beside it'
    return ''


def check_is_expanded(root: XmlElement, path: str, text: bytes, sources: Sources) -> None:
    """
    Refuse a file that xacro has not expanded yet, and warn about other templates.

    :param root: the content of the file.
    :param text: its text in UTF-8.
    :raises ParsingError: if it is for xacro.
    """
    # Python finds one byte much faster than two.
    if b'$' in text or b'xacro' in text:
        _refuse_xacro(root, path, sources)
    if b'{' in text or b'@' in text:
        _warn_about_template(root, path, sources)


def _warn_about_template(root: XmlElement, path: str, sources: Sources) -> None:
    """Warn about the first expression of a template; libsdformat takes it for a name."""
    for xml in _EXPANDED_PARTS(root):
        for value, found in _values(xml):
            for language in _LANGUAGES:
                if language.marks.search(value):
                    sources.warning(xml, f'{found} {_cure(language, path)}')
                    return


def _cure(language: _Language, path: str) -> str:
    """Return the end of a sentence about a template."""
    made = next((path.removesuffix(each) for each in language.suffixes if path.endswith(each)), '')
    file = (f'"{Path(made).name}" beside it' if made and Path(made).is_file()
            else 'the file that it writes')
    template = _template(language, path)
    source = f' on "{template}" beside it' if template else ''
    return f'is for {language.name}; run {language.name}{source} first, and read {file}'


def _template(language: _Language, path: str) -> str:
    """Return the name of the template that makes a file, if it is beside it; else ''."""
    # Unlike Path.is_file, this returns False for a name that is too long.
    templates = (f'{path}{suffix}' for suffix in language.suffixes)
    return next((Path(each).name for each in templates if os.path.isfile(each)), '')  # noqa: PTH113


def _values(xml: XmlElement) -> Iterator[tuple[str, str]]:
    """Return the values of the attributes and the text of an element, and where they are."""
    tag = written_tag(xml)
    for attribute, value in xml.items():
        yield value, f'{attribute}="{shortened(value)}" of <{tag}>'
    text = text_of(xml)
    yield text, f'"{shortened(text)}" in <{tag}>'


def _refuse_xacro(root: XmlElement, path: str, sources: Sources) -> None:
    """
    Refuse a file that xacro has not expanded yet.

    Otherwise it would be read with another meaning: macros are not called, and the content of
    ``<xacro:if>`` is left out. Only declarations, and expressions in plugins, in what is for
    ros2_control, in scripts, names of topics and locations of meshes, change no frame; the first
    one causes a warning.
    """
    name = Path(path).name
    is_xacro, is_sdf = name.endswith('.xacro'), root.tag == SourceFormat.SDFORMAT.tag
    location = None
    for xml in _EXPANDED_PARTS(root):
        tag, parent = written_tag(xml), xml.getparent()
        *attributes, (text, part) = _values(xml)
        found = [f'<{tag}>'] if tag.startswith('xacro:') else []
        found += [shown for value, shown in attributes if _XACRO_EXPRESSION.search(value)]
        if _XACRO_EXPRESSION.search(text) and not tag.endswith('topic'):
            if is_sdf and not is_xacro and tag.endswith(_LOCATIONS) and (
                    parent is not None and parent.tag != 'include'):
                location = location or (xml, part)
            else:
                found.append(part)
        if found:
            target = name.removesuffix('.xacro')
            if not Path(target).suffix:
                target += next((each.suffix for each in SourceFormat if each.tag == root.tag), '')
            while target == name or os.path.exists(Path(path).parent / target):  # noqa: PTH110
                target = f'expanded_{target}'
            command = f': {shlex.join(["xacro", name, "-o", target])}' if '.' in name else ''
            msg = (f'{found[0]} is for xacro; run xacro first, and read the file that it writes'
                   f'{command}')
            raise ParsingError(msg, Place(path, sources.line(xml)))
    if location is not None:
        msg = (f'{location[1]} is for xacro or launch files and is not expanded, so the file '
               'there is not found; no frame depends on it')
        sources.warning(location[0], msg)
        return
    for xml in root.iter('*'):
        if found := [part for value, part in _values(xml) if _XACRO_EXPRESSION.search(value)]:
            sources.warning(xml, (
                f'{found[0]} is for xacro or launch files and is not expanded; no frame depends '
                'on it, but names in Gazebo may'))
            return
