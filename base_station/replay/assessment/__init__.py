"""Assessment of positions by the station itself: live as a light, afterwards as figures."""
