"""What accuracy costs in time: studies, estimates before a run, and promises kept by both.

`kolk.accuracy` makes a `Study`, `kolk.estimate` an `Estimate`; `promise` chooses a spacing for a
tolerance or a budget. Data flow: `ladder` says which runs, `job` packs one, `worker` carries it
out, `store` keeps its `record`, `quantity` and `curve` set the records of a ladder side by side,
`law`, `expansion`, `richardson` and `verdict` do the statistics.
"""
