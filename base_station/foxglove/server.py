"""Server of Foxglove's WebSocket protocol: topics of the log as channels, with their schemas."""

from __future__ import annotations

from collections.abc import Iterable
from queue import SimpleQueue

import foxglove
from foxglove.websocket import (
    Capability,
    ChannelView,
    Client,
    PlaybackControlRequest,
    PlaybackState,
    ServerListener,
)

from shared.errors import UserError
from shared.mcap_log import (
    LogRecord,
    descriptor_set,
    is_console,
    is_derived,
    log_topic,
    wire_type_of,
)

EVERY_ALARM = "foxglove/all/log"  # alarms of all units and of the station, for one panel
_ALARM_NAME = log_topic("").rpartition("/")[2]
_BACKLOG_MESSAGES = 16_384  # of one client; beyond it the oldest are dropped


class FoxgloveServer:
    """Server whose channels are made as topics come; a subscriber gets the newest message of its
    topic.

    The library calls from a thread of its own: its requests wait until ``work`` or ``requests`` is
    called.
    """

    def __init__(
        self, host: str, port: int, name: str, time_range_ns: tuple[int, int] | None = None
    ) -> None:
        """``time_range_ns``: range of a replay, which clients can then play, pause and seek.

        Raises UserError if the port cannot be used.
        """
        self._context = foxglove.Context()
        self._channels: dict[str, foxglove.Channel] = {}
        self._newest: dict[str, LogRecord] = {}
        self._listener = _Listener()
        is_replay = time_range_ns is not None
        try:
            self._server = foxglove.start_server(
                name=name,
                host=host,
                port=port,
                capabilities=[Capability.Time, Capability.PlaybackControl] if is_replay else [],
                server_listener=self._listener,
                context=self._context,
                playback_time_range=time_range_ns,
                message_backlog_size=_BACKLOG_MESSAGES,
            )
        except (RuntimeError, OSError) as error:
            raise UserError(
                f"{host}:{port} cannot be used for Foxglove ({error}); give another with --listen"
            ) from error

    @property
    def port(self) -> int:
        return self._server.port

    def advertise(self, topics: Iterable[str]) -> None:
        """Make channels before their first messages, as a client subscribes only to channels that
        it knows.
        """
        for topic in topics:
            if topic not in self._channels and not is_console(topic):
                self._open(topic)

    def publish(self, records: Iterable[LogRecord]) -> None:
        for t_ns, topic, payload in records:
            if is_console(topic):  # as a console is shown it, which Foxglove shows by other topics
                continue
            self._log(t_ns, topic, payload)
            if is_derived(topic) and topic.endswith(f"/{_ALARM_NAME}"):
                self._log(t_ns, EVERY_ALARM, payload)

    def work(self) -> None:
        """Send the newest message of each topic to which a client has just subscribed."""
        topics = set()
        while not self._listener.subscribed.empty():
            topics.add(self._listener.subscribed.get())
        for topic in topics & self._newest.keys():
            self._log(*self._newest[topic])

    def requests(self) -> list[PlaybackControlRequest]:
        """Requests of clients to play, pause or seek, in the order in which they came."""
        asked = []
        while not self._listener.requests.empty():
            asked.append(self._listener.requests.get())
        return asked

    def show_time(self, t_ns: int) -> None:
        self._server.broadcast_time(t_ns)

    def show_state(self, state: PlaybackState) -> None:
        self._server.broadcast_playback_state(state)

    def forget(self) -> None:
        """Forget the newest messages: the next ones are of another time."""
        self._newest.clear()

    def close(self) -> None:
        self._server.stop()

    def _log(self, t_ns: int, topic: str, payload: bytes) -> None:
        channel = self._channels.get(topic) or self._open(topic)
        self._newest[topic] = t_ns, topic, payload
        channel.log(payload, log_time=t_ns)

    def _open(self, topic: str) -> foxglove.Channel:
        wire_type = wire_type_of(topic)
        schema, encoding = None, ""
        if wire_type is not None:
            encoding = "protobuf"
            schema = foxglove.Schema(
                name=wire_type.DESCRIPTOR.full_name,
                encoding=encoding,
                data=descriptor_set(wire_type),
            )
        channel = self._channels[topic] = foxglove.Channel(
            topic, schema=schema, message_encoding=encoding, context=self._context
        )
        return channel


class _Listener(ServerListener):
    def __init__(self) -> None:
        self.subscribed = SimpleQueue[str]()
        self.requests = SimpleQueue[PlaybackControlRequest]()

    def on_subscribe(self, client: Client, channel: ChannelView) -> None:
        del client
        self.subscribed.put(channel.topic)

    def on_playback_control_request(
        self, playback_control_request: PlaybackControlRequest
    ) -> PlaybackState | None:
        self.requests.put(playback_control_request)
        return None
