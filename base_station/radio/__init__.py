"""Audio of radio channels: recorded beside the log in a process of its own, and given again."""
