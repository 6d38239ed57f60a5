# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Errors and warnings about SDFormat files.

All errors derive from :class:`SdfError`, with one class for each cause. The codes are from
libsdformat (``sdf::ErrorCode``).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from sdf_pose_bridge.names import shortened_message


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

    def __init__(self, message: str, place: Place) -> None:
        message = shortened_message(message)
        super().__init__(message, place)
        self.message = message
        self.place = place
        self._errors: tuple[SdfError, ...] = ()
        self._warnings: tuple[SdfWarning, ...] = ()

    @property
    def file(self) -> str:
        """Path of the file, as it was opened."""
        return self.place.file

    @property
    def line(self) -> int:
        """Line in that file, from 1; 0 where no line can be named."""
        return self.place.line

    @property
    def element(self) -> str:
        """Path of the element, such as ``/sdf/model[@name="m"]/link[@name="l"]``."""
        return self.place.element

    @property
    def errors(self) -> tuple[SdfError, ...]:
        """All errors of the load that this error ended, in file order."""
        return self._errors or (self,)

    @property
    def warnings(self) -> tuple[SdfWarning, ...]:
        """All warnings of the load that this error ended, in file order."""
        return self._warnings

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
        self._warnings = tuple(warnings)

    def __str__(self) -> str:
        return '\n'.join(str(error) for error in self._errors)


class FileReadError(SdfError):
    """A file is missing, cannot be read, is not XML or declares no version."""

    code = 'FILE_READ'


class PassingReadError(FileReadError):
    """A file cannot be read for a temporary reason: no descriptors, no memory, a disk."""


class LimitError(SdfError):
    """The file exceeds a limit of the load."""

    code = 'LIMIT'


class ParsingError(SdfError):
    """The XML is not SDFormat."""

    code = 'PARSING_ERROR'


class ConversionError(SdfError):
    """The declared version is not supported."""

    code = 'CONVERSION_ERROR'


class AttributeInvalidError(SdfError):
    """An attribute has an invalid value."""

    code = 'ATTRIBUTE_INVALID'


class AttributeMissingError(SdfError):
    """A required attribute is missing."""

    code = 'ATTRIBUTE_MISSING'


class ElementInvalidError(SdfError):
    """An element has an invalid value."""

    code = 'ELEMENT_INVALID'


class ElementMissingError(SdfError):
    """A required element is missing."""

    code = 'ELEMENT_MISSING'


class ElementIncorrectTypeError(SdfError):
    """An element is not allowed at its place."""

    code = 'ELEMENT_INCORRECT_TYPE'


class ReservedNameError(SdfError):
    """A name is reserved."""

    code = 'RESERVED_NAME'


class DuplicateNameError(SdfError):
    """Two elements of one scope have the same name."""

    code = 'DUPLICATE_NAME'


class ModelWithoutLinkError(SdfError):
    """A model that is not static has neither a link nor a nested model."""

    code = 'MODEL_WITHOUT_LINK'


class CanonicalLinkError(SdfError):
    """``canonical_link`` does not name a frame."""

    code = 'MODEL_CANONICAL_LINK_INVALID'


class RelativeToError(SdfError):
    """``relative_to`` or a placement frame does not name a frame."""

    code = 'POSE_RELATIVE_TO_INVALID'


class RelativeToCycleError(SdfError):
    """Poses are relative to one another in a cycle."""

    code = 'POSE_RELATIVE_TO_CYCLE'


class AttachedToError(SdfError):
    """``attached_to`` does not name a frame."""

    code = 'FRAME_ATTACHED_TO_INVALID'


class AttachedToCycleError(SdfError):
    """Frames are attached to one another in a cycle."""

    code = 'FRAME_ATTACHED_TO_CYCLE'


class LinkInertiaError(SdfError):
    """The inertia of a link cannot be computed."""

    code = 'LINK_INERTIA_INVALID'


class JointChildError(SdfError):
    """The child of a joint is not valid."""

    code = 'JOINT_CHILD_LINK_INVALID'


class JointParentError(SdfError):
    """The parent of a joint is not valid."""

    code = 'JOINT_PARENT_LINK_INVALID'


class JointSameLinkError(SdfError):
    """The parent and the child of a joint are the same body."""

    code = 'JOINT_PARENT_SAME_AS_CHILD'


class ExpressedInError(SdfError):
    """The frame that a joint's axis is expressed in does not exist."""

    code = 'JOINT_AXIS_EXPRESSED_IN_INVALID'


class MimicError(SdfError):
    """The joint or the axis that a joint's axis mimics does not exist, or is that axis itself."""

    code = 'JOINT_AXIS_MIMIC_INVALID'


class UriLookupError(SdfError):
    """The URI of an include was not found."""

    code = 'URI_LOOKUP'


class PlacementFrameError(SdfError):
    """An include has a placement frame, but no pose."""

    code = 'MODEL_PLACEMENT_FRAME_INVALID'


class MergeIncludeError(SdfError):
    """An element cannot be merged into the element that includes it."""

    code = 'MERGE_INCLUDE_UNSUPPORTED'


class PoseNotSetError(SdfError):
    """The requested pose cannot be written into the file."""

    code = 'POSE_NOT_SET'


class UrdfNotMadeError(SdfError):
    """No URDF can be made of a file."""

    code = 'URDF_NOT_MADE'


class FileWriteError(SdfError):
    """A file cannot be written; it is as before."""

    code = 'FILE_WRITE'


class JointPositionError(SdfError, ValueError):
    """
    A query about positions of joints is not valid.

    It names an unknown joint, gives an invalid position, or depends on a joint without a reported
    position.
    """

    code = 'JOINT_POSITION_INVALID'


class UnknownFrameError(SdfError, LookupError):
    """A query names a frame that does not exist, or one of several with the same name."""

    code = 'POSE_RELATIVE_TO_INVALID'


class AddressError(ValueError):
    """An address does not name a file."""
