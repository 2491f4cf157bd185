"""Recording of one radio channel: a thread that supervises the process that captures it.

Whatever the source or that process does, the station goes on: a process that gives nothing is
ended, and begun again after a pause that grows.  Missed audio is a gap in the channel's log.
"""

from __future__ import annotations

import logging
import os
import select
import signal
import subprocess
import sys
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from threading import Lock

import msgspec

from base_station.radio.capture_wire import PACKET, Captured, CaptureDecoder, decode_problem
from base_station.radio.config import RadioConfig
from base_station.radio.packets import Packet, payload_of
from base_station.views.text_code import text_code_view_or_none
from base_station.views.wire import RadioView
from shared.clock import NS_PER_MS, NS_PER_S, Clock
from shared.coded_text import code_of_text, coded, text_of_error
from shared.errors import LogError
from shared.mcap_log import SegmentPolicy, SegmentWriter, audio_topic, recover_log
from shared.worker import Worker

logger = logging.getLogger(__name__)

_TURN_MS = 500
_CONNECTS_NS, _HANGS_NS = 20 * NS_PER_S, 6 * NS_PER_S  # without a packet
_RETRY_S, _LONGEST_RETRY_S = 1.0, 30.0
_STEADY_NS = 30 * NS_PER_S  # recorded for so long: the next pause is short again
_OVERLAP_NS = 60 * NS_PER_MS  # packets that overlap more with recorded ones are left out
_POLICY = SegmentPolicy(flush_every_s=2.0)
_PIPE_BYTES = 65_536
_ENDS_WITHIN_S = 2.0


_BROKE_OFF = coded("radio-capture-broke-off", "the process that captures it broke off")


@dataclass(slots=True)
class _CaptureRun:
    """One run of the process."""

    process: subprocess.Popen[bytes]
    last_ns: int  # monotonic, of the last packet or of its start
    packets_since_ns: int | None = None  # None: none came


class RadioChannel:
    """``start`` once, ``close`` once."""

    def __init__(self, name: str, config: RadioConfig, folder: Path, clock: Clock) -> None:
        """``folder``: of this channel's log; ``clock``: the station's."""
        self._name = name
        self._config = config
        self._folder = folder
        self._clock = clock
        self._topic = audio_topic(name)
        self._writing = Lock()
        self._writer: SegmentWriter | None = None
        self._recorded_until_ns = 0  # station time
        self._problem: str = ""
        self._is_recording = False
        self._retry_s = _RETRY_S
        self._worker = Worker(f"radio-{name}", self._step, f"radio channel {name} is not recorded")

    def start(self) -> None:
        self._worker.start()

    def close(self) -> None:
        """Put all packets so far on the disk, where that answers."""
        self._worker.stop()
        if self._worker.join(_ENDS_WITHIN_S) and self._writer is not None:
            self._writer.close()

    def end_segment(self) -> None:
        """Complete the segments of all that is recorded so far."""
        with self._writing:
            if self._writer is not None:
                self._writer.end_segment()

    def view(self) -> RadioView:
        return RadioView(
            name=self._name,
            source=self._config.shown_source,
            state="recording" if self._is_recording else "away",
            problem=str(self.problem),
            problem_code=text_code_view_or_none(code_of_text(self.problem)),
        )

    @property
    def problem(self) -> str:
        """Sentence for a person; empty: it is recorded."""
        return self._problem or (self._writer.problem if self._writer is not None else "")

    # ---- in the thread

    def _step(self) -> float:
        """One run of the process; gives the pause after it."""
        try:
            self._open_log()
        except LogError as error:
            self._problem = text_of_error(error)
            return self._longer_pause()
        run = self._begin()
        try:
            problem = self._record(run)
        finally:
            self._is_recording = False
            _kill(run.process)
        if self._worker.stopping.is_set():
            return 0.0
        self._problem = coded(
            "radio-not-recorded",
            "Radio channel {name} is not recorded: {reason}",
            name=self._name,
            reason=problem,
        )
        logger.warning("%s", self._problem)
        now_ns = self._clock.monotonic_ns()
        if run.packets_since_ns is not None and now_ns - run.packets_since_ns > _STEADY_NS:
            self._retry_s = _RETRY_S
        return self._longer_pause()

    def _longer_pause(self) -> float:
        pause_s, self._retry_s = self._retry_s, min(2.0 * self._retry_s, _LONGEST_RETRY_S)
        return pause_s

    def _open_log(self) -> None:
        if self._writer is None:
            if self._folder.is_dir():
                recover_log(self._folder)
            self._writer = SegmentWriter(self._folder, _POLICY)

    def _begin(self) -> _CaptureRun:
        process = subprocess.Popen(
            (sys.executable, "-m", "base_station.radio.capture"),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        assert process.stdin is not None
        with suppress(OSError):  # it is gone already: its end is noted elsewhere
            process.stdin.write(msgspec.json.encode(self._config) + b"\n")
            process.stdin.flush()
        return _CaptureRun(process, self._clock.monotonic_ns())

    def _record(self, run: _CaptureRun) -> str:
        """Take packets until none come any more; gives the problem, in words."""
        assert run.process.stdout is not None
        pipe, decoder, problem = run.process.stdout.fileno(), CaptureDecoder(), ""
        poll = select.poll()
        poll.register(pipe, select.POLLIN)
        while not self._worker.stopping.is_set():
            if poll.poll(_TURN_MS):
                data = os.read(pipe, _PIPE_BYTES)
                if not data:
                    return problem or _BROKE_OFF
                problem = self._take(run, list(decoder.push(data))) or problem
            elif self._clock.monotonic_ns() - run.last_ns > _patience_ns(run):
                return coded(
                    "radio-source-silent",
                    "{source} gives nothing",
                    source=self._config.shown_source,
                )
        return ""

    def _take(self, run: _CaptureRun, captured: list[Captured]) -> str:
        """Log packets; gives the problem that the process reports, if any."""
        now_ns = self._clock.monotonic_ns()
        to_utc_ns = self._clock.utc_ns() - now_ns
        problem = ""
        with self._writing:
            for one in captured:
                if one.kind != PACKET:
                    problem = decode_problem(one.content)
                    continue
                self._log(Packet(one.t_mono_ns + to_utc_ns, one.content))
                run.last_ns = now_ns
                run.packets_since_ns = run.packets_since_ns or now_ns
                self._is_recording, self._problem = True, ""
        return problem

    def _log(self, packet: Packet) -> None:
        """Leave out packets of recorded times: of a source that repeats itself, or after the clock
        was set back.
        """
        assert self._writer is not None
        if packet.t_ns < self._recorded_until_ns - _OVERLAP_NS:
            return
        self._writer.write(packet.t_ns, self._topic, payload_of(packet))
        self._recorded_until_ns = packet.end_ns


def _patience_ns(run: _CaptureRun) -> int:
    return _CONNECTS_NS if run.packets_since_ns is None else _HANGS_NS


def _kill(process: subprocess.Popen[bytes]) -> None:
    """Kill it with the processes that it has started."""
    with suppress(OSError):
        os.killpg(process.pid, signal.SIGKILL)
    with process:  # its pipes are closed, and its end is noted
        pass
