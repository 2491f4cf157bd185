"""The station as a program that runs for days: its interpreter, its threads, its troubles."""
