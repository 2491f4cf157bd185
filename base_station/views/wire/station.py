"""Views of the station's own state and of its connections."""

from __future__ import annotations

from typing import Annotated

from base_station.views.answer import Answer
from base_station.views.wire.schema import one_of
from base_station.views.wire.text_code import TextCodeView


class StandbyView(Answer, frozen=True):
    """State of this station as one of two."""

    station: str  # its name
    role: str  # active | standby | waiting
    url: str  # where consoles find it
    other: str  # "" until the other one's first heartbeat
    other_role: str  # "" while it is not reachable
    other_url: str
    in_step: bool  # the standby has what the active station has


class RecordingView(Answer, frozen=True):
    """A unit's raw recording that was requested, on its way over the bus."""

    fetch_id: str
    unit_id: str
    state: str  # waiting | fetching | done | failed
    problem: str  # a sentence for a person
    done_bytes: int
    total_bytes: int  # 0: not known yet
    problem_code: TextCodeView | None = None  # of ``problem``, where it has one


class ForwarderView(Answer, frozen=True):
    """A live connection with another system, such as a TAK server."""

    name: str  # as in the settings
    kind: str  # tak
    address: str
    state: Annotated[str, one_of("connected", "connecting", "standby")]  # standby: the other of
    # two stations forwards
    since_ms: int | None  # of that state; None: since the station started
    sent: int  # events since the station started
    received: int  # of other teams, since then
    refused: int  # of other teams, that could not be read or were too many
    text: str  # for a person: why it is not connected, or why less is sent; empty: all is well
    text_code: TextCodeView | None = None  # of ``text``, where it has one


class RadioView(Answer, frozen=True):
    """A radio channel whose audio is recorded."""

    name: str  # as in the settings
    source: str  # device:NAME or a URL, without a password
    state: Annotated[str, one_of("recording", "away")]
    problem: str  # a sentence for a person; empty: it is recorded
    problem_code: TextCodeView | None = None  # of ``problem``, where it has one


class ArchiveView(Answer, frozen=True):
    """The archive to which the station copies closed incidents by itself."""

    location: str  # a folder, or s3://BUCKET/PLACE
    state: Annotated[str, one_of("waiting", "copying", "away")]
    waiting: int  # closed incidents that are not there yet
    copied: int  # since the station started
    archived_ms: int | None  # when the last one was; null: none since the station started
    text: str  # for a person: why nothing can be copied; empty: all is well
    text_code: TextCodeView | None = None  # of ``text``, where it has one


class HealthView(Answer, frozen=True):
    """The station's own state; ``problems`` are sentences for a person."""

    problems: tuple[str, ...]
    messages: int
    undecodable: int
    unknown_units: int
    log_bytes: int
    disk_free_bytes: int
    messages_per_s: float
    insecure: bool
    standby: StandbyView | None = None  # None: this is the only station
    recordings: tuple[RecordingView, ...] = ()
    repeated: int = 0  # messages since the station started that came again and were kept once
    left_out: int = 0  # since then, as they came faster than this machine takes them
    missing: int = 0  # since then, numbers of messages that no unit's journal has any more
    forwarders: tuple[ForwarderView, ...] = ()  # live connections with other systems
    radio: tuple[RadioView, ...] = ()  # channels whose audio is recorded
    archive: ArchiveView | None = None  # None: incidents are archived by a command alone
    reading: float | None = None  # share of its log; the last stored state is shown
    problem_codes: tuple[TextCodeView, ...] = ()  # of ``problems``, in their order
