"""Deployment: the build, the demo, units, configurations."""
