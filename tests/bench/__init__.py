"""``muster bench ...``: this station measured on this machine; a file or folder a command."""
