"""Pure core: events step the pipeline, which changes the state and gives outputs."""
