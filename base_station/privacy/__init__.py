"""Forgets people and incidents wherever the station keeps them."""
