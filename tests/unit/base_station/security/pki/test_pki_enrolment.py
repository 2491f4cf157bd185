"""The enrolment: encoded and read back as file and QR code, and one sentence for each bad input."""

from __future__ import annotations

import dataclasses
import errno
import re
import stat
from pathlib import Path

import pytest

from base_station.security.pki.folder import PkiFolder
from base_station.security.pki.qr import as_text, qr_code, save_png
from shared.enrolment import Enrolment, Holder, parse_enrolment, read_enrolment
from shared.errors import ConfigError
from shared.tls import TlsIdentity


@pytest.fixture
def pki(tmp_path: Path) -> PkiFolder:
    folder = PkiFolder(tmp_path)
    folder.create("Freiwillige Feuerwehr Übungsdorf", ["192.0.2.7"], ["tls/192.0.2.7:7447"])
    return folder


@pytest.fixture
def enrolment(pki: PkiFolder) -> Enrolment:
    return pki.enroll("FF-01")


@pytest.mark.parametrize(
    ("holder", "again"),
    [
        (Holder.UNIT, "`muster pki renew FF-01`"),
        (Holder.TRACKER, "`muster pki renew --tracker FF-01`"),
        (Holder.OPERATOR, "`muster pki renew --operator FF-01`"),
    ],
)
def test_full_disk_error_tells_how_to_repeat(
    pki: PkiFolder, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, holder: Holder, again: str
) -> None:
    def full(descriptor: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    enrolment = pki.enroll("FF-01", holder)
    monkeypatch.setattr("shared.out_file.os.fsync", full)
    with pytest.raises(ConfigError, match=f"make it again: {again}"):
        enrolment.write(tmp_path / "FF-01.toml")
    assert not (tmp_path / "FF-01.toml").exists()


def test_file_is_read_back_and_readable_by_its_owner_alone(
    enrolment: Enrolment, tmp_path: Path
) -> None:
    path = tmp_path / "FF-01.toml"
    enrolment.write(path)
    assert read_enrolment(path) == enrolment
    assert stat.S_IMODE(path.stat().st_mode) == 0o600


def test_file_does_not_overwrite_another(enrolment: Enrolment, tmp_path: Path) -> None:
    path = tmp_path / "FF-01.toml"
    path.write_text("precious")
    with pytest.raises(ConfigError, match="is there already"):
        enrolment.write(path)
    assert path.read_text() == "precious"


def test_code_is_read_back_in_any_typing_of_the_scanner(enrolment: Enrolment) -> None:
    text = enrolment.to_compact()
    for typed in (text, f" {text}\r\n", text.lower()):
        assert parse_enrolment(typed) == enrolment


def test_qr_code_uses_its_densest_mode(enrolment: Enrolment, tmp_path: Path) -> None:
    code = qr_code(enrolment)
    assert code.mode == "alphanumeric"
    lines = as_text(code).splitlines()
    assert len(lines) < 60  # a terminal shows it without scrolling
    path = tmp_path / "code.png"
    save_png(code, path, "renew")
    assert path.read_bytes().startswith(b"\x89PNG")
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    with pytest.raises(ConfigError, match="is there already"):
        save_png(code, path, "renew")


def test_private_key_is_not_shown(enrolment: Enrolment) -> None:
    assert enrolment.identity.private_key.decode() not in repr(enrolment)
    assert "PRIVATE KEY" not in repr(enrolment)


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9, 0.99])
def test_truncated_file_is_reported(enrolment: Enrolment, tmp_path: Path, share: float) -> None:
    path = tmp_path / "FF-01.toml"
    text = enrolment.to_toml()
    path.write_text(text[: int(len(text) * share)])
    reported = refusal(path)
    assert reported.startswith(f"{path}: ")
    assert "copy the whole file again" in reported


@pytest.mark.parametrize("length", [0, 1, 40, 600, 1000])
def test_truncated_code_is_reported(enrolment: Enrolment, length: int) -> None:
    text = enrolment.to_compact()
    with pytest.raises(ConfigError, match="scan the code again"):
        parse_enrolment(text[: len("MUSTER1:") + length])


