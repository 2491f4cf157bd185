"""Forwarders: live connections with other systems."""
