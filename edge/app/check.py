"""Check of a unit before its wearer goes in, with the settings of ``muster edge run``."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import closing
from datetime import UTC, datetime

from rich.console import Console

from edge.agent.source_reader import SourceReader
from edge.app.fitted_sensors import fitted_sensors
from edge.app.opened_sources import open_sources, provided_quantities
from edge.app.run import open_auxiliaries
from edge.app.zenoh_station import ZenohStation
from edge.config import EdgeConfig
from edge.identity import bus_unit, unit_connection
from edge.preflight.auxiliary_survey import AuxiliarySurvey
from edge.preflight.finding import CheckFinding, Severity, worst
from edge.preflight.inertial_survey import InertialSurvey
from edge.preflight.installation import (
    calibration_finding,
    certificate_finding,
    storage_findings,
)
from edge.preflight.output_check import output_findings
from edge.preflight.report import encode_report, print_finding, print_verdict
from edge.preflight.station_check import station_findings
from edge.sources.interface import Source, sensors_in
from edge.storage.data_folder import UnitDataFolder
from shared.clock import SystemClock
from shared.errors import ConfigError

_TAKE_S = 0.1


def print_check(config: EdgeConfig, survey_s: float, *, as_json: bool) -> bool:
    """Check a unit and print the findings as they are made; return False where it is not ready.

    Raises MusterError where ``muster edge run`` with these settings would.
    """
    unit_id = unit_connection(config).unit_id
    console = Console(stderr=as_json)
    console.print(f"Checking unit {unit_id}; lay it down still, and press its button once.")
    findings: list[CheckFinding] = []
    for finding in check_unit(config, survey_s):
        findings.append(finding)
        print_finding(finding, console)
    print_verdict(unit_id, findings, console)
    if as_json:
        print(encode_report(unit_id, findings))
    return worst(findings) is not Severity.FAILED


def check_unit(config: EdgeConfig, survey_s: float) -> Iterator[CheckFinding]:
    """Yield findings as they are made; takes ``survey_s`` for the sensors, and some seconds."""
    if bus_unit(config) is not None:
        raise ConfigError(f"{config.source} has no sensors of its own; check the unit itself")
    member = unit_connection(config)
    now = datetime.now(UTC)
    with closing(UnitDataFolder(config.data / member.unit_id)) as folder:
        yield certificate_finding(member.identity, now)
        yield from storage_findings(folder, config.storage)
        with closing(open_sources(config)) as source:
            for one in fitted_sensors(config, source, member.unit_id, folder.calibrations):
                yield calibration_finding(one.calibration, now, one.name)
            yield from _sensor_findings(config, source, survey_s)
        yield from output_findings(config.outputs)
        yield from station_findings(member.unit_id, ZenohStation(member), SystemClock())


def _sensor_findings(config: EdgeConfig, source: Source, survey_s: float) -> Iterator[CheckFinding]:
    reader = SourceReader(source, SystemClock(), config.speed, open_auxiliaries(config))
    inertial = {name: InertialSurvey(one, name) for name, one in sensors_in(source).items()}
    auxiliary = AuxiliarySurvey(config, provided_quantities(config))
    faults: list[str] = []
    reader.start()
    try:
        end_s = time.monotonic() + survey_s
        while time.monotonic() < end_s and not reader.ended:
            timed = reader.take(_TAKE_S)
            if timed is not None:
                if len(timed.batch.imu):
                    inertial[timed.batch.sensor].push(timed.batch.imu)
                for sample in timed.batch.others:
                    auxiliary.push(sample)
            faults += reader.take_faults()
    finally:
        reader.close()
    for press in reader.last_presses():
        auxiliary.push(press)
    if reader.failure is not None:
        faults.append(reader.failure)
    yield from (CheckFinding("sensors", Severity.FAILED, fault) for fault in faults)
    for survey in inertial.values():
        yield from survey.findings()
    yield from auxiliary.findings()
