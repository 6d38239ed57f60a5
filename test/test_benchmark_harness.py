# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The benchmarks' harness: who is timed, what is skipped and why, and what the table says."""

import pytest

from benchmarks import harness
from benchmarks.harness import (
    AtMostTimes,
    benchmark,
    Medians,
    PerSecond,
    result_of,
    TimesAsFast,
    Took,
    wait_until,
)

compared = benchmark('ours', counterpart='theirs', goal=AtMostTimes(2.0))


@pytest.fixture(autouse=True)
def short_runs(monkeypatch):
    monkeypatch.setattr(harness, 'SHORTEST_RUN_S', 0.0)


def test_what_is_not_installed_is_skipped_and_named():
    @compared
    def missing():
        import no_such_library
        yield no_such_library.ours, no_such_library.theirs

    result = result_of(missing)
    assert result.reached == 'skipped'
    assert result.ratio == 'skipped: no_such_library is not installed'


def test_a_benchmark_does_not_wait_forever(monkeypatch):
    monkeypatch.setattr(harness, 'DEADLINE_S', 0.05)

    @compared
    def alone():
        wait_until(lambda: False, 'nobody subscribed')
        yield

    assert result_of(alone).ratio == 'skipped: nobody subscribed within 0.05 s'


def test_other_errors_are_not_hidden():
    @compared
    def broken():
        yield lambda: 1 / 0, lambda: None

    with pytest.raises(ZeroDivisionError):
        result_of(broken)


def test_both_are_timed_in_turns_and_what_was_prepared_is_cleaned_up():
    calls = []

    @benchmark('ours', counterpart='theirs', goal=AtMostTimes(1e9))
    def recorded():
        calls.append('prepared')
        yield lambda: calls.append('ours'), lambda: calls.append('theirs')
        calls.append('cleaned up')

    assert result_of(recorded).reached == 'yes'
    assert calls[0] == 'prepared'
    assert calls[-1] == 'cleaned up'
    assert calls[-1 - 2 * harness.RUNS:-1] == ['ours', 'theirs'] * harness.RUNS
    assert harness.RUNS >= 7


@pytest.mark.parametrize(('goal', 'ours', 'theirs', 'reached', 'ratio'), [
    (AtMostTimes(2.0), 2e-3, 1e-3, True, '2.00 times the time'),
    (AtMostTimes(2.0), 2.01e-3, 1e-3, False, '2.01 times the time'),
    (TimesAsFast(3.0), 1e-3, 3e-3, True, '3.0 times as fast'),
    (TimesAsFast(3.0), 1e-3, 2.9e-3, False, '2.9 times as fast'),
    (TimesAsFast(3.0, 3e-6), 4e-6, 1.0, False, '250000.0 times as fast'),
    (TimesAsFast(), 1.0, 1.0, None, '1.0 times as fast'),
    (PerSecond(300.0, 100, 'poses'), 0.25, None, True, '400 poses per second'),
    (PerSecond(300.0, 100, 'poses'), 0.5, None, False, '200 poses per second'),
])
def test_goals_judge_the_medians(goal, ours, theirs, reached, ratio):
    medians = Medians(ours, theirs)
    assert goal.is_reached(medians) is reached
    assert goal.ratio(medians) == ratio


def test_what_a_function_has_measured_itself_counts():
    @compared
    def measuring():
        yield lambda: Took(3.0), lambda: Took(2.0)

    result = result_of(measuring)
    assert (result.ours, result.ratio) == ('3 s', '1.50 times the time')
