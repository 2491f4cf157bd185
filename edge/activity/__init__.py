"""Activity of the wearer, from the foot: strides, rest, lying, falls, height."""
