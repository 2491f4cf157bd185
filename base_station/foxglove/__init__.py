"""Foxglove: a WebSocket server that shows the log there, live or as a replay."""
