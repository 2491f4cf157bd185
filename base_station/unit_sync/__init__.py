"""Synchronisation with units: messages that the radio lost are fetched from their journals."""
