# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What the node is set to do: values judged before they are taken, free of ROS."""

from collections.abc import Iterable
from collections.abc import Mapping
import enum
from pathlib import Path
from typing import NamedTuple
from typing import TypeVar

from sdf_pose_bridge.scene.loading import MissingInclude
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.tree import AnchorModels
from sdf_pose_bridge.tf.tree import TfOptions

Choice = TypeVar('Choice', bound=enum.Enum)

FASTEST_RATE = 100.0
"""The most often that everything can be published again, in Hz."""

PUBLISHED_KINDS = {
    kind.label: kind for kind in Kind
    if kind not in (Kind.ROOT, Kind.WORLD, Kind.ACTOR)
}
"""The kinds of element that can become frames, by the names that ``kinds`` takes."""


class Problem(NamedTuple):
    """A value that cannot be taken."""

    parameter: str
    """Name of the parameter."""
    sentence: str
    """Says the parameter, its value and the rule that it breaks."""


class SettingsError(ValueError):
    """
    Values that cannot be taken.

    :param problems: all of them.
    """

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems = tuple(problems)
        super().__init__('\n'.join(problem.sentence for problem in self.problems))


class Settings(NamedTuple):
    """What the node is set to do."""

    sdf_file: str
    """Path or URI of the file."""
    resource_paths: tuple[Path, ...]
    """Directories in which included models are looked for first."""
    on_missing_include: MissingInclude
    """What to do about an include that cannot be found."""
    tf_options: TfOptions
    """What becomes a frame, and what it is called."""
    pose_topics: tuple[str, ...]
    """Glob patterns for the frame ids that get a topic of their own."""
    publish_rate: float
    """How often everything is published again, in Hz; 0 for once."""
    watch: bool
    """Whether the file and what it includes are watched for changes."""

    @property
    def file_settings(self) -> tuple[object, ...]:
        """Those that decide what is read and laid out; the rest decides how it is published."""
        return self.sdf_file, self.resource_paths, self.on_missing_include, self.tf_options


def settings_from_values(values: Mapping[str, object]) -> Settings:
    """
    Judge the values of all parameters.

    :param values: the value of each parameter of the node, by its name, and of the type that it is
        declared with.
    :return: the settings.
    :raises SettingsError: if any value breaks its rule; it has a sentence for each that does.
    """
    judge = _Judge(values)
    settings = Settings(
        sdf_file=judge.sdf_file(),
        resource_paths=tuple(
            Path(folder).expanduser() for folder in judge.texts('resource_paths') if folder),
        on_missing_include=judge.choice('on_missing_include', MissingInclude),
        tf_options=TfOptions(
            root_frame=judge.root_frame(),
            anchor_models=judge.choice('anchor_models', AnchorModels),
            model=judge.text('model'),
            frame_names=judge.choice('frame_names', FrameNames),
            frame_separator=judge.frame_separator(),
            frame_prefix=judge.frame_prefix(),
            kinds=judge.kinds(),
            optical_frames=values['optical_frames'] is True,
        ),
        pose_topics=judge.texts('pose_topics'),
        publish_rate=judge.publish_rate(),
        watch=values['watch'] is True,
    )
    if judge.problems:
        raise SettingsError(judge.problems)
    return settings


class _Judge:
    """Reads values and gathers what is wrong with them."""

    def __init__(self, values: Mapping[str, object]) -> None:
        self._values = values
        self.problems: list[Problem] = []

    def text(self, name: str) -> str:
        return str(self._values[name])

    def texts(self, name: str) -> tuple[str, ...]:
        values = self._values[name]
        return tuple(values) if isinstance(values, (list, tuple)) else ()

    def sdf_file(self) -> str:
        name = self.text('sdf_file')
        if not name:
            sentence = (
                'parameter sdf_file is not set; name the SDFormat file to publish, for example '
                'with: --ros-args -p sdf_file:=cell.sdf')
            self.problems.append(Problem('sdf_file', sentence))
        return name

    def choice(self, name: str, choices: type[Choice]) -> Choice:
        value = self.text(name)
        known = [choice.value for choice in choices]
        if value in known:
            return choices(value)
        self._refuse(name, value, f'one of {", ".join(known)}')
        return choices(known[0])

    def publish_rate(self) -> float:
        rate = self._values['publish_rate']
        if isinstance(rate, float) and 0.0 <= rate <= FASTEST_RATE:
            return rate
        self._refuse('publish_rate', rate, f'from 0.0 to {FASTEST_RATE} Hz')
        return 0.0

    def root_frame(self) -> str:
        name = self.text('root_frame')
        if not name:
            self._refuse('root_frame', name, 'a frame id, which is not empty')
        return self._without_leading_slash('root_frame', name)

    def frame_prefix(self) -> str:
        return self._without_leading_slash('frame_prefix', self.text('frame_prefix'))

    def frame_separator(self) -> str:
        separator = self.text('frame_separator')
        if not separator:
            self._refuse(
                'frame_separator', separator,
                'at least one character, or the names of different frames run together')
        return self._printable('frame_separator', separator)

    def kinds(self) -> frozenset[Kind]:
        names = self.texts('kinds')
        known = ', '.join(PUBLISHED_KINDS)
        if not names:
            self._refuse('kinds', [], f'at least one of {known}')
        for name in names:
            if name not in PUBLISHED_KINDS:
                self._refuse('kinds', name, f'made of {known}')
        return frozenset(PUBLISHED_KINDS[name] for name in names if name in PUBLISHED_KINDS)

    def _without_leading_slash(self, name: str, value: str) -> str:
        if value.startswith('/'):
            self._refuse(name, value, 'without a leading slash, which TF does not allow')
        return self._printable(name, value)

    def _printable(self, name: str, value: str) -> str:
        if not value.isprintable():
            self._refuse(name, value, 'without control characters')
        return value

    def _refuse(self, name: str, value: object, rule: str) -> None:
        sentence = f'parameter {name} is {_shown(value)}; it must be {rule}'
        self.problems.append(Problem(name, sentence))


def _shown(value: object) -> str:
    if isinstance(value, str):
        escaped = value if value.isprintable() else value.encode('unicode_escape').decode()
        return f'"{escaped}"'
    return str(value)
