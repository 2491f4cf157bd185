"""Check that a unit makes by itself at its start, beside everything else.

It is the short form: no person has to lay the unit down or press a button, no output plays, and
link and clock are not checked.  It watches the sensors for some seconds.  A fault that it has found
is removed when it is gone, as with a sensor that appears later, and none is added: a later failure
is an event of its own.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Iterator, Mapping
from threading import Thread

from edge.config import EdgeConfig
from edge.preflight.auxiliary_survey import AuxiliarySurvey
from edge.preflight.finding import CheckFinding, Severity, subject
from edge.preflight.inertial_survey import InertialSurvey
from edge.preflight.output_check import NO_OUTPUT
from edge.samples import SensorBatch, SensorDescription
from edge.sources.interface import Quantity
from shared.clock import NS_PER_S
from shared.coded_text import coded, text_of_error
from shared.messages import PreflightFinding, PreflightLevel

logger = logging.getLogger(__name__)

SURVEY_S = 10.0  # as `muster edge check` does
_AGAIN_NS = 5 * NS_PER_S
_LEVELS = {Severity.FAILED: PreflightLevel.FAILED, Severity.WARNING: PreflightLevel.WARNING}
_NO_ANSWER = CheckFinding(
    subject("disk", "disk"),
    Severity.WARNING,
    coded("check-disk-silent", "it does not answer"),
    "messages may be kept nowhere: look at its log",
)


class StartCheck:
    """``start`` it once; ``push`` what is read and ``step`` again and again.  None of its methods
    waits or raises.
    """

    def __init__(
        self,
        config: EdgeConfig,
        sensors: Mapping[str, SensorDescription],
        gives: frozenset[Quantity],
        installation: Callable[[], Iterable[CheckFinding]],
    ) -> None:
        """``sensors``: by their names.  ``installation``: makes the findings that need the disk,
        in a thread of its own.
        """
        self._inertial: dict[str, InertialSurvey] | None = {  # None: it is over
            name: InertialSurvey(sensor, name) for name, sensor in sensors.items()
        }
        self._of_inertial: list[CheckFinding] = []
        self._auxiliary = AuxiliarySurvey(config, gives)
        self._has_output = bool(config.outputs)
        self._installation = installation
        self._of_disk = [_NO_ANSWER]
        self._left: list[CheckFinding] | None = None  # None: the survey goes on
        self._due_ns: int | None = None  # when it looks next; None: not started, or given up
        self._error: Exception | None = None
        self._thread = Thread(target=self._check_installation, name="start-check", daemon=True)

    def start(self, mono_ns: int) -> None:
        self._due_ns = mono_ns + round(SURVEY_S * NS_PER_S)
        self._thread.start()

    def push(self, batch: SensorBatch) -> None:
        """Take in what was read."""
        if self._error is not None:
            return
        try:
            if self._inertial is not None and len(batch.imu):
                self._inertial[batch.sensor].push(batch.imu)
            for sample in batch.others:
                self._auxiliary.push(sample)
        except Exception as error:  # noqa: BLE001  # reported by the next step
            self._error = error

    def step(self, mono_ns: int) -> tuple[PreflightFinding, ...] | None:
        """Return what is wrong or missing, where that is news; None else."""
        if self._due_ns is None or mono_ns < self._due_ns:
            return None
        self._due_ns = mono_ns + _AGAIN_NS
        try:
            return self._open_findings()
        except Exception as error:  # the unit goes on without its check
            logger.exception("the check at the start has failed")
            self._due_ns = None
            text = coded(
                "check-broken", "it has failed ({error})", error=f"{type(error).__name__}: {error}"
            )
            about = subject("start_check", "check at the start")
            return _as_message([CheckFinding(about, Severity.WARNING, text)])

    def _open_findings(self) -> tuple[PreflightFinding, ...] | None:
        if self._error is not None:
            raise self._error
        if self._inertial is not None:
            self._of_inertial = [
                finding
                for survey in self._inertial.values()
                for finding in survey.findings(asks_rest=False)
            ]
            self._inertial = None
        now = [one for one in self._found() if one.level is not Severity.OK]
        if self._left is None:
            for finding in now:
                _log(finding)
            self._left = now
            return _as_message(now)
        subjects = {finding.subject for finding in now}
        left = [finding for finding in self._left if finding.subject in subjects]
        if left == self._left:
            return None
        self._left = left
        return _as_message(left)

    def _found(self) -> Iterator[CheckFinding]:
        yield from self._of_disk
        yield from self._of_inertial
        yield from self._auxiliary.findings(asks_press=False)
        if not self._has_output:
            yield NO_OUTPUT

    def _check_installation(self) -> None:
        try:
            self._of_disk = list(self._installation())
        except Exception as error:  # a unit must start in any case
            logger.exception("the data folder cannot be checked")
            self._of_disk = [
                CheckFinding(subject("disk", "disk"), Severity.FAILED, text_of_error(error))
            ]


def _log(finding: CheckFinding) -> None:
    level = logging.WARNING if finding.level is Severity.FAILED else logging.INFO
    costs = f" ({finding.remedy})" if finding.remedy else ""
    logger.log(level, "check at the start: %s: %s%s", finding.subject, finding.text, costs)


def _as_message(findings: Iterable[CheckFinding]) -> tuple[PreflightFinding, ...]:
    """Return the findings as they are published, the gravest first."""
    sent = (
        PreflightFinding.of(_LEVELS[one.level], one.subject, one.text, one.remedy)
        for one in findings
    )
    return tuple(sorted(sent, key=lambda one: -one.level))
