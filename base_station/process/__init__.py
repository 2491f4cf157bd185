"""The station as a long-running process: its interpreter, its threads and their failures."""
