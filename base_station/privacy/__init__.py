"""Erasure of people and incidents in log, database, checkpoints, recordings and imports."""
