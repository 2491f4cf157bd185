"""The parts of the live station's drive: what it hears, keeps and tells."""
