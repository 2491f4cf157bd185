"""What people's paths show of a building that nobody has a plan of."""
