"""Checks of what is installed on a unit: certificate, calibration, data folder and disk."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from datetime import datetime, timedelta
from pathlib import Path

from edge.calibration.file import identity
from edge.calibration.model import Calibration
from edge.config import StorageConfig
from edge.preflight.finding import CheckFinding, Severity, subject, subject_of
from edge.storage.data_folder import UnitDataFolder
from shared.coded_text import coded
from shared.tls import TlsIdentity, parse_certificate, validity_problem

_CERTIFICATE_WARNING = timedelta(days=30)  # as the station warns
_DISK_MIN_BYTES = 100_000_000  # half an hour of raw samples and hours of a journal


def certificate_finding(certificate: TlsIdentity | None, now: datetime) -> CheckFinding:
    """``now``: aware, by this machine's clock."""
    about = subject("certificate", "certificate")
    if certificate is None:
        return CheckFinding(
            about,
            Severity.WARNING,
            coded("check-no-certificate", "none: the link is not secured"),
            "anyone on this network can listen and forge; give --enrolment",
        )
    problem = validity_problem(certificate, now)
    if problem is not None:
        return CheckFinding(about, Severity.FAILED, problem, "no link is made with it")
    ends = parse_certificate(certificate.certificate, "certificate").not_valid_after_utc
    text = coded("check-certificate-ends", "valid to {day}", day=f"{ends:%Y-%m-%d}")
    if ends - now < _CERTIFICATE_WARNING:
        return CheckFinding(
            about, Severity.WARNING, text, "renew it at the station: `muster pki renew`"
        )
    return CheckFinding(about, Severity.OK, text)


def calibration_finding(
    calibration: Calibration | None, now: datetime, sensor: str = ""
) -> CheckFinding:
    """``sensor``: name of the sensor that it is for; empty: the unit's only one."""
    about = subject_of("calibration", "calibration", sensor)
    if calibration is None:
        return CheckFinding(
            about,
            Severity.WARNING,
            coded("check-no-calibration", "none"),
            "positions drift more, and the more so the colder it is: `muster edge calibrate`",
        )
    text = coded(
        "check-calibration-of",
        "{identity} of {day}",
        identity=identity(calibration),
        day=f"{calibration.made:%Y-%m-%d}",
    )
    if calibration.is_old(now):
        return CheckFinding(about, Severity.WARNING, text, "it is old: make a new one")
    if faults := list(calibration.faults()):
        return CheckFinding(
            about, Severity.WARNING, f"{text}: {'; '.join(faults)}", "make a new one"
        )
    return CheckFinding(about, Severity.OK, text)


def storage_findings(folder: UnitDataFolder, limits: StorageConfig) -> Iterator[CheckFinding]:
    """Yield findings on the disk below the data folder, and on what was set aside in it."""
    free_bytes = shutil.disk_usage(folder.path).free
    wanted_bytes = 1e6 * (limits.journal_mb + limits.black_box_mb) - _size_bytes(folder.path)
    disk, free_gb = subject("disk", "disk"), round(free_bytes / 1e9, 1)
    text = coded("check-disk-free", "{free_gb:.1f} GB free", free_gb=free_gb)
    if free_bytes < _DISK_MIN_BYTES:
        yield CheckFinding(
            disk, Severity.FAILED, text, "messages are kept nowhere while the link is away"
        )
    elif free_bytes < wanted_bytes:
        yield CheckFinding(
            disk,
            Severity.WARNING,
            coded(
                "check-disk-short",
                "{free_gb:.1f} GB free of the {wanted_gb:.1f} GB that journal and black box may "
                "take",
                free_gb=free_gb,
                wanted_gb=round(wanted_bytes / 1e9, 1),
            ),
            "make room, or lower storage.black_box_mb",
        )
    else:
        yield CheckFinding(disk, Severity.OK, text)
    if folder.quarantine is not None:
        yield CheckFinding(
            subject("data_folder", "data folder"),
            Severity.WARNING,
            coded(
                "check-foreign-journal",
                "it held another unit's journal, which is now in {folder}",
                folder=folder.quarantine.name,
            ),
            "copy no data folder from unit to unit",
        )


def _size_bytes(folder: Path) -> int:
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
