# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Know which file elements are read from, and report what is wrong with them."""

from __future__ import annotations

from collections.abc import Iterator
import contextlib

from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import ReservedNameError
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.sdformat.document import Document
from sdf_pose_bridge.sdformat.document import is_data
from sdf_pose_bridge.sdformat.document import WHITE_SPACE
from sdf_pose_bridge.sdformat.document import XmlElement
from sdf_pose_bridge.sdformat.element_columns import ElementColumns
from sdf_pose_bridge.sdformat.elements import NOWHERE
from sdf_pose_bridge.sdformat.elements import step
from sdf_pose_bridge.sdformat.include.inclusion import DEEPEST
from sdf_pose_bridge.sdformat.versions import may_hold_flat_names
from sdf_pose_bridge.sdformat.versions import Version
from sdf_pose_bridge.sdformat.versions import version_of


class Reading:
    """
    Which file is being read at the moment, and what is wrong with what is read.

    :param document: the file that is read at first.
    :param problems: takes what is wrong.
    """

    def __init__(self, document: Document, problems: Problems) -> None:
        self._problems = problems
        self._files = [document.path]
        self._versions = [version_of(document)]
        self._document = document
        self._file = 0
        self._open_files = [0]
        self.columns = ElementColumns()

    def version_of_element(self, index: int) -> Version:
        """
        Tell which version an element was written in.

        :param index: its index.
        :return: what its file declares.
        """
        return self._versions[self.columns.file(index)]

    def place_of(self, index: int) -> Place:
        """
        Tell where an element stands.

        :param index: its index.
        :return: its file and line.
        """
        return Place(self._files[self.columns.file(index)], self.columns.line(index))

    @contextlib.contextmanager
    def reading(self, document: Document) -> Iterator[None]:
        """
        Read from another file for a while.

        :param document: the file.
        """
        before = self._document, self._file
        if len(self._open_files) >= DEEPEST:
            msg = f'files and models are nested more than {DEEPEST} deep'
            raise ElementInvalidError(msg, Place(document.path))
        self._document, self._file = document, self._file_index(document)
        self._open_files.append(self._file)
        self.check_separators(document)
        try:
            yield
        finally:
            self._document, self._file = before
            self._open_files.pop()

    def check_separators(self, document: Document) -> None:
        """
        Report names that hold ``::``, which only old files may have.

        :param document: the file; an old one is judged by the newest that includes it.
        """
        if not document.may_hold_separators or self.allows_flat_names():
            return
        found: list[XmlElement] = document.root.xpath('//*[contains(@name, "::")]')
        for xml in found:
            if is_data(xml):
                msg = f'the name "{xml.get("name")}" holds "{SEPARATOR}", which sets scopes apart'
                steps = [str(e.tag) for e in (xml, *xml.iterancestors())]
                self.error(ReservedNameError, xml, msg, NOWHERE, '/'.join(steps[-2::-1]))

    @staticmethod
    def described(xml: XmlElement) -> str:
        """
        Return the step of an element's path that leads to it.

        :param xml: the element.
        :return: such as ``link[@name="l"]``.
        """
        return step(str(xml.tag), xml.get('name', '').strip(WHITE_SPACE))

    def note_error(self, error: SdfError) -> None:
        """
        Report an error that was found before.

        :param error: the error, with its place.
        """
        self._problems.error(error)

    def note_warning(self, warning: SdfWarning) -> None:
        """
        Report a warning that was found before.

        :param warning: the warning, with its place.
        """
        self._problems.warning(*warning)

    def error(
        self, error_class: type[SdfError], xml: XmlElement, message: str, parent: int, part: str,
    ) -> None:
        """
        Report an error at an XML element.

        :param error_class: its cause.
        :param xml: the XML element, for its line.
        :param message: one sentence.
        :param parent: index of the element that it belongs to; -1 for the file.
        :param part: the path from there on; empty for that element itself.
        """
        self._problems.error(error_class(message, self._place(xml, parent, part)))

    def warning(self, xml: XmlElement, message: str, parent: int, part: str) -> None:
        """
        Report a warning at an XML element.

        :param xml: the XML element, for its line.
        :param message: one sentence.
        :param parent: index of the element that it belongs to; -1 for the file.
        :param part: the path from there on; empty for that element itself.
        """
        self._problems.warning('WARNING', message, self._place(xml, parent, part))

    def _file_of(self, xml: XmlElement) -> int:
        return self._file_index(self._document.origin(xml))

    def _file_index(self, document: Document) -> int:
        for index, path in enumerate(self._files):
            if path == document.path:
                return index
        self._files.append(document.path)
        self._versions.append(version_of(document))
        return len(self._files) - 1

    def allows_flat_names(self) -> bool:
        """
        Tell whether names may hold ``::`` in what is being read.

        :return: whether all files that are open are old enough.
        """
        return all(may_hold_flat_names(self._versions[file]) for file in self._open_files)

    def _place(self, xml: XmlElement, parent: int, part: str) -> Place:
        path = self.columns.path(parent)
        return Place(
            self._files[self._file_of(xml)], xml.sourceline or 0,
            f'{path}/{part}' if part else path)
