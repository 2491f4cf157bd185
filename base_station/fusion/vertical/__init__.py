"""The height of one unit, and what moves it besides walking: lifts and the weather."""
