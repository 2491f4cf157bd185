"""Tools of benchmarks and tests for a real station: processes, units, consoles, bad links."""
