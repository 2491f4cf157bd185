"""Commands to the units: their life, and saying them until they are answered."""
