"""The console at two real stations, with 40 and with 200 people, which all modules here share."""
