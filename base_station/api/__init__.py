"""The console's API (REST under ``/api/v1``, the live WebSocket), its files, and its server."""
