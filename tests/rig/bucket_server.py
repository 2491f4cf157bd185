"""A real S3 server (SeaweedFS) in a folder of its own, that can be stopped and started again.

It ends with the test, also where that is killed: it gets SIGTERM when this process ends.
"""

from __future__ import annotations

import json
import secrets
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import obstore
from obstore.exceptions import BaseError
from obstore.store import S3Store

from tests.rig.lossy_link import Namespace
from tests.rig.plain_http import NO_AUTHORITIES
from tests.rig.station_process import free_port
from tests.rig.waiting import until

BUCKET = "muster"
ADDRESS = f"s3://{BUCKET}/station"
_PARTS = ("s3", "master", "volume", "filer")
# They have ports of their own, so that a second server would end.
_WITHOUT_CATALOGS = ("-s3.port.iceberg", "0", "-s3.port.lance", "0")
_ATTEMPTS = 3
_START_S = 60.0  # of a busy machine
_END_WITH_PARENT = """
import ctypes, os, signal, sys
ctypes.CDLL(None).prctl(1, signal.SIGTERM)
os.execv(sys.argv[1], sys.argv[1:])
"""


class BucketServer:
    """``environment`` gives who asks: everything is allowed to ``owner``, reading to ``reader``."""

    def __init__(self, folder: Path, namespace: Namespace | None = None) -> None:
        """``namespace``: the network in which it listens; None: this machine's loopback."""
        self._folder, self._namespace = folder, namespace
        self._host = "127.0.0.1" if namespace is None else namespace.address
        self._ports = {f"{part}{grpc}": free_port() for part in _PARTS for grpc in ("", ".grpc")}
        self._secrets = {name: secrets.token_hex(16) for name in ("owner", "reader")}
        self._running: subprocess.Popen[bytes] | None = None
        rights = {"owner": ["Admin", "Read", "List", "Write"], "reader": ["Read", "List"]}
        who = [
            {
                "name": name,
                "credentials": [{"accessKey": name, "secretKey": secret}],
                "actions": rights[name],
            }
            for name, secret in self._secrets.items()
        ]
        (folder / "s3.json").write_text(json.dumps({"identities": who}))
        (folder / "data").mkdir()

    @property
    def endpoint(self) -> str:
        return f"http://{self._host}:{self._ports['s3']}"

    def environment(self, name: str = "owner") -> dict[str, str]:
        return {
            "AWS_ACCESS_KEY_ID": name,
            "AWS_SECRET_ACCESS_KEY": self._secrets.get(name, "wrong"),
            "AWS_REGION": "us-east-1",
            "AWS_ENDPOINT_URL": self.endpoint,
        }

    def start(self) -> None:
        """Answers when this returns."""
        program = Path(sysconfig.get_path("scripts")) / "weed"
        ports = [f"-{name}.port{grpc}" for name in _PARTS for grpc in ("", ".grpc")]
        flags = [
            word
            for flag, port in zip(ports, self._ports.values(), strict=True)
            for word in (flag, str(port))
        ]
        command = (
            *(() if self._namespace is None else self._namespace.inside()),
            *(sys.executable, "-c", _END_WITH_PARENT, str(program), "server"),
            *("-dir", str(self._folder / "data"), "-ip", self._host, "-ip.bind", self._host),
            *("-filer", "-s3", "-s3.config", str(self._folder / "s3.json"), *flags),
            *_WITHOUT_CATALOGS,
            *(
                "-master.volumeSizeLimitMB",
                "64",
                "-volume.max",
                "40",
                "-volume.preStopSeconds",
                "0",
            ),
        )
        with (self._folder / "output.txt").open("ab") as output:
            self._running = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=output, stderr=output
            )
        answers, has_bucket = self._answers, self._has_bucket
        if self._namespace is None:
            until(lambda: answers() or self._has_ended(), "the S3 server answers", _START_S)
            assert not self._has_ended(), (self._folder / "output.txt").read_text()[-2000:]
            until(has_bucket, "the server takes files")
        else:  # the first file makes the bucket
            until(lambda: self._from_inside(answers), "the S3 server answers")

    def stop(self) -> None:
        if self._running is not None:
            self._running.kill()
            self._running.wait()
            self._running = None

    def _has_ended(self) -> bool:
        return self._running is None or self._running.poll() is not None

    def _from_inside(self, ask: Callable[[], bool]) -> bool:
        assert self._namespace is not None
        return self._namespace.call(ask)

    def _answers(self) -> bool:
        try:
            health = httpx.get(f"{self.endpoint}/healthz", verify=NO_AUTHORITIES)
            return health.status_code == httpx.codes.OK
        except httpx.HTTPError:
            return False

    def _has_bucket(self) -> bool:
        """The server makes a bucket for the first file of whoever may do everything."""
        owner = self.environment()
        bucket = S3Store(
            BUCKET,
            endpoint=self.endpoint,
            access_key_id=owner["AWS_ACCESS_KEY_ID"],
            secret_access_key=owner["AWS_SECRET_ACCESS_KEY"],
            client_options={"allow_http": True},
        )
        try:
            obstore.put(bucket, "ready", b"")
        except BaseError:
            return False
        return True


@contextmanager
def bucket_server() -> Iterator[BucketServer]:
    """One that runs.  A port that was free may be another program's by then: it is tried again."""
    for attempt in range(_ATTEMPTS):
        folder = Path(tempfile.mkdtemp(prefix="muster-s3-"))
        server = BucketServer(folder)
        try:
            server.start()
        except AssertionError:
            _remove(server, folder)
            if attempt == _ATTEMPTS - 1:
                raise
        else:
            break
    try:
        yield server
    finally:
        _remove(server, folder)


def _remove(server: BucketServer, folder: Path) -> None:
    server.stop()
    shutil.rmtree(folder, ignore_errors=True)
