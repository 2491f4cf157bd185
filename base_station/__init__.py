"""The base station: records, fuses, raises alarms, serves the console, replays."""
