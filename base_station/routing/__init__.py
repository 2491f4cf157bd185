"""Ways to a member who is down: over trails, and through the doors of a plan.  Pure."""
