"""Commands to the units: their states, and their repetition until they are answered."""
