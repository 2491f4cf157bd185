"""A bundle installs its whole content without a network, and nothing that was changed."""

from __future__ import annotations

import base64
import hashlib
import platform
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from deploy.bundle.archive import Target, files_below, write_archive

THIS_PYTHON = "{}.{}".format(*sys.version_info)
HERE = Target("9.8.7", platform.machine(), THIS_PYTHON)


def write_wheel(folder: Path, name: str, version: str, code: str) -> Path:
    """A wheel of one module."""
    info = f"{name}-{version}.dist-info"
    metadata = f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n"
    files = {
        f"{name}.py": code,
        f"{info}/METADATA": metadata,
        f"{info}/WHEEL": "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
    }
    record = ""
    path = folder / f"{name}-{version}-py3-none-any.whl"
    with zipfile.ZipFile(path, "w") as wheel:
        for member, content in files.items():
            digest = base64.urlsafe_b64encode(hashlib.sha256(content.encode()).digest())
            record += f"{member},sha256={digest.rstrip(b'=').decode()},{len(content)}\n"
            wheel.writestr(member, content)
        wheel.writestr(f"{info}/RECORD", f"{record}{info}/RECORD,,\n")
    return path


@pytest.fixture
def bundle(tmp_path: Path) -> Path:
    """Bundle of a Muster of one module, which needs another one."""
    made = tmp_path / "made"
    made.mkdir()
    needed = write_wheel(made, "needed", "1.0", "ANSWER = 42\n")
    own = write_wheel(made, "muster", "9.8.7", "from needed import ANSWER\n")
    lock = made / "requirements.lock"
    digest = hashlib.sha256(needed.read_bytes()).hexdigest()
    lock.write_text(f"needed==1.0 --hash=sha256:{digest}\n")
    service = made / "muster-station.service"
    service.write_text("[Service]\n")
    out = tmp_path / HERE.file_name
    files = {f"wheels/{path.name}": path for path in (needed, own)}
    files |= {f"locks/{lock.name}": lock, f"deploy/systemd/{service.name}": service}
    write_archive(out, HERE, files)
    return out


def run(bundle: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-I", str(bundle), *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.mark.slow
def test_bundle_installs_itself_and_its_dependencies(bundle: Path, tmp_path: Path) -> None:
    target = tmp_path / "installed"
    for _ in range(2):  # the second time it replaces the first
        done = run(bundle, "--target", str(target))
        assert done.returncode == 0, done.stderr
        assert "Muster 9.8.7" in done.stdout
    program = [str(target / "bin" / "python"), "-c", "import muster; print(muster.ANSWER)"]
    assert subprocess.check_output(program, text=True) == "42\n"
    assert (target / "share/muster/deploy/systemd/muster-station.service").is_file()


@pytest.mark.slow
def test_bundle_has_its_checksum_beside_it_and_verifies_itself(bundle: Path) -> None:
    subprocess.run(["sha256sum", "-c", f"{bundle.name}.sha256"], cwd=bundle.parent, check=True)
    done = run(bundle, "--verify")
    assert (done.returncode, done.stderr) == (0, "")
    assert "complete and unchanged, Muster 9.8.7" in done.stdout


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("another", "was changed"),
        ("flipped", "is damaged"),
        ("missing", "does not have the files that it lists"),
        ("added", "does not have the files that it lists"),
    ],
)
def test_changed_bundle_installs_nothing(
    bundle: Path, tmp_path: Path, change: str, words: str
) -> None:
    changed = tmp_path / "changed.pyz"
    wheel = "wheels/needed-1.0-py3-none-any.whl"
    with zipfile.ZipFile(bundle) as before, zipfile.ZipFile(changed, "w") as after:
        for name in before.namelist():
            if name != wheel or change == "flipped" or change == "added":
                after.writestr(name, before.read(name))
            elif change == "another":
                after.writestr(name, b"another wheel")
        if change == "added":
            after.writestr("wheels/stranger-1.0-py3-none-any.whl", b"")
    if change == "flipped":
        data = bytearray(changed.read_bytes())
        data[data.index(b"ANSWER = 42")] ^= 1
        changed.write_bytes(data)
    done = run(changed, "--target", str(tmp_path / "installed"))
    assert done.returncode == 1
    assert words in done.stderr
    assert not (tmp_path / "installed").exists()


@pytest.mark.slow
@pytest.mark.parametrize(
    "target", [Target("9.8.7", "riscv64", THIS_PYTHON), Target("9.8.7", HERE.machine, "3.99")]
)
def test_bundle_for_another_machine_names_the_one_to_make(tmp_path: Path, target: Target) -> None:
    out = tmp_path / target.file_name
    write_archive(out, target, {})
    done = run(out, "--target", str(tmp_path / "installed"))
    assert done.returncode == 1
    assert f"./muster bundle --machine {HERE.machine} --python {THIS_PYTHON}" in done.stderr


def test_same_content_gives_the_same_archive(tmp_path: Path) -> None:
    content = tmp_path / "content"
    (content / "below").mkdir(parents=True)
    (content / "below" / "file").write_text("text")
    for name in ("a", "b"):
        write_archive(tmp_path / name, HERE, dict(files_below(content, "deploy")))
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()
    with zipfile.ZipFile(tmp_path / "a") as archive:
        assert "deploy/below/file" in archive.namelist()
