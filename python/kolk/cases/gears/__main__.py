"""``python -m kolk.cases.gears`` writes the outlines of the gears anew."""

from kolk.cases.gears import write

write()
