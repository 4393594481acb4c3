"""One file a case; each has a `case`."""
