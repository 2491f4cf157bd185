"""Installer inside a bundle: ``python3 muster-VERSION-MACHINE-pyVERSION.pyz [--target FOLDER]``.

It runs before anything is installed, from the archive itself: it has only Python's own library, and
needs neither a network nor a compiler.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import platform
import shutil
import subprocess
import sys
import venv
import zipfile
from pathlib import Path
from tempfile import TemporaryDirectory

DESCRIPTION = "bundle.json"
CHECKSUMS = "SHA256SUMS"
WHEELS = "wheels"
DEPLOY = "deploy"
LOCKS = "locks"


class InstallError(Exception):
    """The text says what is wrong and what to do."""


def main(archive: Path, arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(
        description="Install Muster from this file, without a network."
    )
    parser.add_argument(
        "--target", type=Path, default=Path("/opt/muster"), help="folder to install to"
    )
    parser.add_argument("--verify", action="store_true", help="check the file, install nothing")
    options = parser.parse_args(arguments)
    try:
        with zipfile.ZipFile(archive) as bundle:
            version = verify(bundle)
            if options.verify:
                print(f"{archive.name}: complete and unchanged, Muster {version}")
                return
            require_fitting_machine(json.loads(bundle.read(DESCRIPTION)))
            install(bundle, options.target)
    except (InstallError, OSError) as error:
        sys.exit(f"muster: {error}")
    print(f"Muster {version} is in {options.target}: {options.target}/bin/muster --help")
    print(f"Services, examples and rules: {options.target}/share/muster/{DEPLOY}")


def verify(bundle: zipfile.ZipFile) -> str:
    """The version; raises InstallError where a file is missing, another, or one too many."""
    expected = {}
    for line in bundle.read(CHECKSUMS).decode().splitlines():
        digest, _, name = line.partition("  ")
        expected[name] = digest
    names = {name for name in bundle.namelist() if name not in {CHECKSUMS, "__main__.py"}}
    if names != set(expected):
        wrong = ", ".join(sorted(names ^ set(expected)))
        raise InstallError(
            f"the bundle does not have the files that it lists ({wrong}); copy it again"
        )
    for name, digest in expected.items():
        if hashlib.sha256(content(bundle, name)).hexdigest() != digest:
            raise InstallError(f"{name} in the bundle was changed; copy it again")
    version: str = json.loads(bundle.read(DESCRIPTION))["version"]
    return version


def content(bundle: zipfile.ZipFile, name: str) -> bytes:
    """Raises InstallError where the file is damaged."""
    try:
        return bundle.read(name)
    except zipfile.BadZipFile as error:
        raise InstallError(f"{name} in the bundle is damaged; copy it again") from error


def require_fitting_machine(description: dict[str, str]) -> None:
    """Raises InstallError where the wheels are for another machine or another Python."""
    machine, python = platform.machine(), "{}.{}".format(*sys.version_info)
    if machine != description["machine"] or python != description["python"]:
        raise InstallError(
            f"this bundle is for {description['machine']} and Python {description['python']}; here "
            f"are {machine} and Python {python}. Make another one: ./muster bundle --machine "
            f"{machine} --python {python}"
        )


def install(bundle: zipfile.ZipFile, target: Path) -> None:
    """Into an environment in ``target``; an installed version is replaced."""
    with TemporaryDirectory(prefix="muster-bundle-") as folder:
        bundle.extractall(folder)  # verified before
        unpacked = Path(folder)
        make_environment(target)
        pip = [str(target / "bin" / "python"), "-m", "pip", "--isolated", "install", "--quiet"]
        pip += ["--disable-pip-version-check", "--no-index"]
        pip += ["--find-links", str(unpacked / WHEELS)]
        for lock in sorted((unpacked / LOCKS).iterdir()):
            run([*pip, "--require-hashes", "-r", str(lock)])
        (wheel,) = (unpacked / WHEELS).glob("muster-*.whl")
        run([*pip, "--no-deps", "--force-reinstall", str(wheel)])
        kept = target / "share" / "muster" / DEPLOY
        shutil.rmtree(kept, ignore_errors=True)
        shutil.copytree(unpacked / DEPLOY, kept)


def make_environment(target: Path) -> None:
    try:
        venv.create(target, with_pip=True)
    except subprocess.CalledProcessError as error:  # Debian has ensurepip in a package of its own
        raise InstallError(
            "this Python cannot make an environment; install python3-venv (Debian: apt-get install "
            "python3-venv) and start again"
        ) from error


def run(command: list[str]) -> None:
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode:
        raise InstallError(f"pip has failed, Muster is not installed:\n{done.stderr.strip()}")
