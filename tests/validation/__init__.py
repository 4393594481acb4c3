"""Physics against references: one folder a case, with its set-up, reference, bounds and picture.

`pytest` runs every case's short version, `pytest -m validation` the full ones, and
`python -m tests.validation` (from the repository's root) runs the full ones, draws their pictures
and writes `docs/validation.md`.
"""
