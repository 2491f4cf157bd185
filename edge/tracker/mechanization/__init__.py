"""Strapdown mechanization: attitude, velocity and position from samples, for every tracker."""
