"""An authority in memory, for the connection between acceptor and router on this machine.

The acceptor ends each TLS connection, so the router sees a second one.  Its access rules name
common names: the acceptor shows it a certificate with the very name that it has verified.  Nothing
of this authority is ever written to a disk, and it ends with the process.
"""

from __future__ import annotations

import os
import ssl
from datetime import UTC, datetime, timedelta

from cryptography import x509
from cryptography.hazmat.primitives import hashes
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.serialization import Encoding
from cryptography.x509.oid import NameOID

from shared.enrolment import private_key_pem
from shared.tls import TlsIdentity

# Whatever this machine's clock is set to: the acceptor heeds when the real certificates end.
_BEGINS, _ENDS = datetime(1970, 1, 1, tzinfo=UTC), datetime(9999, 1, 1, tzinfo=UTC)
_ROUTER = "router"


class InternalAuthority:
    """Authority that signs for the router and for participants that the acceptor admits; for one
    thread at a time.
    """

    def __init__(self) -> None:
        self._key = ec.generate_private_key(ec.SECP256R1())
        self._holder_key = ec.generate_private_key(ec.SECP256R1())
        self._name = _name("muster internal authority")
        self._certificate = self._signed(self._name, self._key, is_authority=True)
        self.router = self._identity(_ROUTER)
        self._contexts: dict[str, ssl.SSLContext] = {}

    def client_context(self, common_name: str) -> ssl.SSLContext:
        """A client of the router that holds ``common_name``; made once for each."""
        context = self._contexts.get(common_name)
        if context is None:
            context = self._contexts[common_name] = self._new_client_context(common_name)
        return context

    def forget(self, common_name: str) -> None:
        self._contexts.pop(common_name, None)

    def _new_client_context(self, common_name: str) -> ssl.SSLContext:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        context.check_hostname = False  # the port is this process's own, at any address
        identity = self._identity(common_name)
        context.load_verify_locations(cadata=identity.authority.decode("ascii"))
        load_identity(context, identity)
        return context

    def _identity(self, common_name: str) -> TlsIdentity:
        key = self._holder_key
        certificate = self._signed(_name(common_name), key, is_authority=False)
        return TlsIdentity(_pem(self._certificate), _pem(certificate), private_key_pem(key))

    def _signed(
        self, subject: x509.Name, key: ec.EllipticCurvePrivateKey, *, is_authority: bool
    ) -> x509.Certificate:
        builder = (
            x509.CertificateBuilder()
            .subject_name(subject)
            .issuer_name(self._name)
            .public_key(key.public_key())
            .serial_number(x509.random_serial_number())
            .not_valid_before(_BEGINS)
            .not_valid_after(_ENDS - timedelta(days=0 if is_authority else 1))
            .add_extension(x509.BasicConstraints(ca=is_authority, path_length=None), critical=True)
        )
        if not is_authority:
            names = x509.SubjectAlternativeName([x509.DNSName(_ROUTER)])
            builder = builder.add_extension(names, critical=False)
        return builder.sign(self._key, hashes.SHA256())


def load_identity(context: ssl.SSLContext, identity: TlsIdentity) -> None:
    """Gives ``context`` its certificate and key.  OpenSSL takes them from a file only: one in
    memory that has no name.
    """
    file = os.memfd_create("identity")
    try:
        os.write(file, identity.private_key + identity.certificate)
        context.load_cert_chain(f"/proc/self/fd/{file}")
    finally:
        os.close(file)


def _name(common_name: str) -> x509.Name:
    return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, common_name)])


def _pem(certificate: x509.Certificate) -> bytes:
    return certificate.public_bytes(Encoding.PEM)
