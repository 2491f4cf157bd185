"""Archive in a bucket, by the S3 protocol.

Credentials are read from the environment, as other programs do: AWS_ACCESS_KEY_ID,
AWS_SECRET_ACCESS_KEY, AWS_REGION, and AWS_ENDPOINT_URL for a server other than Amazon's.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from datetime import timedelta
from ipaddress import ip_address
from pathlib import Path
from urllib.parse import urlsplit

import obstore
from obstore.exceptions import (
    BaseError,
    NotFoundError,
    PermissionDeniedError,
    UnauthenticatedError,
)
from obstore.store import S3Store

from base_station.archive.store import (
    CANNOT_LIST,
    cannot_read,
    cannot_remove,
    cannot_write,
    file_short,
)
from shared.coded_text import coded
from shared.errors import ArchiveError, UserError

PATIENCE = timedelta(seconds=30)  # of a request, with all its repetitions
_TRY = timedelta(seconds=10)
_STATUS = re.compile(r"status code: (\d+)")
_CREDENTIALS = "AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY"


class BucketStore:
    def __init__(self, address: str) -> None:
        """Raises UserError if the address names no bucket."""
        parts = urlsplit(address)
        if not parts.hostname or parts.username or parts.query:
            raise UserError(
                coded(
                    "archive-no-bucket",
                    "{archive} is no bucket: give s3://BUCKET/PLACE, and {credentials} in the "
                    "environment",
                    archive=address,
                    credentials=_CREDENTIALS,
                )
            )
        self._address = address.rstrip("/")
        # Else it would ask for credentials at an address that only machines of a cloud have.
        is_named = "AWS_ACCESS_KEY_ID" in os.environ or "AWS_PROFILE" in os.environ
        self._store = S3Store(
            parts.netloc,
            prefix=parts.path.strip("/") or None,
            skip_signature=not is_named and "AWS_WEB_IDENTITY_TOKEN_FILE" not in os.environ,
            client_options={
                "allow_http": _is_on_this_machine(os.environ.get("AWS_ENDPOINT_URL", ""))
                or os.environ.get("AWS_ALLOW_HTTP", "") == "true",
                "timeout": PATIENCE,
                "connect_timeout": _TRY,
            },
            retry_config={"retry_timeout": PATIENCE, "max_retries": 5},
        )

    @property
    def address(self) -> str:
        return self._address

    def put(self, name: str, content: Path) -> None:
        with self._asking(cannot_write(name)):
            obstore.put(self._store, name, content)

    def size(self, name: str) -> int | None:
        with self._asking(cannot_read(name)):
            try:
                return obstore.head(self._store, name)["size"]
            except (NotFoundError, FileNotFoundError):
                return None

    def read_all(self, name: str) -> bytes | None:
        with self._asking(cannot_read(name)):
            try:
                return bytes(obstore.get(self._store, name).bytes())
            except (NotFoundError, FileNotFoundError):
                return None

    def read(self, name: str, begin: int, end: int) -> bytes:
        with self._asking(cannot_read(name)):
            data = bytes(obstore.get_range(self._store, name, start=begin, end=end))
        if len(data) < end - begin:
            raise file_short(self.address, name)
        return data

    def names(self, beginning: str = "") -> Sequence[str]:
        with self._asking(CANNOT_LIST):
            folder = beginning.rpartition("/")[0]
            pages = obstore.list(self._store, folder or None)
            return sorted(
                one["path"] for page in pages for one in page if one["path"].startswith(beginning)
            )

    def remove(self, name: str) -> None:
        with self._asking(cannot_remove(name)):
            obstore.delete(self._store, name)

    @contextmanager
    def _asking(self, what: str) -> Iterator[None]:
        try:
            yield
        except (PermissionDeniedError, UnauthenticatedError) as error:
            raise self._refused(what) from error
        except (NotFoundError, FileNotFoundError) as error:
            raise self._missing(what) from error
        except (BaseError, OSError) as error:
            status = _STATUS.search(str(error))  # lists fail with an error like any other
            if status and status[1] in ("401", "403"):
                raise self._refused(what) from error
            if status and status[1] == "404":
                raise self._missing(what) from error
            raise ArchiveError(
                coded(
                    "archive-bucket-away",
                    "the archive {archive}: {what} now ({error}); nothing is lost: try it again "
                    "when the bucket answers",
                    archive=self.address,
                    what=what,
                    error=_reason(error),
                )
            ) from error

    def _refused(self, what: str) -> ArchiveError:
        return ArchiveError(
            coded(
                "archive-bucket-refuses",
                "the archive {archive}: {what}: the account of {credentials} may not do it; give "
                "it the rights to list, read, write and delete there (s3:ListBucket, "
                "s3:GetObject, s3:PutObject, s3:DeleteObject)",
                archive=self.address,
                what=what,
                credentials=_CREDENTIALS,
            )
        )

    def _missing(self, what: str) -> ArchiveError:
        return ArchiveError(
            coded(
                "archive-bucket-missing",
                "the archive {archive}: {what}: there is no such bucket or file; make the bucket, "
                "or see that the address is right",
                archive=self.address,
                what=what,
            )
        )


def _is_on_this_machine(endpoint: str) -> bool:
    """True if the endpoint is this machine.  To another one names of people are sent only with
    encryption.
    """
    host = urlsplit(endpoint).hostname or ""
    try:
        return host == "localhost" or ip_address(host).is_loopback
    except ValueError:
        return False


def _reason(error: Exception) -> str:
    """Innermost reason of an error, which comes last but for hints to developers."""
    text = str(error).split("\n\nDebug source")[0]
    return text.strip().splitlines()[0][:300]
