"""TAK: people as Cursor-on-Target events to a TAK server or a multicast group."""
