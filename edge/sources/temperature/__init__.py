"""Temperature sensors of the Linux kernel: of the air around the equipment, and inside the unit."""
