"""How good a position is, said by the station itself: live as a light, afterwards as figures."""
