# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Replace every ``<include>`` by the included element, so that one tree is left.

Source: ``readXml`` and ``insertIncludedElement`` in libsdformat's ``parser.cc``. An include that
is not found or not valid is reported and stays in the tree, so that no error follows from it.
"""

from __future__ import annotations

from functools import cache
import os
from pathlib import Path
from typing import NamedTuple

from lxml import etree

from sdf_pose_bridge.errors import (
    AttributeMissingError,
    ElementIncorrectTypeError,
    ElementInvalidError,
    ElementMissingError,
    FileReadError,
    LimitError,
    ParsingError,
    Place,
    PlacementFrameError,
    ReservedNameError,
    SdfError,
    UriLookupError,
)
from sdf_pose_bridge.names import is_reserved, ROOT_FRAME, SEPARATOR
from sdf_pose_bridge.printed_text import listed, shortened
from sdf_pose_bridge.sdformat.documents import Document, document_from_file
from sdf_pose_bridge.sdformat.element_reader import ElementReader
from sdf_pose_bridge.sdformat.grammar import definition_of
from sdf_pose_bridge.sdformat.include.manifests import model_file_from_directory, ModelFile
from sdf_pose_bridge.sdformat.include.merge import merge, ModelByItself, ModelCheck
from sdf_pose_bridge.sdformat.include.params import apply_params, definition_in_tree, TOP_TAGS
from sdf_pose_bridge.sdformat.include.uris import ResourceFinder
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.values import TRUE_TEXTS
from sdf_pose_bridge.sdformat.xml_tree import (
    attribute_of,
    child_elements,
    copy_of,
    described,
    first_child,
    first_children,
    value_at,
    value_of,
    written_tag,
    XmlElement,
)


class _IncludedFile(NamedTuple):
    """A file that was read, with the element in it that its includes mean."""

    top: XmlElement | None
    """None if there is none, or if the file is not valid."""
    fault: SdfError | None
    """An error of each of its includes, for the place of the include."""


class IncludeExpansion:
    """
    Replaces includes, and reads each included file once.

    :param skips_missing: whether includes that are not found are warnings.
    :param model_by_itself: checks the files that are merged, which have to be valid by themselves.
    """

    def __init__(
        self, finder: ResourceFinder, sources: Sources, *,
        skips_missing: bool,
        model_by_itself: ModelCheck,
    ) -> None:
        self._path_from_uri = cache(finder.path_from_uri)
        self._other_path_from_uri = cache(finder.other_path_from_uri)
        self._finder = finder
        # Not a cache of the method, which only a search for garbage would free.
        self._reasons: dict[tuple[str, str], str] = {}
        self._real_path = cache(os.path.realpath)
        self._sources = sources
        self._reader = ElementReader(sources)
        self._skips_missing = skips_missing
        self._model_by_itself = model_by_itself
        self._files: dict[str, _IncludedFile] = {}
        self._model_files: dict[str, ModelFile | str] = {}
        self._reported: set[str] = set()
        self._merged_models: dict[tuple[object, ...], ModelByItself | None] = {}

    def expand(self, document: Document) -> None:
        """Replace the includes of a file, in place."""
        self._expand_in(document.root, (os.path.realpath(document.path),))

    def _expand_in(self, root: XmlElement, files: tuple[str, ...]) -> None:
        """Replace the includes in a tree; ``files`` led to it, each included by the one before."""
        for include in list(root.iter('include')):
            parent = include.getparent()
            definition = None if parent is None else definition_in_tree(parent)
            if definition is not None and definition.value_type is None and (
                    not definition.takes_any_children):
                self._expand_include(include, files)
                if include.getparent() is not None:
                    self._mark_missing(include)

    def _mark_missing(self, include: XmlElement) -> None:
        """Record the URI of an include that is not replaced, by the names that it may have."""
        uri, name = value_at(include, 'uri') or 'no URI', value_at(include, 'name')
        names = [name] if name and not _is_merge(include) else ['', _name_from_uri(uri)]
        self._sources.set_origin(include, missing=dict.fromkeys(names, uri))

    def _expand_include(self, include: XmlElement, files: tuple[str, ...]) -> None:
        uri_xml = first_child(include, 'uri')
        if uri_xml is None:
            msg = 'the include has no <uri>, so it includes nothing'
            self._sources.error(AttributeMissingError, include, msg)
            return
        if not self._reader.is_valid(include, definition_of('include')):
            return
        place, uri = self._sources.place(include), value_of(uri_xml)
        found = self._included_file(place, uri, files)
        if isinstance(found, str):
            self._report_missing(place._replace(
                line=self._sources.line(uri_xml), element=f'{place.element}/uri'), uri, found)
            return
        chosen, fault = found
        if fault is not None:
            self._sources.error(type(fault), include, fault.message)
        if chosen is None:
            return
        top = self._sources.copy_of(chosen, include, include=place, is_checked=True)
        errors = self._sources.problems.error_count
        _override(include, top, self._sources)
        added = apply_params(include, top, self._sources, self._reader)
        if self._sources.problems.error_count > errors:
            return
        for each in added:
            self._expand_in(each, files)
        if _is_merge(include):
            self._merge(include, top, chosen)
        else:
            self._insert(include, top)

    # The file of an include

    def _included_file(
        self, place: Place, uri: str, files: tuple[str, ...],
    ) -> _IncludedFile | str:
        """Return a file, or the reason why it is not found."""
        path = self._path_from_uri(uri, place.file)
        if path is None:
            return self._reason_not_found(uri, place.file)
        other = self._other_path_from_uri(uri, place.file)
        msg = f'"{shortened(uri)}" is read from "{path}"; there is another one, "{other}"'
        if other is not None and msg not in self._reported:
            self._reported.add(msg)
            self._sources.problems.warning(msg, place)
        real_path = self._real_path(path)
        if real_path not in self._files and os.path.isdir(path):  # noqa: PTH112
            chosen = self._model_file(path)
            if isinstance(chosen, str):
                return chosen
            path = chosen.path
            real_path = self._real_path(path)
        if real_path in files:
            cycle = [*files[files.index(real_path):], real_path]
            names = ' -> '.join(Path(file).name for file in cycle)
            return f'the file includes itself: {names}'
        if len(files) >= self._sources.usage.limits.include_depth:
            return f'files include one another more than {len(files)} levels deep'
        if real_path not in self._files:
            self._sources.includes[path] = place
            self._files[real_path] = self._read(path, (*files, real_path))
        return self._files[real_path]

    def _reason_not_found(self, uri: str, file: str) -> str:
        if (uri, file) not in self._reasons:
            problems = self._sources.problems
            # Others are only counted.
            is_kept = problems.keeps_warnings() if self._skips_missing else problems.keeps_errors()
            self._reasons[uri, file] = self._finder.reason_not_found(
                uri, file, has_hint=problems.allows_hint()) if is_kept else ''
        return self._reasons[uri, file]

    def _model_file(self, directory: str) -> ModelFile | str:
        """Return the model file of a directory, read once, or why there is none."""
        key = os.path.realpath(directory)
        chosen = self._model_files.get(key)
        if chosen is None:
            try:
                chosen = model_file_from_directory(directory, self._sources.usage)
                self._sources.add_path(chosen.manifest)
                self._sources.problems.extend(chosen.warnings)
            except (FileReadError, ParsingError) as error:
                chosen = f'{error.place}: {error.message}'
            self._model_files[key] = chosen
        return chosen

    def _read(self, path: str, files: tuple[str, ...]) -> _IncludedFile:
        try:
            document = document_from_file(path, self._sources, is_included=True)
        except LimitError:
            raise
        except SdfError as error:
            self._sources.problems.extend(error.errors)
            return _IncludedFile(None, None)
        # Its copies are not checked again, except what includes change in them.
        self._sources.known_places = {}
        self._reader.is_valid(document.root, definition_of('sdf'))
        self._sources.known_places = None
        if next(document.root.iter('include'), None) is not None:
            self._sources.composed_trees.add(document.root)
            self._expand_in(document.root, files)
            self._check_depth(document.root)
        return _included_file(document)

    def _check_depth(self, root: XmlElement) -> None:
        """Check the depth before a tree is put into another one; recursion over it is limited."""
        depth = self._sources.usage.limits.depth
        for xml in root.xpath('descendant::*[count(ancestor::*) > $depth][1]', depth=depth):
            self._sources.check_depth(depth + 1, xml)

    def _report_missing(self, place: Place, uri: str, reason: str) -> None:
        msg = f'"{shortened(uri)}" cannot be included: {reason}'
        # A world may include the same model a hundred times.
        if msg in self._reported:
            return
        self._reported.add(msg)
        if self._skips_missing:
            self._sources.problems.warning(f'{msg}; it is left out', place)
        else:
            self._sources.problems.error(UriLookupError(msg, place))

    # The place of the included element

    def _merge(self, include: XmlElement, top: XmlElement, chosen: XmlElement) -> None:
        """Merge a copy of a model; names and poses of includes share the check by itself."""
        name = attribute_of(top, 'name')
        shared = chosen, self._sources.path(include), *(
            etree.tostring(each, with_tail=False)
            for each in include if each.tag not in ('name', 'pose'))
        keys = [shared, (*shared, name)]
        if is_reserved(name) or SEPARATOR in name:
            del keys[0]

        def model_by_itself(root: XmlElement) -> ModelByItself | None:
            key = next((each for each in keys if each in self._merged_models), None)
            if key is None:
                self._sources.set_source(root, include)
                # Its elements are read twice.
                self._sources.count_copy(root, include)
                known = self._model_by_itself(root)
                # Errors may contain the name.
                key = keys[-1 if known is None else 0]
                self._merged_models[key] = known
            return self._merged_models[key]

        merge(include, top, self._sources, model_by_itself)

    def _insert(self, include: XmlElement, top: XmlElement) -> None:
        parent = next(include.iterancestors())
        definition = definition_in_tree(parent)
        if definition is None or top.tag not in definition.children:
            msg = (f'the included {written_tag(top)} is left out; a <{written_tag(parent)}> '
                   'cannot hold one')
            self._sources.warning(include, msg)
            parent.remove(include)
        else:
            parent.replace(include, top)


def _is_merge(include: XmlElement) -> bool:
    # libsdformat asks TinyXML-2, which skips white space before a number only.
    return include.get('merge') in TRUE_TEXTS or attribute_of(include, 'merge') == '1'


def _included_file(document: Document) -> _IncludedFile:
    tops = [xml for xml in child_elements(document.root) if xml.tag in TOP_TAGS]
    top = min(tops, key=lambda xml: TOP_TAGS.index(str(xml.tag)), default=None)
    fault: SdfError | None = None
    if len(tops) > 1:
        names = listed([described(each) for each in tops])
        msg = f'{document.path} has more than one element at its top: {names}'
        fault = ElementIncorrectTypeError(msg, Place(document.path))
    # An include at its top that was not found is reported already.
    elif top is None and first_child(document.root, 'include') is None:
        msg = f'{document.path} cannot be included: no model, light or actor is at its top'
        fault = ElementMissingError(msg, Place(document.path))
    return _IncludedFile(top, fault)


def _name_from_uri(uri: str) -> str:
    steps = [part for part in uri.split('/') if part]
    if len(steps) > 1 and steps[-1].endswith(('.sdf', '.world', '.urdf')):
        steps.pop()
    return steps[-1] if steps else ''


# The parts that an include overrides

def _override(include: XmlElement, top: XmlElement, sources: Sources) -> None:
    """Set the attributes and values of an included element that its include has, too."""
    definition = definition_of(str(top.tag))
    given = first_children(include)
    own = {
        str(tag): given[tag] for tag, each in definition_of('include').children.items()
        if tag in given and each.value is not None
        and (tag in definition.attributes or tag in definition.children)}
    for tag, new in own.items():
        if tag in definition.attributes:
            top.set(tag, value_of(new))
        else:
            replacement, old = copy_of(new), first_child(top, tag)
            if old is None:
                top.insert(0, replacement)
            else:
                top.replace(old, replacement)
            sources.set_source(replacement, new)
        if tag != 'pose' and not value_of(new):
            sources.error(ElementInvalidError, new, f'<{tag}> of the include is empty')
    for plugin in child_elements(include, 'plugin'):
        top.append(copy_of(plugin))
    if 'name' in own:
        sources.set_origin(top, is_named_by_include=True)
    if 'pose' in own:
        sources.set_source_of_pose(top, include)
    placement = value_of(own['placement_frame']) if 'placement_frame' in own else ''
    if placement:
        if 'pose' not in own:
            msg = (f'<placement_frame> "{placement}" needs a <pose> in the same include, which '
                   'says where that frame is')
            sources.error(PlacementFrameError, include, msg)
        elif placement == ROOT_FRAME:
            msg = f'"{placement}" is reserved; it cannot be a placement frame'
            sources.error(ReservedNameError, include, msg)
