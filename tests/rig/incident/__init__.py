"""Simulated incidents, six people in a building each; for ``fusion`` and ``floors``."""
