"""Makes keys and certificates: EC P-256, which Zenoh, browsers and a QR code all take."""

from __future__ import annotations

import ipaddress
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from shared.coded_text import coded
from shared.enrolment import Holder, private_key_pem
from shared.errors import ConfigError
from shared.tls import DAMAGED, parse_certificate

# A unit's clock may be behind the station's when it is enrolled.
_BACKDATED = timedelta(days=1)


@dataclass(frozen=True, slots=True)
class Issued:
    certificate: x509.Certificate
    key: ec.EllipticCurvePrivateKey

    def certificate_pem(self) -> bytes:
        return self.certificate.public_bytes(serialization.Encoding.PEM)

    def key_pem(self) -> bytes:
        return private_key_pem(self.key)


def make_authority(organisation: str, now: datetime, valid: timedelta) -> Issued:
    """A self-signed authority that may sign certificates and nothing else."""
    key = ec.generate_private_key(ec.SECP256R1())
    name = _name(f"{organisation} Muster authority")
    certificate = (
        _builder(name, name, key, now, valid)
        .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
        .add_extension(_key_usage(signs_certificates=True), critical=True)
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(key.public_key()), critical=False)
        .sign(key, hashes.SHA256())
    )
    return Issued(certificate, key)


def issue(
    authority: Issued,
    common_name: str,
    holder: Holder,
    now: datetime,
    valid: timedelta,
    hosts: Sequence[str] = (),
) -> Issued:
    """A certificate signed by ``authority``; only a station's stands for ``hosts``."""
    if now < authority.certificate.not_valid_before_utc:
        raise ConfigError(
            coded(
                "clock-before-authority",
                "this machine's clock is at {today}, and the authority begins on {begin}: set the "
                "clock first",
                today=f"{now:%Y-%m-%d}",
                begin=f"{authority.certificate.not_valid_before_utc:%Y-%m-%d}",
            )
        )
    if now + valid > authority.certificate.not_valid_after_utc:
        raise ConfigError(
            coded(
                "certificate-outlives-authority",
                "the certificate would outlive its authority, which ends on {end}; ask for fewer "
                "days, or make a new authority and enrol everyone again",
                end=f"{authority.certificate.not_valid_after_utc:%Y-%m-%d}",
            )
        )
    key = ec.generate_private_key(ec.SECP256R1())
    uses = [ExtendedKeyUsageOID.CLIENT_AUTH]
    if holder is Holder.STATION:
        uses.append(ExtendedKeyUsageOID.SERVER_AUTH)
    builder = (
        _builder(_name(common_name), authority.certificate.subject, key, now, valid)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(_key_usage(signs_certificates=False), critical=True)
        .add_extension(x509.ExtendedKeyUsage(uses), critical=False)
        .add_extension(
            x509.AuthorityKeyIdentifier.from_issuer_public_key(authority.key.public_key()),
            critical=False,
        )
    )
    if hosts:
        names = x509.SubjectAlternativeName([_general_name(host) for host in hosts])
        builder = builder.add_extension(names, critical=False)
    return Issued(builder.sign(authority.key, hashes.SHA256()), key)


def read_issued(certificate_pem: bytes, key_pem: bytes) -> Issued:
    """Raises ConfigError when either is damaged or they do not belong together."""
    certificate = parse_certificate(certificate_pem, "authority's certificate")
    try:
        key = serialization.load_pem_private_key(key_pem, password=None)
    except DAMAGED as error:
        raise ConfigError(
            coded(
                "authority-key-damaged",
                "the authority's key is damaged; restore it from its backup",
            )
        ) from error
    if (
        not isinstance(key, ec.EllipticCurvePrivateKey)
        or key.public_key() != certificate.public_key()
    ):
        raise ConfigError(
            coded(
                "authority-key-of-another",
                "the authority's key does not belong to its certificate",
            )
        )
    return Issued(certificate, key)


def is_valid_for_host(certificate_pem: bytes, host: str) -> bool:
    """True where this certificate proves the station that is reached as ``host``."""
    certificate = parse_certificate(certificate_pem, "station's certificate")
    try:
        names = certificate.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except x509.ExtensionNotFound:
        return False
    wanted = _general_name(host.encode("idna").decode().lower())
    if isinstance(wanted, x509.IPAddress):
        return wanted in names
    return wanted.value in [one.lower() for one in names.get_values_for_type(x509.DNSName)]


def _builder(
    subject: x509.Name,
    issuer: x509.Name,
    key: ec.EllipticCurvePrivateKey,
    now: datetime,
    valid: timedelta,
) -> x509.CertificateBuilder:
    return (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(issuer)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - _BACKDATED)
        .not_valid_after(now + valid)
    )


def _name(common_name: str) -> x509.Name:
    try:
        return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, common_name)])
    except ValueError as error:
        raise ConfigError(
            coded(
                "certificate-name-unfit",
                "'{name}' does not fit a certificate: take 1 to 64 characters",
                name=common_name,
            )
        ) from error


def _general_name(host: str) -> x509.GeneralName:
    try:
        return x509.IPAddress(ipaddress.ip_address(host))
    except ValueError:
        return x509.DNSName(host)


def _key_usage(*, signs_certificates: bool) -> x509.KeyUsage:
    return x509.KeyUsage(
        digital_signature=not signs_certificates,
        key_cert_sign=signs_certificates,
        crl_sign=signs_certificates,
        content_commitment=False,
        key_encipherment=False,
        data_encipherment=False,
        key_agreement=False,
        encipher_only=False,
        decipher_only=False,
    )
