"""The console's API: REST under ``/api/v1``, the live WebSocket, and the console's own files."""
