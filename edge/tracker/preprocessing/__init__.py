"""Samples of every tracker before it uses them: checks, times, saturation, the last seconds."""
