"""Hard cases: where SPH codes blow up, leak, clump or lose energy, and what kolk shows on each.

One file a case in `cases/`. All run with the defaults that a user gets. `pytest` runs every case's
short version, `pytest -m stability` the full ones, and `python -m tests.stability --full` (from
the repository's root) runs the full ones and writes `docs/stability.md`.
"""
