"""Byte streams of hardware: TCP connections, serial ports and pipes, read line by line."""
