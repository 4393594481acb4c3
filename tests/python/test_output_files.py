"""Tables, checkpoints, whole-file replacement, and the folder of a run."""

import json
import os
from pathlib import Path

import numpy as np
import pytest

from kolk.errors import RunError
from kolk.output.atomic import replacing, write_json, write_text
from kolk.output.checkpoint import Checkpoint, read_checkpoint, write_checkpoint
from kolk.output.folder import RunFolder, free_folder, newest_folder, safe_name
from kolk.output.image import MemoryFile
from kolk.output.tables import Table, read_table


def test_a_table_reads_back_to_the_same_bits(tmp_path: Path) -> None:
    path = tmp_path / "probes" / "P.csv"
    rows = [(0.0, -0.0), (0.1, 1.0 / 3.0), (1e-300, 5e-324), (np.float64(2.5), 1e22)]
    table = Table(path, ("time", "value"))
    for row in rows:
        table.append(row)
    table.close()
    found = read_table(path)
    assert list(found.columns) == ["time", "value"]
    assert found.to_numpy().tobytes() == np.array(rows, dtype=np.float64).tobytes()


def test_a_torn_last_row_is_dropped(tmp_path: Path) -> None:
    path = tmp_path / "P.csv"
    path.write_text("time,value\n0.0,1.0\n0.5,2.", encoding="utf-8")
    assert read_table(path).to_numpy().tolist() == [[0.0, 1.0]]


def test_a_table_is_cut_back_to_its_checkpoint(tmp_path: Path) -> None:
    path = tmp_path / "P.csv"
    table = Table(path, ("time", "value"))
    table.append((0.0, 1.0))
    length = table.length
    table.append((1.0, 2.0))
    table.close()
    table = Table(path, ("time", "value"), length)
    table.append((1.0, 3.0))
    table.close()
    assert read_table(path).to_numpy().tolist() == [[0.0, 1.0], [1.0, 3.0]]
    with pytest.raises(RunError, match="where the checkpoint knows"):
        Table(path, ("time", "value"), 10_000)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
def test_a_row_on_a_full_disk_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "ftruncate", lambda *_: None)
    with pytest.raises(RunError, match="No space left on device; free some space"):
        Table(Path("/dev/full"), ("time", "value"))


def test_replacing_a_file_is_all_or_nothing(tmp_path: Path) -> None:
    path = tmp_path / "summary.json"
    write_text(path, "old", "write the summary")
    with pytest.raises(ZeroDivisionError), replacing(path) as temporary:
        temporary.write_text("half of the new", encoding="utf-8")
        _ = 1 / 0
    assert path.read_text(encoding="utf-8") == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["summary.json"]
    with pytest.raises(RunError, match=r"cannot write the summary .*missing"):
        write_text(tmp_path / "missing" / "file", "text", "write the summary")


def test_json_holds_no_nan(tmp_path: Path) -> None:
    path = tmp_path / "summary.json"
    write_json(path, {"a": float("nan"), "b": np.float32(0.5), "c": np.arange(2)}, "write")
    found = json.loads(path.read_text(encoding="utf-8"))
    assert found == {"a": None, "b": 0.5, "c": [0, 1]}


STATE = {
    "columns/position x": np.array([[0.1, -0.0], [np.nan, 1e-320]]),
    "id": np.arange(3, dtype=np.uint32),
    "nothing": np.zeros((0, 3)),
    "count": 2**63 + 5,
    "small": -7,
    "time": 1.0 / 3.0,
    "scheme": "symplectic",
    "empty": "",
    "flag": True,
    "blob": b"\x00\x01\x00",
}


def test_a_checkpoint_comes_back_exactly(tmp_path: Path) -> None:
    path = tmp_path / "checkpoint.h5"
    book = {"frames": 3, "probes": {"P2": {"next": 4, "length": 100}}}
    write_checkpoint(path, Checkpoint(STATE, book, "abc"))
    found = read_checkpoint(path)
    assert found.book == book
    assert found.scene == "abc"
    assert list(found.state) == list(STATE)
    for name, value in STATE.items():
        back = found.state[name]
        if isinstance(value, np.ndarray):
            assert back.dtype == value.dtype
            assert back.shape == value.shape
            assert back.tobytes() == value.tobytes()
        else:
            assert type(back) is type(value)
            assert back == value


def test_a_failed_checkpoint_keeps_the_one_before(tmp_path: Path) -> None:
    path = tmp_path / "checkpoint.h5"
    write_checkpoint(path, Checkpoint({"time": 1.0}, {}, "abc"))
    with pytest.raises((RunError, TypeError)):
        write_checkpoint(path, Checkpoint({"time": 2.0, "bad": object()}, {}, "abc"))
    assert read_checkpoint(path).state["time"] == 1.0
    assert [p.name for p in tmp_path.iterdir()] == ["checkpoint.h5"]


def test_a_missing_or_damaged_checkpoint_says_so(tmp_path: Path) -> None:
    path = tmp_path / "checkpoint.h5"
    with pytest.raises(RunError, match="nothing to resume from"):
        read_checkpoint(path)
    path.write_bytes(b"damaged")
    with pytest.raises(RunError, match="cannot be read"):
        read_checkpoint(path)


def test_folders_are_numbered_and_found_again(tmp_path: Path) -> None:
    root = tmp_path / "runs"
    assert newest_folder("tank", root) is None
    for number, name in enumerate(["tank", "tank-2", "tank-3", "tanker"]):
        if name != "tanker":
            assert free_folder("tank", root).path == root / name
        folder = RunFolder(root / name)
        folder.claim(force=False)
        folder.scene.write_text("name = 'tank'", encoding="utf-8")
        os.utime(folder.scene, (number, number))
        folder.unlock()
    newest = newest_folder("tank", root)
    assert newest is not None
    assert newest.path == root / "tank-3"


def test_a_folder_is_not_taken_from_others(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine", encoding="utf-8")
    folder = RunFolder(tmp_path)
    with pytest.raises(RunError, match="holds other files"):
        folder.claim(force=False)
    folder.claim(force=True)
    folder.scene.write_text("a run", encoding="utf-8")
    (folder.path / "body.npz").write_bytes(b"its particles")
    with pytest.raises(RunError, match="another kolk is running"):
        RunFolder(tmp_path).lock()
    folder.unlock()
    with pytest.raises(RunError, match="already holds a run"):
        folder.claim(force=False)
    folder.claim(force=True)
    folder.unlock()
    assert [p.name for p in tmp_path.iterdir()] == ["notes.txt"]


def test_names_of_probes_become_file_names() -> None:
    assert safe_name("P2") == "P2"
    assert safe_name("a/b c") == "a_b_c"
    assert safe_name("..") == "_"


def test_a_file_in_memory_is_a_file(tmp_path: Path) -> None:
    random = np.random.default_rng(3)
    memory, plain = MemoryFile(), bytearray()
    for _ in range(200):
        place, size = int(random.integers(0, 300_000)), int(random.integers(0, 100_000))
        data = random.bytes(size)
        plain.extend(bytes(max(place + size - len(plain), 0)))
        plain[place : place + size] = data
        memory.seek(place)
        assert memory.write(data) == size
        place, size = int(random.integers(0, 400_000)), int(random.integers(0, 100_000))
        memory.seek(place)
        assert memory.read(size) == bytes(plain[place : place + size])
    memory.truncate(len(plain) + 100_000)
    memory.save(tmp_path / "file")
    assert (tmp_path / "file").read_bytes() == bytes(plain) + bytes(100_000)
