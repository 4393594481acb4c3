"""The study of kolk's own choices, and trials of what `--tolerance` and `--budget` promise.

`python -m tests.accuracy` (from the repository's root) runs the study and writes `docs/accuracy`;
`python -m tests.accuracy.promises` runs the trials. Finished runs are kept under `studies/runs`.
"""
