"""The agent's data on disk: journal of messages, black box of raw samples, and what serves them."""
