"""Run-time parts of the agent: from sensor batches to messages in the journal and on the link."""
