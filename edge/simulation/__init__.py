"""Simulated responders: bodies whose motion is known exactly, and sensors with realistic errors."""
