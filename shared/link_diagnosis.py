"""Diagnosis of a link that fails: Zenoh's client only reports a timeout, so each step is tried."""

from __future__ import annotations

import re
import socket
import ssl
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from tempfile import TemporaryDirectory

from shared.tls import TlsIdentity, validity_problem

_ENDPOINT = re.compile(r"\w+/(\[[^\]]+\]|[^:]+):(\d+)")
_PATIENCE_S = 3.0
_REFUSAL_PATIENCE_S = 1.0

# OpenSSL's verification codes.
_NOT_YET_VALID, _EXPIRED = 9, 10
_WRONG_NAME, _WRONG_ADDRESS = 62, 64

_ALERTS = {
    "CERTIFICATE_EXPIRED": "the station says this unit's certificate has expired; renew it there",
    "UNKNOWN_CA": "the station does not know who enrolled this unit; enrol at this station",
    "DECRYPT_ERROR": "the station does not trust this unit's certificate; enrol at this station",
    "CERTIFICATE_REQUIRED": "the station wants a certificate and got none; give an enrolment",
}


def link_failure_reason(connect: Sequence[str], identity: TlsIdentity | None, now: datetime) -> str:
    """One sentence for each endpoint; takes some seconds.  ``now`` is aware, by this clock."""
    if identity is not None and (problem := validity_problem(identity, now)) is not None:
        return problem
    return "; ".join(_try(endpoint, identity) for endpoint in connect)


def _try(endpoint: str, identity: TlsIdentity | None) -> str:
    parts = _ENDPOINT.fullmatch(endpoint)
    if parts is None:
        return f"{endpoint} is no place to connect to; write tls/HOST:PORT"
    host, port = parts[1].strip("[]"), int(parts[2])
    where = f"{host} port {port}"
    try:
        with socket.create_connection((host, port), _PATIENCE_S) as connection:
            if identity is not None:
                return _try_tls(connection, host, where, identity)
    except OSError as error:
        return _unreachable(error, host, port)
    return f"{where} takes plain connections but makes no link; a secure station wants an enrolment"


def _unreachable(error: OSError, host: str, port: int) -> str:
    match error:
        case socket.gaierror():
            return f"the name {host} is not known; is the name server there, is the name right?"
        case ConnectionRefusedError():
            return f"{host} is there but nothing listens on port {port}; does the station run?"
        case TimeoutError():
            return f"{host} does not answer; out of range, switched off, or another network?"
        case _:
            return f"{host} port {port} cannot be reached: {error.strerror or error}"


def _try_tls(connection: socket.socket, host: str, where: str, identity: TlsIdentity) -> str:
    try:
        with _context(identity).wrap_socket(connection, server_hostname=host) as secured:
            # A station that refuses says so after the handshake, one that does not waits.
            secured.settimeout(_REFUSAL_PATIENCE_S)
            return _after_handshake(secured, where)
    except ssl.SSLCertVerificationError as error:
        return _station_distrusted(error, host, where)
    except ssl.SSLError as error:
        for alert, sentence in _ALERTS.items():
            if alert in (error.reason or ""):
                return f"{where}: {sentence}"
        return f"{where} does not speak TLS as a station does ({error.reason}); is it the bus?"
    except (ConnectionError, TimeoutError):
        return f"{where} ends the connection at once; is it the bus, and is it secure?"


def _after_handshake(secured: ssl.SSLSocket, where: str) -> str:
    try:
        greeting = secured.recv(1)
    except TimeoutError:
        greeting = b"none"
    if greeting:
        return f"{where} accepts this unit's certificate; the link should come by itself"
    return (
        f"{where} knows who issued this unit's certificate and ends the connection all the same: "
        "it was revoked, is not on the station's list yet, or is shut out for a while; the "
        "station's health page may say which"
    )


def _station_distrusted(error: ssl.SSLCertVerificationError, host: str, where: str) -> str:
    if error.verify_code in (_WRONG_NAME, _WRONG_ADDRESS):
        return (
            f"the station's certificate does not stand for {host}; make one that does with "
            f"`muster pki renew-station --host {host}`"
        )
    if error.verify_code == _EXPIRED:
        return "the station's certificate has expired; renew it with `muster pki renew-station`"
    if error.verify_code == _NOT_YET_VALID:
        return "the station's certificate is not valid yet by the clock here; set the clock"
    return (
        f"the station at {where} is not the one that enrolled this unit "
        f"({error.verify_message}); enrol at this station, or mend the address"
    )


def _context(identity: TlsIdentity) -> ssl.SSLContext:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.load_verify_locations(cadata=identity.authority.decode("ascii"))
    # OpenSSL takes a certificate and key from a file only; the folder is its owner's alone.
    with TemporaryDirectory() as folder:
        file = Path(folder, "identity.pem")
        file.write_bytes(identity.private_key + identity.certificate)
        context.load_cert_chain(file)
    return context
