"""Erasure of persons and incidents from the state and from log records."""
