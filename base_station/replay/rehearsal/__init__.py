"""Rehearsal: other thresholds of alarm rules over recorded incidents."""
