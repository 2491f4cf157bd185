"""The one file, or QR code, that is carried to a unit so that its station knows it.

As a file it is TOML; as a QR code it is ``MUSTER1:`` and base32 of the same in compressed
MessagePack, because a QR code packs capitals and digits best and a scanner that types like a
keyboard gets them right.  ``read_enrolment`` takes either, and a picture of the code.
"""

from __future__ import annotations

import base64
import binascii
import tomllib
import zlib
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

import msgspec
from cryptography import x509
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric import ec

from shared.errors import ConfigError
from shared.out_file import write_secret
from shared.tls import DAMAGED, TlsIdentity, check_identity

_COMPACT_PREFIX = "MUSTER1:"
_CURVE = ec.SECP256R1()
_MOST_BYTES = 65_536  # of a file or an unpacked code; an enrolment has about 2,000
_MOST_PICTURE_BYTES = 32_000_000
_PICTURES = (b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff", b"RIFF")  # PNG, JPEG, WebP
_HEIC = b"ftyp"  # behind the length of its first box: named, though it cannot be decoded


class Holder(Enum):
    """Kind of participant that a certificate is for."""

    UNIT = "unit"
    TRACKER = "tracking agent"  # of the unit of its name
    OPERATOR = "operator"
    STATION = "station"
    DEPARTMENT_STATION = "department station"  # reports to its department


@dataclass(frozen=True, slots=True)
class Enrolment:
    """Name of a participant, its station, and the proof of both."""

    holder: Holder
    name: str
    connect: tuple[str, ...]  # tls/HOST:PORT of the station
    identity: TlsIdentity

    def to_toml(self) -> str:
        connect = ", ".join(f'"{endpoint}"' for endpoint in self.connect)
        return (
            f"# Enrolment of {self.holder.value} {self.name}. It holds a private key: carry it "
            "there,\n# keep no other copy, send it over nothing that others read.\n"
            f'holder = "{self.holder.value}"\n'
            f'name = "{self.name}"\n'
            f"connect = [{connect}]\n"
            f"authority = '''\n{self.identity.authority.decode()}'''\n"
            f"certificate = '''\n{self.identity.certificate.decode()}'''\n"
            f"private_key = '''\n{self.identity.private_key.decode()}'''\n"
        )

    def to_compact(self) -> str:
        """Capitals, digits and a colon; about 1,200 characters."""
        key = serialization.load_pem_private_key(self.identity.private_key, password=None)
        if not isinstance(key, ec.EllipticCurvePrivateKey):
            raise ConfigError("only a key on the curve P-256 fits a QR code; carry the file")
        packed = msgspec.msgpack.encode(
            _Compact(
                self.holder,
                self.name,
                self.connect,
                _der(self.identity.authority),
                _der(self.identity.certificate),
                key.private_numbers().private_value.to_bytes(32, "big"),
            )
        )
        text = base64.b32encode(zlib.compress(packed, 9)).decode().rstrip("=")
        return _COMPACT_PREFIX + text

    def write(self, path: Path) -> None:
        """Write the file, readable by its owner alone.

        Raises ConfigError where one is already, or it cannot be written: then there is none.
        """
        write_secret(path, self.to_toml().encode(), self.renewal_command)

    @property
    def renewal_command(self) -> str:
        """The command, for a person."""
        of_kind = {
            Holder.TRACKER: "--tracker ",
            Holder.OPERATOR: "--operator ",
            Holder.DEPARTMENT_STATION: "--department-station ",
        }
        return f"`muster pki renew {of_kind.get(self.holder, '')}{self.name}`"


class _Compact(msgspec.Struct, array_like=True):
    holder: Holder
    name: str
    connect: tuple[str, ...]
    authority: bytes
    certificate: bytes
    private_value: bytes


class _Table(msgspec.Struct, forbid_unknown_fields=True):
    holder: Holder
    name: str
    connect: tuple[str, ...]
    authority: str
    certificate: str
    private_key: str


def read_enrolment(path: Path) -> Enrolment:
    """Raises ConfigError, one sentence that names the file and what to do."""
    try:
        with path.open("rb") as file:
            content = file.read(_MOST_BYTES)
            if _is_picture(content):
                content += file.read(_MOST_PICTURE_BYTES)
    except FileNotFoundError:
        raise ConfigError(f"{path}: there is no such enrolment file") from None
    except OSError as error:
        raise ConfigError(f"{path}: the enrolment cannot be read: {error}") from error
    try:
        return parse_enrolment(_text(content))
    except ConfigError as error:
        raise ConfigError(f"{path}: {error}") from error


def _is_picture(beginning: bytes) -> bool:
    """True if a file that begins like this is a picture, whatever its name; text never is."""
    return beginning.startswith(_PICTURES) or beginning[4:8] == _HEIC


def _text(content: bytes) -> str:
    if _is_picture(content):
        if len(content) > _MOST_PICTURE_BYTES:
            raise ConfigError(
                f"the picture is larger than {_MOST_PICTURE_BYTES // 1_000_000} MB; make it smaller"
            )
        # Few enrolments are pictures, and the library that decodes them is slow to load.
        from shared.enrolment_picture import text_in_picture  # noqa: PLC0415

        return text_in_picture(content, _COMPACT_PREFIX)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise ConfigError("this is no enrolment, nor text at all") from None


def parse_enrolment(text: str) -> Enrolment:
    """From a file's text or what a QR code says.  Raises ConfigError, one sentence."""
    stripped = text.strip()
    if stripped.upper().startswith(_COMPACT_PREFIX):
        enrolment = _from_compact(stripped.upper().removeprefix(_COMPACT_PREFIX))
    else:
        enrolment = _from_toml(text)
    if not enrolment.connect:
        raise ConfigError("the enrolment names no station to connect to; enrol again")
    check_identity(enrolment.identity)
    return enrolment


def _from_toml(text: str) -> Enrolment:
    try:
        table = msgspec.convert(tomllib.loads(text), _Table)
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(
            f"this is no enrolment, or only a part of one ({error}); copy the whole file again"
        ) from error
    except msgspec.ValidationError as error:
        raise ConfigError(
            f"this is no enrolment, or not all of one ({error}); copy the whole file again"
        ) from error
    identity = TlsIdentity(
        table.authority.encode(), table.certificate.encode(), table.private_key.encode()
    )
    return Enrolment(table.holder, table.name, table.connect, identity)


def _from_compact(text: str) -> Enrolment:
    try:
        squeezed = base64.b32decode(text + "=" * (-len(text) % 8))
        unpacker = zlib.decompressobj()
        packed = unpacker.decompress(squeezed, _MOST_BYTES)
        if not unpacker.eof:
            raise ConfigError("the scanned enrolment is cut short; scan the code again")
        compact = msgspec.msgpack.decode(packed, type=_Compact)
        key = ec.derive_private_key(int.from_bytes(compact.private_value, "big"), _CURVE)
        identity = TlsIdentity(
            _pem(compact.authority), _pem(compact.certificate), private_key_pem(key)
        )
    except (binascii.Error, zlib.error, msgspec.DecodeError, *DAMAGED) as error:
        raise ConfigError(
            "the scanned enrolment is damaged or cut short; scan the code again"
        ) from error
    return Enrolment(compact.holder, compact.name, compact.connect, identity)


def private_key_pem(key: ec.EllipticCurvePrivateKey) -> bytes:
    """PKCS #8, not encrypted: a unit starts without a person who could type a passphrase."""
    return key.private_bytes(
        serialization.Encoding.PEM,
        serialization.PrivateFormat.PKCS8,
        serialization.NoEncryption(),
    )


def _der(pem: bytes) -> bytes:
    return x509.load_pem_x509_certificate(pem).public_bytes(serialization.Encoding.DER)


def _pem(der: bytes) -> bytes:
    return x509.load_der_x509_certificate(der).public_bytes(serialization.Encoding.PEM)
