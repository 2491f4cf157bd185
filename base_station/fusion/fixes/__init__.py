"""Satellite fixes before they are fused: which can be true, which are believed, what all share."""
