"""Tests of the console's generated types against the structs and the API of the station."""

from __future__ import annotations

import pytest

from tests.rig.answer_types import answer_files
from tests.rig.console_types import (
    ANSWERS,
    DEPARTMENT_TS,
    WIRE,
    department_types,
    read_types,
)
from tests.rig.live_page import LIVE_MD, LIVE_SCHEMA, page, schema_file
from tests.rig.wire_types import wire_files


def test_types_of_the_console_are_those_of_the_station() -> None:
    assert read_types(WIRE) == wire_files(), "run: python -m tests.rig.console_types"


def test_types_of_requests_and_answers_are_those_of_the_api() -> None:
    assert read_types(ANSWERS) == answer_files(), "run: python -m tests.rig.console_types"
    written = DEPARTMENT_TS.read_text(encoding="utf-8")
    assert written == department_types(), "run: python -m tests.rig.console_types"


def test_page_about_the_websocket_is_generated_from_the_messages() -> None:
    """The page describes every member; otherwise its generation fails."""
    assert LIVE_MD.read_text(encoding="utf-8") == page(), "run: python -m tests.rig.console_types"
    assert LIVE_SCHEMA.read_text(encoding="utf-8") == schema_file(), "the same command"


@pytest.mark.parametrize(
    "declared",
    [
        "export interface UnitView {",
        '  link: "live" | "lost" | "never" | "stale";',  # values of a string
        "  reach: [number, number][];",
        "  position: PositionView | null;",
        "  after_gap?: 0 | 1,",  # left out of an array where it is the default
        '  type: "delta";',
        "  trails?: Record<string, TrailPoint[]>;",  # left out of a delta, never null
        "  pins?: PinView[];",
        "  plan: Plan | null;",
    ],
)
def test_generated_types_declare_what_a_message_may_hold(declared: str) -> None:
    assert declared in _lines(read_types(WIRE))


@pytest.mark.parametrize(
    "declared",
    [
        "export interface PinForm {",
        "  std_m?: number;",  # has a default
        "  floor?: number | null;",
        "  raisings: Raising[];",
        "  upper_left: [number, number];",
        "  target: UnitTarget | CrewTarget | FloorTarget | EveryoneTarget;",
        'export type TrailKind = "raw" | "fused" | "smoothed";',
    ],
)
def test_generated_types_declare_requests_and_answers(declared: str) -> None:
    assert declared in _lines(read_types(ANSWERS))


def _lines(files: dict[str, str]) -> list[str]:
    return [line for content in files.values() for line in content.split("\n")]
