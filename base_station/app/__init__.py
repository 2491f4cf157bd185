"""The composition roots: only here are concrete parts chosen."""
