"""Past incidents: replayed, solved afterwards, projected again."""
