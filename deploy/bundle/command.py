"""``muster bundle``: one file that installs Muster on a machine without a network."""

from __future__ import annotations

import platform
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import typer
from rich.progress import Progress

from deploy.bundle import installer
from deploy.bundle.archive import Target, files_below, write_archive
from shared.errors import UserError

CHECKOUT = Path(__file__).resolve().parents[2]
_KEPT = ("examples", "nftables", "prometheus", "sysctl.d", "systemd", "udev")  # of deploy/
_GLIBC_MINORS = range(17, 37)  # of the oldest manylinux that wheels still have to that of Debian 12
_THIS_PYTHON = "{}.{}".format(*sys.version_info)


def bundle(
    out: Annotated[Path, typer.Option(help="Folder for the bundles.")] = Path("dist"),
    machine: Annotated[
        list[str] | None,
        typer.Option(
            help="x86_64 or aarch64, as `uname -m` says; repeatable. Default: this one's."
        ),
    ] = None,
    python: Annotated[str, typer.Option(help="Python's version on those machines.")] = _THIS_PYTHON,
    part: Annotated[
        list[str] | None,
        typer.Option(help="Optional part: foxglove, parquet, pictures or postgresql; repeatable."),
    ] = None,
) -> None:
    """Make a file that installs Muster on a machine without a network; needs a checkout.

    There: `python3 muster-VERSION-MACHINE-pyVERSION.pyz`.
    """
    locks = [_lock("requirements.lock"), *(_lock(f"requirements-{one}.lock") for one in part or ())]
    out.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory(prefix="muster-bundle-") as folder, Progress() as progress:
        own = Path(folder) / "own"
        task = progress.add_task("building Muster", total=None)
        _pip("wheel", "--no-deps", "--no-build-isolation", "-w", str(own), str(CHECKOUT))
        (wheel,) = own.glob("muster-*.whl")
        for one in machine or [platform.machine()]:
            target = Target(wheel.name.split("-")[1], one, python)
            progress.update(task, description=f"fetching wheels for {one}, Python {python}")
            wheels = Path(folder) / one
            for lock in locks:
                _pip("download", *_options_for(target), "-r", str(lock), "-d", str(wheels))
            progress.update(task, description=f"writing {target.file_name}")
            write_archive(out / target.file_name, target, dict(_contents(wheel, wheels, locks)))
            size_mb = (out / target.file_name).stat().st_size / 1e6
            progress.console.print(f"{out / target.file_name} ({size_mb:.0f} MB)")


def _lock(name: str) -> Path:
    """Raises UserError outside of a checkout, and for a part that there is not."""
    path = CHECKOUT / "deploy" / name
    if not (CHECKOUT / "pyproject.toml").is_file():
        raise UserError("a bundle is made in a checkout of Muster: run ./muster bundle there")
    if not path.is_file():
        raise UserError(
            f"there is no optional part with {path.name}; see deploy/requirements-*.lock"
        )
    return path


def _options_for(target: Target) -> Iterator[str]:
    yield from ("--no-deps", "--require-hashes", "--only-binary=:all:")
    yield from ("--implementation", "cp", "--python-version", target.python)
    for minor in _GLIBC_MINORS:
        yield from ("--platform", f"manylinux_2_{minor}_{target.machine}")
    yield from (
        "--platform",
        f"manylinux2014_{target.machine}",
        "--platform",
        f"linux_{target.machine}",
    )


def _contents(wheel: Path, wheels: Path, locks: Sequence[Path]) -> Iterator[tuple[str, Path]]:
    yield f"{installer.WHEELS}/{wheel.name}", wheel
    yield from files_below(wheels, installer.WHEELS)
    for lock in locks:
        yield f"{installer.LOCKS}/{lock.name}", lock
    for name in _KEPT:
        yield from files_below(CHECKOUT / "deploy" / name, f"{installer.DEPLOY}/{name}")


def _pip(*arguments: str) -> None:
    command = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check", *arguments]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode:
        raise UserError(f"pip could not do its part, no bundle was made:\n{done.stderr.strip()}")
