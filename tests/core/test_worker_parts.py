"""What a worker and its parent tell each other, and who runs it; no process is started."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest

from hybrid_quad import Cancelled, InputError, InternalError
from hybrid_quad.core import python_programs
from hybrid_quad.worker import interpreter, messages
from hybrid_quad.worker.bundle import load_bundle, save_bundle
from hybrid_quad.worker.death import cause_of


@pytest.mark.parametrize(
    "error",
    [
        InputError("non_manifold_edge", 'two "lines"\nof text, with µ', "edge", (1, 2, 3_000_000_000)),
        InputError("no_area", "nothing there"),
        Cancelled("the memory limit is reached", "memory_limit"),
        InternalError("a promise was broken", "singular_patches"),
        ValueError("quads must be a number"),
        ImportError("not built for this Python"),
        MemoryError(),
    ],
)
def test_errors_survive_the_way(error):
    line = messages.encode(messages.error_message(error))
    assert line.count(b"\n") == 1 and line.endswith(b"\n")
    found = messages.error_of(messages.decode(line))
    assert type(found) is type(error) and str(found) == str(error)
    for name in ("code", "element_kind", "elements", "stage"):
        assert getattr(found, name, None) == getattr(error, name, None)


def test_any_other_error_is_a_bug_and_brings_its_traceback():
    try:
        {}["missing"]
    except KeyError as error:
        message = messages.error_message(error)
    found = messages.error_of(message)
    assert type(found) is InternalError and "KeyError" in str(found)
    assert '{}["missing"]' in str(found.__cause__)


@pytest.mark.parametrize("line", [b"", b"Blender 4.2.0\n", b"[1]\n", b"{}\n", b'{"event"\n', b"\xff\xfe\n"])
def test_what_is_no_message_is_none(line):
    assert messages.decode(line) is None


def test_bundles_hold_numbers_and_no_objects(tmp_path):
    path = tmp_path / "bundle.npz"
    arrays = {"a": np.arange(6, dtype=np.int32).reshape(2, 3), "empty": np.zeros((0, 3)), "f": np.array([np.nan, -0.0])}
    save_bundle(path, arrays, {"n": np.int64(3), "x": 0.1, "inf": float("inf"), "none": None})
    found, values = load_bundle(path)
    assert {name: (a.dtype, a.shape, a.tobytes()) for name, a in found.items()} == {
        name: (a.dtype, a.shape, a.tobytes()) for name, a in arrays.items()
    }
    assert values == {"n": 3, "x": 0.1, "inf": float("inf"), "none": None}
    with pytest.raises(TypeError):
        save_bundle(path, {"objects": np.array([object()])}, {})
    with pytest.raises(TypeError):
        save_bundle(path, {}, {"object": object()})


class _Trap:
    def __reduce__(self):
        return (Path.touch, (Path("sprung"),))


def test_a_pickle_in_a_bundle_is_not_opened(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    np.savez("trap.npz", values=np.array([_Trap()], object))
    with pytest.raises(ValueError, match="allow_pickle"):
        load_bundle(Path("trap.npz"))
    Path("trap.npz").write_bytes(pickle.dumps(_Trap()))
    with pytest.raises((ValueError, OSError)):
        load_bundle(Path("trap.npz"))
    assert not Path("sprung").exists()


@pytest.mark.parametrize(
    ("status", "platform", "words"),
    [
        (-9, "linux", "killed"),
        (-11, "darwin", "segmentation fault"),
        (3, "linux", "exit status 3"),
        (-1073741819, "win32", "access violation"),
        (0xC0000005, "win32", "access violation"),
        (1, "win32", "0x1"),
    ],
)
def test_the_cause_of_an_end_in_words(status, platform, words):
    assert words in cause_of(status, platform)


def test_a_python_that_is_there_is_preferred_to_the_host(tmp_path):
    host, python = tmp_path / "blender", tmp_path / "python3"
    host.touch()
    assert interpreter.worker_command(str(host), [python])[0] == str(host)
    python.touch()
    assert interpreter.worker_command(str(host), [host, python])[:2] == [str(python), "-I"]
    python.unlink()
    with pytest.raises(FileNotFoundError):
        interpreter.worker_command("", [python])


@pytest.mark.parametrize("platform", ["linux", "darwin", "win32"])
def test_programs_of_a_bundled_python(monkeypatch, platform):
    monkeypatch.setattr(python_programs.sys, "platform", platform)
    monkeypatch.setattr(python_programs.sys, "prefix", "/opt/blender/4.2/python")
    monkeypatch.setattr(python_programs.sys, "executable", "/opt/blender/blender")
    programs = [path.as_posix() for path in python_programs.python_programs()]
    assert programs[0].startswith("/opt/blender/4.2/python/bin/python")
    assert "/opt/blender/blender" not in programs
