"""What it takes to run Muster somewhere: the build, the demo, units, configurations."""
