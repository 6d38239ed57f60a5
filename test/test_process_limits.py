# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Limits of this process, which are restored."""

import resource
import time

import pytest
from sdf_texts import LINK, model_file

from sdf_pose_bridge import Limits, load_text
from sdf_pose_bridge.process_limits import (
    Allowance,
    lift_limits,
    limited,
    LimitExceededError,
    raise_limits,
    renew_limits,
)

AMPLE = Allowance(
    processor_s=1000.0, memory_bytes=1_000_000_000, seconds_per_megabyte=10.0,
    memory_bytes_per_megabyte=500_000_000)
KINDS = resource.RLIMIT_CPU, resource.RLIMIT_AS


def soft_limits():
    return [resource.getrlimit(kind)[0] for kind in KINDS]


@pytest.fixture(autouse=True)
def check_that_limits_are_restored():
    before = soft_limits()
    yield
    assert soft_limits() == before


def test_a_request_for_more_memory_is_an_error():
    with pytest.raises(LimitExceededError) as caught, limited(AMPLE):
        bytearray(1_500_000_000)
    assert str(caught.value) == 'more than 1000 MB of memory'


def test_the_processor_time_can_be_renewed(monkeypatch):
    with limited(AMPLE):
        before = soft_limits()
        used_s = time.process_time()
        monkeypatch.setattr(time, 'process_time', lambda: used_s + 50.0)
        renew_limits()
        assert [b - a for a, b in zip(before, soft_limits(), strict=True)] in (
            [50, 0], [51, 0])
    renew_limits()


def test_other_exceptions_pass():
    with pytest.raises(ZeroDivisionError), limited(AMPLE):
        divmod(1, 0)


def test_what_is_read_raises_limits():
    begin_s = time.process_time()
    with limited(AMPLE):
        before = soft_limits()
        assert begin_s + 1000 <= before[0] < time.process_time() + 1001
        for _ in range(1000):
            raise_limits(1000, 2000.0, 2e9)
        after = soft_limits()
        assert [b - a for a, b in zip(before, after, strict=True)] == [10, 500_000_000]
        bytearray(1_400_000_000)


@pytest.mark.parametrize(('end', 'growth'), [
    (b' ', [5, 200]), (b'\0', [0, 0])], ids=['ceiling', 'zero byte'])
def test_a_file_raises_limits_up_to_a_ceiling_and_before_its_first_zero_byte(end, growth):
    text = model_file(LINK).encode() + end + b' ' * 2_000_000
    with limited(AMPLE):
        before = soft_limits()
        load_text(text, limits=Limits(processor_s=1005, memory_bytes=1_200_000_000))
        (s_before, bytes_before), (s, byte_count) = before, soft_limits()
        assert [s - s_before, (byte_count - bytes_before) // 1_000_000] == growth


def test_the_message_names_the_raised_limit():
    def read_and_use():
        raise_limits(1_000_000, 2000.0, 2e9)
        bytearray(1_600_000_000)

    with pytest.raises(LimitExceededError, match='more than 1500 MB'), limited(AMPLE):
        read_and_use()


def test_nothing_else_is_changed_by_what_is_read():
    before = soft_limits()
    raise_limits(1_000_000, 2000.0, 2e9)
    assert soft_limits() == before


def test_limits_can_be_lifted_for_another_program():
    before = soft_limits()
    with limited(AMPLE):
        lift_limits()
        assert soft_limits() == before


@pytest.mark.parametrize(('kind', 'limit'), [
    (resource.RLIMIT_CPU, 900), (resource.RLIMIT_AS, 100_000_000_000)])
def test_a_lower_limit_of_the_user_stays(kind, limit):
    allowance = AMPLE._replace(memory_bytes=10**12)
    before = resource.getrlimit(kind)
    resource.setrlimit(kind, (limit, before[1]))
    try:
        with limited(allowance):
            raise_limits(1_000_000, 2000.0, 2e9)
            assert resource.getrlimit(kind) == (limit, before[1])
        if kind == resource.RLIMIT_AS:
            with pytest.raises(MemoryError), limited(allowance):
                bytearray(limit)
    finally:
        resource.setrlimit(kind, before)
