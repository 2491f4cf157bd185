"""Composition roots and one-shot commands: the only place that chooses what an agent is made of."""
