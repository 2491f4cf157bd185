"""A unit's own path: how its errors grow, and what is kept of it."""
