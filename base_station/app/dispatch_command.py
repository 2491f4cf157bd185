"""``muster base dispatch``: hands a file of the dispatch centre to a running station."""

from __future__ import annotations

import os
import ssl
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    import httpx

TOKEN_VARIABLE = "MUSTER_TOKEN"  # noqa: S105  # its name, not a secret
_TIMEOUT_S = 30.0


def dispatch(
    file: Annotated[Path, typer.Argument(help="EIDO, plain JSON or CAP; - is the standard input.")],
    station: Annotated[
        str, typer.Option(help="The station's address, such as https://muster.local:8443.")
    ] = "http://127.0.0.1:8080",
    token_file: Annotated[
        Path | None, typer.Option(help=f"File with the API token; else ${TOKEN_VARIABLE}.")
    ] = None,
    ca: Annotated[
        Path | None, typer.Option(help="PEM of the authority of the station's certificate.")
    ] = None,
) -> None:
    """Offer an incident of the dispatch centre on the station's console, or show an alert.

    The token needs the role commander, and no other scope than dispatch.
    """
    from shared.errors import UserError  # noqa: PLC0415

    content = _read(file)
    is_alert = content.lstrip()[:1] == b"<"
    answer = _post(station, content, is_alert=is_alert, token=_token(token_file), ca=ca)
    if not answer.is_success:
        raise UserError(f"{file} was not taken: {_reason(answer)}")
    for line in _lines(answer.json()):
        typer.echo(line)


def _read(file: Path) -> bytes:
    from shared.errors import UserError  # noqa: PLC0415

    try:
        return sys.stdin.buffer.read() if str(file) == "-" else file.read_bytes()
    except OSError as error:
        raise UserError(f"{file} cannot be read: {error.strerror}") from error


def _token(token_file: Path | None) -> str:
    from shared.errors import UserError  # noqa: PLC0415

    text = os.environ.get(TOKEN_VARIABLE, "") if token_file is None else _read(token_file).decode()
    if not text.strip():
        raise UserError(
            f"there is no token: make one in the console (Account), and give --token-file or "
            f"${TOKEN_VARIABLE}"
        )
    return text.strip()


def _post(
    station: str, content: bytes, *, is_alert: bool, token: str, ca: Path | None
) -> httpx.Response:
    import httpx  # noqa: PLC0415

    from shared.errors import UserError  # noqa: PLC0415
    from shared.host_names import is_loopback  # noqa: PLC0415

    try:
        url = httpx.URL(station)
        if url.scheme not in {"http", "https"} or not url.host:
            raise UserError(f"{station!r} is no address: write https://HOST:PORT")
        if url.scheme == "http" and not is_loopback(url.host):
            raise UserError(f"{station} is not encrypted, and would show the token: use https://")
        context = ssl.create_default_context(cafile=None if ca is None else str(ca))
        return httpx.post(
            url.join("/api/v1/dispatch/alerts" if is_alert else "/api/v1/dispatch"),
            content=content,
            headers={
                "Authorization": f"Bearer {token}",
                "Content-Type": "application/cap+xml" if is_alert else "application/json",
            },
            timeout=_TIMEOUT_S,
            verify=context,
        )
    except (httpx.HTTPError, httpx.InvalidURL, OSError) as error:
        raise UserError(f"the station at {station} cannot be reached: {error}") from error


def _reason(answer: httpx.Response) -> str:
    """Sentence of the problem document."""
    try:
        return str(answer.json()["detail"])
    except (ValueError, KeyError, TypeError):
        return f"the station answered {answer.status_code}"


def _lines(answer: dict[str, Any]) -> list[str]:
    if "alert_id" in answer:
        lines = [f"alert {answer['alert_id']}: {answer['outcome']}, {answer['markers']} markers"]
    else:
        lines = [f"dispatch {answer['number']}: {answer['outcome']}"]
        unknown = [one["call_sign"] for one in answer["units"] if not _is_known(one)]
        if unknown:
            lines.append(f"not known at this station: {', '.join(unknown)}")
    return lines + [f"warning: {one}" for one in answer["warnings"]]


def _is_known(call_sign: dict[str, Any]) -> bool:
    return bool(call_sign["crew"] or call_sign["unit_ids"])
