"""Identity of a program on a bus with mutual TLS, and the checks of its files.

Everything is PEM in memory: an enrolment is one file, and a private key is never written a
second time.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import datetime

from cryptography import x509
from cryptography.exceptions import InvalidSignature, UnsupportedAlgorithm
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.x509.oid import NameOID

from shared.coded_text import Measure, coded
from shared.errors import ConfigError

# What cryptography raises for certificates and keys that are not whole.
DAMAGED = (ValueError, TypeError, UnsupportedAlgorithm, x509.InvalidVersion)
_RENEWAL = coded(
    "certificate-renew-at-station",
    "renew it at the station with {command}",
    command="`muster pki renew`",
)


@dataclass(frozen=True, slots=True)
class TlsIdentity:
    """A certificate, its key, and the authority whose certificates it trusts."""

    authority: bytes
    certificate: bytes
    private_key: bytes = field(repr=False)

    def common_name(self) -> str:
        """Subject of the certificate.  Raises ConfigError when it cannot be read."""
        return common_name(parse_certificate(self.certificate, "certificate"))


def check_identity(identity: TlsIdentity) -> None:
    """Raises ConfigError, one sentence, when the three parts do not belong together."""
    authority = parse_certificate(identity.authority, "authority's certificate")
    certificate = parse_certificate(identity.certificate, "certificate")
    try:
        key = serialization.load_pem_private_key(identity.private_key, password=None)
    except DAMAGED as error:
        raise ConfigError("the private key is damaged; enrol again") from error
    if key.public_key() != certificate.public_key():
        raise ConfigError("the private key belongs to another certificate; enrol again")
    try:
        certificate.verify_directly_issued_by(authority)
    except (*DAMAGED, InvalidSignature) as error:
        raise ConfigError(
            f"the certificate of {common_name(certificate)} was not issued by the authority "
            f"beside it ({common_name(authority)}); enrol again"
        ) from error


def validity_problem(identity: TlsIdentity, now: datetime, renewal: str = _RENEWAL) -> str | None:
    """A sentence when the certificate is not valid at ``now`` (aware); None when it is."""
    certificate = parse_certificate(identity.certificate, "certificate")
    if now < certificate.not_valid_before_utc:
        return coded(
            "certificate-not-yet-valid",
            "the certificate of {name} is not valid before {from_utc_s} and the clock here says "
            "{now_utc_s}: set the clock",
            name=common_name(certificate),
            from_utc_s=_minute(certificate.not_valid_before_utc),
            now_utc_s=_minute(now),
        )
    if now > certificate.not_valid_after_utc:
        return coded(
            "certificate-expired-on",
            "the certificate of {name} expired on {until_utc_s} and the clock here says "
            "{now_utc_s}: {renewal}",
            name=common_name(certificate),
            until_utc_s=_minute(certificate.not_valid_after_utc),
            now_utc_s=_minute(now),
            renewal=renewal,
        )
    return None


def _minute(at: datetime) -> Measure:
    return Measure(at.timestamp(), f"{at:%Y-%m-%d %H:%M} UTC")


def fingerprint(pem: bytes) -> str:
    """SHA-256 of the certificate, in hexadecimal, as other programs show it without colons."""
    return parse_certificate(pem, "certificate").fingerprint(hashes.SHA256()).hex()


def parse_certificate(pem: bytes, what: str) -> x509.Certificate:
    """Raises ConfigError that names ``what`` when the bytes are no certificate."""
    try:
        certificate = x509.load_pem_x509_certificate(pem)
        # These are only read when asked for, and may then turn out to be damaged.
        certificate.public_key()
        common_name(certificate)
        _ = certificate.not_valid_before_utc, certificate.not_valid_after_utc
    except DAMAGED as error:
        raise ConfigError(f"the {what} is damaged; enrol again") from error
    return certificate


def common_name(certificate: x509.Certificate) -> str:
    names = certificate.subject.get_attributes_for_oid(NameOID.COMMON_NAME)
    return str(names[0].value) if names else "an unnamed holder"