def test_code_misread_anywhere_is_reported(enrolment: Enrolment) -> None:
    text = enrolment.to_compact()
    for at in range(len("MUSTER1:"), len(text), 37):
        wrong = "A" if text[at] != "A" else "B"
        with pytest.raises(ConfigError, match="scan the code again"):
            parse_enrolment(text[:at] + wrong + text[at + 1 :])


@pytest.mark.slow
def test_file_with_any_character_changed_is_itself_or_refused(enrolment: Enrolment) -> None:
    text = enrolment.to_toml()
    refused_count = 0
    for at in range(len(text)):
        wrong = "A" if text[at] != "A" else "B"
        try:
            parse_enrolment(text[:at] + wrong + text[at + 1 :])
        except ConfigError as error:
            one_sentence(str(error))
            refused_count += 1
    assert refused_count > len(text) / 2


def test_file_from_another_system_is_read_back(enrolment: Enrolment, tmp_path: Path) -> None:
    path = tmp_path / "FF-01.toml"
    path.write_bytes(b"\xef\xbb\xbf" + enrolment.to_toml().replace("\n", "\r\n").encode())
    assert read_enrolment(path) == enrolment


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (b"\xff\xfe\x00garbage", "no enrolment, nor text"),
        (b"hello", "copy the whole file again"),
        (b"unit = 'FF-01'\n", "copy the whole file again"),
        (b"MUSTER1:", "scan the code again"),
        (b"MUSTER1:0189", "scan the code again"),
    ],
)
def test_garbage_is_reported(tmp_path: Path, content: bytes, expected: str) -> None:
    path = tmp_path / "garbage"
    path.write_bytes(content)
    assert expected in refusal(path)


def test_missing_file_and_folder_are_reported(tmp_path: Path) -> None:
    assert "no such enrolment file" in refusal(tmp_path / "none")
    assert "cannot be read" in refusal(tmp_path)


def test_parts_of_two_enrolments_are_reported(pki: PkiFolder, enrolment: Enrolment) -> None:
    other = pki.enroll("FF-02").identity
    mixed = dataclasses.replace(enrolment.identity, private_key=other.private_key)
    assert "key belongs to another certificate" in refused(enrolment, mixed)


def test_authority_that_did_not_issue_it_is_reported(enrolment: Enrolment, tmp_path: Path) -> None:
    elsewhere = PkiFolder(tmp_path / "elsewhere")
    elsewhere.create("Other", [], ["tls/127.0.0.1:7447"])
    foreign = elsewhere.enroll("FF-01").identity
    mixed = dataclasses.replace(enrolment.identity, authority=foreign.authority)
    assert "was not issued by the authority beside it" in refused(enrolment, mixed)


@pytest.mark.parametrize("part", ["authority", "certificate", "private_key"])
def test_damaged_part_is_named(enrolment: Enrolment, part: str) -> None:
    lines = getattr(enrolment.identity, part).splitlines(keepends=True)
    damaged = b"".join([lines[0], b"AAAA" + lines[1][4:], *lines[2:]])
    reported = refused(enrolment, dataclasses.replace(enrolment.identity, **{part: damaged}))
    assert part.replace("_", " ").split()[0] in reported
    assert "enrol again" in reported


def test_missing_station_address_is_reported(enrolment: Enrolment) -> None:
    nowhere = dataclasses.replace(enrolment, connect=())
    for text in (nowhere.to_toml(), nowhere.to_compact()):
        with pytest.raises(ConfigError, match="names no station"):
            parse_enrolment(text)


def refused(enrolment: Enrolment, identity: TlsIdentity) -> str:
    text = dataclasses.replace(enrolment, identity=identity).to_toml()
    with pytest.raises(ConfigError) as caught:
        parse_enrolment(text)
    return one_sentence(str(caught.value))


def refusal(path: Path) -> str:
    with pytest.raises(ConfigError) as caught:
        read_enrolment(path)
    return one_sentence(str(caught.value))


def one_sentence(text: str) -> str:
    assert "\n" not in text
    assert re.search(r"Traceback|object at 0x", text) is None
    return text
