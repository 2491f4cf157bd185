"""What the wearer is doing, told from the foot: strides, rest, lying, falls, height."""
