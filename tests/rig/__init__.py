"""What benchmarks, and tests, drive a real station with: processes, units, consoles, bad links."""
