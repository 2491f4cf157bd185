"""``muster bench bus`` and ``muster bench fusion``: this station measured on this machine."""
