"""What is known of a unit from what it says: its runs, its messages, its way, its heat."""
