"""Bundle: Muster with all that it needs, as one file for machines without a network."""
