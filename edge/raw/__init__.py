"""Raw sensor batches as messages: written, sent by a unit that does not track, and heard."""
