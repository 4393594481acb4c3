"""`python -m kolk.cli` is the command `kolk`."""

from kolk.cli.gate import main

main()
