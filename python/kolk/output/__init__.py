"""What a run leaves behind: its folder, and the files in it, each written whole or not at all.

| module | file |
|---|---|
| `recorder` | all of them: the observer that a run hands its states to |
| `folder` | the run's folder: names, claiming a free one, clearing, the lock |
| `vtkhdf` | `fields.vtkhdf`, the time series for ParaView and PyVista |
| `tables` | `probes/*.csv` and `history.csv`, appended by whole lines |
| `checkpoint` | `checkpoint.h5`, the newest whole state |
| `summary` | `summary.json` |
| `journal` | `log.txt` |
| `atomic` | how a file is replaced as a whole |
| `image` | HDF5 files made in memory, so that a full disk is an error and no crash |
"""
