"""What the radio lost, fetched from the units' journals."""
