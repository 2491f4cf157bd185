"""Re-run of an incident: raw recordings through another tracker, and fusion again."""
