# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Errors and warnings about SDFormat files, with codes of libsdformat (``sdf::ErrorCode``).

All errors derive from :class:`SdfError`, and each cause has its own class.
"""

from __future__ import annotations

from collections.abc import Sequence
import re
from typing import NamedTuple

from sdf_pose_bridge.printed_text import shortened

_LONGEST_MESSAGE = 2000
_QUOTED = re.compile(r'"([^"]*)"')


def shortened_message(message: str) -> str:
    """Return a message of ``_LONGEST_MESSAGE`` characters at most, with shorter quoted values."""
    return _QUOTED.sub(
        lambda match: f'"{shortened(match[1])}"', shortened(message, _LONGEST_MESSAGE))


class Place(NamedTuple):
    """A place in the input."""

    file: str
    """Path of the file, as it was opened."""
    line: int = 0
    """Line in that file, from 1; 0 where no line can be named."""
    element: str = ''
    """Path of the element, such as ``/sdf/model[@name="m"]/link[@name="l"]``."""

    def __str__(self) -> str:
        return f'{self.file}:{self.line}' if self.line else self.file


class SdfWarning(NamedTuple):
    """A probable mistake in a file that libsdformat accepts."""

    code: str
    """Code of the corresponding error, or ``WARNING``."""
    message: str
    """One sentence."""
    place: Place
    is_for_gazebo: bool = False
    """Whether it concerns Gazebo only, in a URDF that is read as ROS reads it."""

    def __str__(self) -> str:
        return f'{self.place}: {self.code}: {self.message}'


class SdfError(Exception):
    """
    An error in an SDFormat file; the base class of all errors of the core.

    :param message: one sentence that names the value and the rule that it breaks; long values in
        it are shortened.
    """

    code: str = 'ERROR'
    file: str
    """As :attr:`Place.file`."""
    line: int
    """As :attr:`Place.line`."""
    element: str
    """As :attr:`Place.element`."""
    warnings: tuple[SdfWarning, ...] = ()
    """All warnings of the load that this error ended, in file order."""

    def __init_subclass__(cls, code: str = '') -> None:
        if code:
            cls.code = code

    def __init__(self, message: str, place: Place) -> None:
        message = shortened_message(message)
        super().__init__(message, place)
        self.message = message
        self.place = place
        self.file, self.line, self.element = place
        self._errors: tuple[SdfError, ...] = ()

    @property
    def errors(self) -> tuple[SdfError, ...]:
        """All errors of the load that this error ended, in file order."""
        return self._errors or (self,)

    def __str__(self) -> str:
        return f'{self.place}: {self.code}: {self.message}'


class LoadError(SdfError):
    """
    A file that is not valid. Code, message and place describe the first error.

    :param errors: one or more errors, in file order.
    :param warnings: the warnings, in file order.
    """

    def __init__(self, errors: Sequence[SdfError], warnings: Sequence[SdfWarning] = ()) -> None:
        super().__init__(errors[0].message, errors[0].place)
        self.args = (errors, warnings)
        self.code = errors[0].code
        self._errors = tuple(errors)
        self.warnings = tuple(warnings)

    def __str__(self) -> str:
        return '\n'.join(str(error) for error in self._errors)


class FileReadError(SdfError, code='FILE_READ'):
    """A file is missing, cannot be read, is not XML or declares no version."""


class TemporaryReadError(FileReadError):
    """A file cannot be read for a temporary reason: no descriptors, no memory, a disk."""


class LimitError(SdfError, code='LIMIT'):
    """The file exceeds a limit of the load."""


class ParsingError(SdfError, code='PARSING_ERROR'):
    """The XML is not SDFormat."""


class ConversionError(SdfError, code='CONVERSION_ERROR'):
    """The declared version is not supported."""


class AttributeInvalidError(SdfError, code='ATTRIBUTE_INVALID'):
    """An attribute has an invalid value."""


class AttributeMissingError(SdfError, code='ATTRIBUTE_MISSING'):
    """A required attribute is missing."""


class ElementInvalidError(SdfError, code='ELEMENT_INVALID'):
    """An element has an invalid value."""


class ElementMissingError(SdfError, code='ELEMENT_MISSING'):
    """A required element is missing."""


class ElementIncorrectTypeError(SdfError, code='ELEMENT_INCORRECT_TYPE'):
    """An element is not allowed at its place."""


class ReservedNameError(SdfError, code='RESERVED_NAME'):
    """A name is reserved."""


class DuplicateNameError(SdfError, code='DUPLICATE_NAME'):
    """Two elements of one scope have the same name."""


class ModelWithoutLinkError(SdfError, code='MODEL_WITHOUT_LINK'):
    """A model that is not static has neither a link nor a nested model."""


class CanonicalLinkError(SdfError, code='MODEL_CANONICAL_LINK_INVALID'):
    """``canonical_link`` does not name a frame."""


class RelativeToError(SdfError, code='POSE_RELATIVE_TO_INVALID'):
    """``relative_to`` or a placement frame does not name a frame."""


class RelativeToCycleError(SdfError, code='POSE_RELATIVE_TO_CYCLE'):
    """Poses are relative to one another in a cycle."""


class AttachedToError(SdfError, code='FRAME_ATTACHED_TO_INVALID'):
    """``attached_to`` does not name a frame."""


class AttachedToCycleError(SdfError, code='FRAME_ATTACHED_TO_CYCLE'):
    """Frames are attached to one another in a cycle."""


class LinkInertiaError(SdfError, code='LINK_INERTIA_INVALID'):
    """The inertia of a link cannot be computed."""


class JointChildError(SdfError, code='JOINT_CHILD_LINK_INVALID'):
    """The child of a joint is not valid."""


class JointParentError(SdfError, code='JOINT_PARENT_LINK_INVALID'):
    """The parent of a joint is not valid."""


class JointSameLinkError(SdfError, code='JOINT_PARENT_SAME_AS_CHILD'):
    """The parent and the child of a joint are the same body."""


class ExpressedInError(SdfError, code='JOINT_AXIS_EXPRESSED_IN_INVALID'):
    """The frame that a joint's axis is expressed in does not exist."""


class MimicError(SdfError, code='JOINT_AXIS_MIMIC_INVALID'):
    """The joint or the axis that a joint's axis mimics does not exist, or is that axis itself."""


class UriLookupError(SdfError, code='URI_LOOKUP'):
    """The URI of an include was not found."""


class PlacementFrameError(SdfError, code='MODEL_PLACEMENT_FRAME_INVALID'):
    """An include has a placement frame, but no pose."""


class MergeIncludeError(SdfError, code='MERGE_INCLUDE_UNSUPPORTED'):
    """An element cannot be merged into the element that includes it."""


class PoseNotSetError(SdfError, code='POSE_NOT_SET'):
    """The requested pose cannot be written into the file."""


class UrdfNotMadeError(SdfError, code='URDF_NOT_MADE'):
    """No URDF can be made of a file."""


class FileWriteError(SdfError, code='FILE_WRITE'):
    """A file cannot be written; it is as before."""


class JointPositionError(SdfError, ValueError, code='JOINT_POSITION_INVALID'):
    """
    A query about positions of joints is not valid.

    It names an unknown joint, gives an invalid position, or depends on a joint without a reported
    position.
    """


class UnknownFrameError(SdfError, LookupError, code='UNKNOWN_FRAME'):
    """A query names a frame that does not exist, or one of several with the same name."""


class AddressError(ValueError):
    """An address does not name a file."""
