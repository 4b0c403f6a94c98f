"""The command as scripts see it: exit status, files and messages."""

import errno
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.cli import exit_codes, remesh_command
from hybrid_quad.cli.main import main
from hybrid_quad.core.file_places import MeshFileError
from hybrid_quad.core.held_signals import signals_held
from hybrid_quad.core.mesh_arrays import as_polygons
from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.part_files import write_polygons
from hybrid_quad.core.validation import violations
from support import surfaces
from support.children import from_a_shell, heed_interrupts
from support.mirroring import assert_mirrored


def write_obj(path, vertices, faces):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in np.asarray(vertices, float).tolist()]
    lines += ["f " + " ".join(str(int(v) + 1) for v in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")
    return str(path)


@pytest.fixture
def torus(tmp_path):
    return write_obj(tmp_path / "torus.obj", *surfaces.torus())


@pytest.fixture
def moebius(tmp_path):
    return write_obj(tmp_path / "moebius.obj", *surfaces.moebius())


@pytest.mark.parametrize("suffix", [".obj", ".ply", ".off"])
def test_remesh_writes_what_the_python_call_gives(tmp_path, torus, suffix):
    out = tmp_path / f"out{suffix}"
    assert main(["remesh", torus, str(out), "--quads", "300", "--quiet"]) == exit_codes.OK
    vertices, polygons = read_mesh(out)
    expected = hybrid_quad.remesh(*surfaces.torus(), quads=300)
    assert np.array_equal(vertices, expected.vertices)
    assert np.array_equal(polygons.vertices.reshape(-1, 4), expected.quads)
    assert violations(vertices, polygons.vertices.reshape(-1, 4)) == []


def test_the_report(tmp_path, torus):
    report = tmp_path / "report.json"
    arguments = ["remesh", torus, str(tmp_path / "out.obj"), "--quads", "300", "--no-sharp", "--seed", "4"]
    assert main([*arguments, "--report", str(report)]) == exit_codes.OK
    made = json.loads(report.read_text())
    assert made["status"] == "ok"
    assert made["options"]["sharp_angle"] is None
    assert (made["options"]["quads"], made["seed"]) == (300, 4)


def test_features_from_a_file(tmp_path):
    vertices, faces = surfaces.grid(20, 20, 2.0, 2.0)
    mesh = write_obj(tmp_path / "grid.obj", vertices, faces)
    pairs = [(21 * row + 8, 21 * (row + 1) + 8) for row in range(20)]
    (tmp_path / "features.txt").write_text("".join(f"{a} {b}\n" for a, b in pairs))
    out = tmp_path / "out.off"
    arguments = ["remesh", mesh, str(out), "--quads", "300", "--no-sharp", "--features", str(tmp_path / "features.txt")]
    assert main(arguments) == exit_codes.OK
    expected = hybrid_quad.remesh(vertices, faces, quads=300, sharp_angle=None, sharp_edges=pairs)
    assert np.array_equal(read_mesh(out)[0], expected.vertices)


def test_progress_goes_to_the_error_stream_and_quiet_silences_it(tmp_path, torus, capfd):
    out = str(tmp_path / "out.obj")
    main(["remesh", torus, out, "--quads", "200"])
    talkative = capfd.readouterr()
    assert talkative.out == ""
    assert "quads" in talkative.err
    main(["remesh", torus, out, "--quads", "200", "--quiet"])
    assert capfd.readouterr() == ("", "")


def run_alone(*words, **more):
    """The command in a process of its own; its messages are dropped unless `more` says where they go."""
    command = [sys.executable, "-m", "hybrid_quad", *map(str, words)]
    return subprocess.run(command, check=False, **{"stderr": subprocess.DEVNULL, **more})


def closed_pipe():
    """A file to write to that nobody reads."""
    read, write = os.pipe()
    os.close(read)
    return os.fdopen(write, "wb", buffering=0)


@pytest.mark.skipif(os.name != "posix", reason="streams of POSIX")
@pytest.mark.parametrize("unbuffered", ["", "1"], ids=["buffered", "unbuffered"])
@pytest.mark.parametrize("stream", ["full", "closed", "unread"])
def test_messages_that_nobody_takes_end_no_run(tmp_path, torus, moebius, monkeypatch, stream, unbuffered):
    monkeypatch.setenv("PYTHONUNBUFFERED", unbuffered)
    with closed_pipe() if stream == "unread" else Path("/dev/full").open("wb") as errors:
        more = {"preexec_fn": lambda: os.close(2)} if stream == "closed" else {"stderr": errors}
        out = tmp_path / "out.obj"
        assert run_alone("remesh", torus, out, "--quads", "100", **more).returncode == exit_codes.OK
        assert set(read_mesh(out)[1].sizes.tolist()) == {4}
        assert run_alone("remesh", moebius, out, **more).returncode == exit_codes.CANNOT_REMESH
        assert run_alone("remesh", **more).returncode == exit_codes.WRONG_USAGE


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
@pytest.mark.parametrize("unbuffered", ["", "1"], ids=["buffered", "unbuffered"])
def test_findings_that_nobody_takes_are_a_file_that_cannot_be_written(tmp_path, torus, monkeypatch, unbuffered):
    monkeypatch.setenv("PYTHONUNBUFFERED", unbuffered)
    report = tmp_path / "defects.json"
    with Path("/dev/full").open("wb") as full:
        done = run_alone("check", torus, "--report", report, stdout=full, stderr=subprocess.PIPE)
    assert (done.returncode, done.stderr) == (
        exit_codes.WRONG_USAGE,
        b"hybrid-quad: standard output: No space left on device\n",
    )
    assert json.loads(report.read_text()) == {"defects": []}


@pytest.mark.skipif(sys.platform != "linux", reason="names of any bytes")
@pytest.mark.parametrize(
    ("encoding", "name", "shown"),
    [("utf-8:strict", b"bad\xff.obj", rb"bad\udcff.obj"), ("ascii", "\u00fc.obj".encode(), rb"\xfc.obj")],
)
def test_a_name_that_the_output_has_no_letters_for_is_written_with_numbers(
    tmp_path, torus, monkeypatch, encoding, name, shown
):
    monkeypatch.setenv("PYTHONIOENCODING", encoding)
    place = os.path.join(os.fsencode(tmp_path), name)
    os.rename(torus, place)
    done = run_alone("check", os.fsdecode(place), stdout=subprocess.PIPE)
    assert done.returncode == exit_codes.OK
    assert done.stdout.splitlines()[0].endswith(shown + b": 800 vertices, 1600 faces"), done.stdout


def test_lines_of_a_mesh_that_are_none_are_no_defect_of_it(tmp_path, torus):
    mesh = Path(torus)
    mesh.write_text(mesh.read_text() + "l 1 2 # an edge\nl 1 \\\n2\nl 1 2.5\n")
    assert main(["check", torus]) == exit_codes.OK


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names")
@pytest.mark.timeout(60)
@pytest.mark.parametrize(
    "words", [["remesh", "out.obj"], ["check"], ["case", "-o", "case.zip"]], ids=lambda words: words[0]
)
def test_a_mesh_from_a_pipe_is_refused_at_once(tmp_path, monkeypatch, capfd, words):
    monkeypatch.chdir(tmp_path)
    os.mkfifo("pipe.obj")
    assert main([words[0], "pipe.obj", *words[1:]]) == exit_codes.WRONG_USAGE
    assert "pipe.obj: is no regular file" in capfd.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["pipe.obj"]


def test_the_stages_are_dumped(tmp_path, torus):
    arguments = ["remesh", torus, str(tmp_path / "out.obj"), "--quads", "200", "--dump-stages", str(tmp_path / "dump")]
    assert main(arguments) == exit_codes.OK
    assert list((tmp_path / "dump").glob("*.vtu"))


def unchanged(tmp_path, arguments, status, out="out.obj"):
    """Runs a command that must fail and leave all files, an old result among them, as they were."""
    (tmp_path / out).write_text("old result")
    before = contents(tmp_path)
    assert main(arguments) == status
    assert contents(tmp_path) == before


def contents(folder):
    return {path: path.read_bytes() if path.is_file() else None for path in folder.iterdir()}


def test_an_input_that_cannot_be_remeshed(tmp_path, moebius, capfd):
    unchanged(tmp_path, ["remesh", moebius, str(tmp_path / "out.obj")], exit_codes.CANNOT_REMESH)
    message = capfd.readouterr().err
    assert moebius in message
    assert "non_orientable" in message


def test_a_failure_is_in_the_report_too(tmp_path, moebius):
    report = tmp_path / "report.json"
    status = main(["remesh", moebius, str(tmp_path / "out.obj"), "--report", str(report)])
    assert status == exit_codes.CANNOT_REMESH
    made = json.loads(report.read_text())
    assert (made["status"], made["code"]) == ("input_error", "non_orientable")


@pytest.mark.parametrize(
    "options",
    [
        ["--quads", "0"],
        ["--quads", "many"],
        ["--quads", "10", "--edge-length", "1"],
        ["--sharp-angle", "40", "--no-sharp"],
        ["--edge-length", "-1"],
        ["--time-limit", "0"],
        ["--features", "none.txt"],
        ["--solver", "guess"],
        ["--unknown"],
        ["--report", "no/such/folder/report.json"],
    ],
    ids=" ".join,
)
def test_wrong_usage(tmp_path, torus, options):
    unchanged(tmp_path, ["remesh", torus, str(tmp_path / "out.obj"), *options], exit_codes.WRONG_USAGE)


@pytest.mark.parametrize(
    "words",
    [
        ["remesh", "torus.obj", "out.obj", "--report", "torus.obj"],
        ["remesh", "torus.obj", "out.obj", "--report", "./out.obj"],
        ["remesh", "torus.obj", "out.obj", "--report", "both", "--picture", "both"],
        ["remesh", "torus.obj", "lines.obj", "--guides", "lines.obj"],
        ["remesh", "torus.obj", "out.obj", "--density", "numbers.txt", "--picture", "link.txt"],
        ["check", "torus.obj", "--report", "torus.obj"],
        ["case", "torus.obj", "-o", "torus.obj"],
    ],
    ids=" ".join,
)
def test_no_file_that_was_named_is_written_over_by_another(tmp_path, torus, capfd, monkeypatch, words):
    monkeypatch.chdir(tmp_path)
    for name in ("lines.obj", "numbers.txt"):
        (tmp_path / name).write_text("")
    (tmp_path / "link.txt").symlink_to("numbers.txt")
    unchanged(tmp_path, words, exit_codes.WRONG_USAGE)
    assert "named twice" in capfd.readouterr().err


def test_a_mesh_may_be_remeshed_in_its_place(tmp_path, torus):
    assert main(["remesh", torus, torus, "--quads", "100", "--quiet"]) == exit_codes.OK
    assert set(read_mesh(torus)[1].sizes.tolist()) == {4}


def test_stages_that_have_no_folder_are_wrong_usage(tmp_path, torus, capfd):
    out = str(tmp_path / "out.obj")
    unchanged(tmp_path, ["remesh", torus, out, "--dump-stages", torus], exit_codes.WRONG_USAGE)
    assert "is no folder" in capfd.readouterr().err
    unchanged(tmp_path, ["remesh", torus, out, "--dump-stages", f"{torus}/stages"], exit_codes.WRONG_USAGE)
    assert "torus.obj/stages" in capfd.readouterr().err


def test_a_stage_that_cannot_be_written_is_named(tmp_path, torus, capfd, monkeypatch):
    import meshio

    def fail(*_, **__):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(meshio.Mesh, "write", fail)
    stages, report = tmp_path / "stages", tmp_path / "report.json"
    arguments = ["remesh", torus, str(tmp_path / "out.obj"), "--quads", "100", "--dump-stages", str(stages)]
    assert main([*arguments, "--quiet", "--report", str(report)]) == exit_codes.WRONG_USAGE
    message = capfd.readouterr().err.removeprefix("hybrid-quad: ").strip()
    assert message.startswith(f"{stages}{os.sep}00_") and message.endswith("No space left on device")
    made = json.loads(report.read_text())
    assert (made["status"], made["message"]) == ("unwritable_file", message)


def test_unreadable_files(tmp_path, torus, capfd):
    out = str(tmp_path / "out.obj")
    unchanged(tmp_path, ["remesh", str(tmp_path / "none.obj"), out], exit_codes.WRONG_USAGE)
    assert "none.obj: No such file" in capfd.readouterr().err
    (tmp_path / "bad.obj").write_text("v 1 2\n")
    unchanged(tmp_path, ["remesh", str(tmp_path / "bad.obj"), out], exit_codes.WRONG_USAGE)
    assert "line 1" in capfd.readouterr().err
    assert main(["remesh", torus, str(tmp_path / "out.xyz")]) == exit_codes.WRONG_USAGE
    assert main(["remesh", torus, str(tmp_path / "none" / "out.obj")]) == exit_codes.WRONG_USAGE


@pytest.mark.parametrize(
    "words", [["remesh", "in.obj"], ["batch", "."], ["remesh", "a.obj", "b.obj", "--quads", "many"], ["none"]]
)
def test_a_mistyped_command_is_answered_in_two_lines(capfd, words):
    assert main(words) == exit_codes.WRONG_USAGE
    told = capfd.readouterr().err.splitlines()
    assert len(told) == 2 and told[1].endswith("--help tells more")


@pytest.mark.parametrize("share", ["nan", "-1", "101"])
def test_a_gate_that_could_never_close_is_wrong_usage(tmp_path, torus, share):
    assert main(["batch", torus, "--output", str(tmp_path / "out"), "--fail-above", share]) == exit_codes.WRONG_USAGE
    assert not (tmp_path / "out").exists()


def test_no_command_and_help(capfd):
    assert main([]) == exit_codes.WRONG_USAGE
    assert main(["--help"]) == exit_codes.OK
    assert main(["--version"]) == exit_codes.OK
    assert hybrid_quad.__version__ in capfd.readouterr().out


@pytest.mark.parametrize("is_held", [True, False])
def test_a_result_that_is_not_valid_is_never_written(tmp_path, torus, capfd, monkeypatch, is_held):
    from hybrid_quad.cli import array_run, remesh_command

    arguments = ["remesh", torus, str(tmp_path / "out.obj"), "--quads", "100"]
    if is_held:
        checked = remesh_command.check_valid
        monkeypatch.setattr(remesh_command, "check_valid", lambda _: checked(["1 quads without area: [3]"]))
    else:
        monkeypatch.setattr(array_run, "violations", lambda *_: ["1 quads without area: [3]"])
        features = tmp_path / "features.txt"
        features.write_text("")
        arguments += ["--features", str(features)]
    unchanged(tmp_path, arguments, exit_codes.BUG)
    message = capfd.readouterr().err
    assert "without area" in message
    assert "report it" in message


def on_one_thread(*words):
    """A command, on one thread, whose processor time is then no more than the clock shows, however busy the machine is."""
    return [sys.executable, "-m", "hybrid_quad", *words, "--quiet", "--threads", "1"]


@pytest.mark.skipif(os.name != "posix", reason="the processor time of children")
def test_the_time_limit(tmp_path):
    import resource

    def seconds():
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        return used.ru_utime + used.ru_stime

    mesh = write_obj(tmp_path / "big.obj", *surfaces.torus(400, 160))
    out = tmp_path / "out.obj"
    out.write_text("old result")
    before, begin = contents(tmp_path), seconds()
    # Without the limit it takes many times that.
    asked = on_one_thread("remesh", mesh, str(out), "--quads", "200000", "--time-limit", "1")
    child = subprocess.run(asked, capture_output=True, text=True, check=False)
    assert child.returncode == exit_codes.CANCELLED, child.stderr
    assert "time limit" in child.stderr
    assert seconds() - begin < 1 + 2
    assert contents(tmp_path) == before


def test_the_memory_limit(tmp_path, torus, capfd):
    arguments = ["remesh", torus, str(tmp_path / "out.obj"), "--quads", "300", "--memory-limit"]
    unchanged(tmp_path, [*arguments, "1"], exit_codes.CANCELLED)
    assert "memory limit" in capfd.readouterr().err
    report = tmp_path / "report.json"
    assert main([*arguments, "1", "--report", str(report)]) == exit_codes.CANCELLED
    assert json.loads(report.read_text())["status"] == "memory_limit"
    assert main([*arguments, "1000000"]) == exit_codes.OK
    unchanged(tmp_path, [*arguments, "0"], exit_codes.WRONG_USAGE)


@pytest.mark.skipif(sys.platform != "linux", reason="other systems tell less of a process's memory")
def test_a_memory_limit_that_is_reached_in_the_middle_of_a_run(tmp_path):
    """A whole run says what it took in its first stage and at its end; the limit lies halfway."""
    report, out = tmp_path / "report.json", tmp_path / "out.obj"
    mesh = write_obj(tmp_path / "in.obj", *surfaces.torus(100, 40))
    asked = from_a_shell(on_one_thread("remesh", mesh, str(out), "--quads", "12000", "--report", str(report)))
    subprocess.run(asked, check=True)
    stages = json.loads(report.read_text())["stages"]
    assert stages[0]["name"] == "mesh"
    limit = (stages[0]["peak_mb"] + stages[-1]["peak_mb"]) / 2
    out.write_text("old result")
    report.unlink()
    before = contents(tmp_path)
    child = subprocess.run([*asked, "--memory-limit", f"{limit:.1f}"], capture_output=True, text=True, check=False)
    assert child.returncode == exit_codes.CANCELLED, child.stderr
    told = re.search(r"cancelled during (.+) \(the memory limit is reached\); nothing was written", child.stderr)
    assert told and told[1] in {stage["name"] for stage in stages[1:]}
    assert json.loads(report.read_text())["status"] == "memory_limit"
    report.unlink()
    assert contents(tmp_path) == before


@pytest.fixture
def slow_file(tmp_path, monkeypatch):
    """A mesh whose reading does what is put into `slow_file.act`, and then takes until the test ends."""
    from hybrid_quad.core import mesh_io

    ended = threading.Event()

    class SlowFile:
        path = str(tmp_path / "slow.off")
        act = staticmethod(lambda: None)
        words = ("remesh", path, str(tmp_path / "out.obj"), "--quads", "100")

        @staticmethod
        def read(_path):
            SlowFile.act()
            if ended.wait(60):
                raise RuntimeError("nobody waits for this any more")
            raise MeshFileError("read to its end")

    monkeypatch.setattr(mesh_io, "read_mesh", SlowFile.read)
    (tmp_path / "out.obj").write_text("old result")
    (tmp_path / "slow.off").write_text("")
    yield SlowFile
    ended.set()


def test_limits_end_a_run_while_its_mesh_is_read(tmp_path, slow_file, capfd):
    unchanged(tmp_path, [*slow_file.words, "--time-limit", "0.1"], exit_codes.CANCELLED)
    assert "cancelled during reading (the time limit passed); nothing was written" in capfd.readouterr().err
    report = tmp_path / "report.json"
    assert main([*slow_file.words, "--memory-limit", "1", "--report", str(report)]) == exit_codes.CANCELLED
    assert "cancelled during reading (the memory limit is reached); nothing was written" in capfd.readouterr().err
    assert json.loads(report.read_text())["status"] == "memory_limit"


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize("command", ["remesh", "check"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signals_end_a_command_while_its_mesh_is_read(tmp_path, slow_file, capfd, own_signals, command, number):
    slow_file.act = lambda: os.kill(os.getpid(), number)
    words = slow_file.words if command == "remesh" else ["check", slow_file.path]
    unchanged(tmp_path, words, exit_codes.CANCELLED)
    assert "nothing was written" in capfd.readouterr().err


def test_a_process_ends_while_its_mesh_is_still_read(tmp_path):
    mesh = tmp_path / "big.off"
    vertices, faces = surfaces.torus(400, 160)
    write_polygons(mesh, np.asarray(vertices), as_polygons(faces))
    asked = on_one_thread("remesh", str(mesh), str(tmp_path / "out.obj"), "--memory-limit", "1")
    child = subprocess.run(asked, capture_output=True, text=True, check=False)
    assert child.returncode == exit_codes.CANCELLED, child.stderr
    assert "during reading" in child.stderr


def test_a_machine_without_memory(tmp_path, torus, capfd, monkeypatch):
    def fail(*_, **__):
        raise MemoryError

    monkeypatch.setattr(remesh_command, "remesh_held", fail)
    unchanged(tmp_path, ["remesh", torus, str(tmp_path / "out.obj")], exit_codes.CANCELLED)
    assert "memory" in capfd.readouterr().err


@pytest.mark.skipif(os.name != "posix", reason="limits of POSIX")
@pytest.mark.parametrize("more", [[], ["--report", "report.json"]], ids=["mesh", "report"])
def test_a_write_that_fails_halfway_leaves_the_old_result(tmp_path, torus, more):
    import resource

    out = tmp_path / "out.obj"
    out.write_text("old result")
    files = set(tmp_path.iterdir())
    # As on a full disk: what goes beyond some bytes cannot be written. The report is longer than that alone.
    limit = 200 if more else 2000
    child = subprocess.run(
        [sys.executable, "-m", "hybrid_quad", "remesh", torus, str(out), "--quads", "200", "--quiet", *more],
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
        capture_output=True,
        cwd=tmp_path,
        text=True,
        check=False,
    )
    assert child.returncode == exit_codes.WRONG_USAGE, child.stderr
    assert "File too large" in child.stderr
    assert out.read_text() == "old result"
    assert set(tmp_path.iterdir()) == files


@pytest.mark.parametrize("is_held", [True, False])
def test_a_result_that_cannot_be_written_is_no_success_in_the_report(tmp_path, torus, monkeypatch, is_held):
    from hybrid_quad.core import mesh_io

    def fail(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    out = tmp_path / ("out.obj" if is_held else "out.ply")
    report, picture = tmp_path / "report.json", tmp_path / "p.png"
    out.write_text("old result")
    picture.write_text("old picture")
    if is_held:
        monkeypatch.setattr(remesh_command, "write_held", while_writing(fail))
    else:
        monkeypatch.setattr(mesh_io, "_write_ply", fail)
    arguments = ["remesh", torus, str(out), "--quads", "100", "--report", str(report), "--picture", str(picture)]
    assert main(arguments) == exit_codes.WRONG_USAGE
    made = json.loads(report.read_text())
    assert (made["status"], made["code"]) == ("unwritable_file", "unwritable_file")
    assert made["message"] == f"{out}: No space left on device"
    assert out.read_text() == "old result"
    assert picture.read_text() == "old picture"


def while_writing(act):
    """A writer of results that does something else when half of the file is there."""

    def write(path, _result, files):
        with files.replacing(path) as file:
            file.write(b"half")
            act()

    return write


ENDING = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]


@pytest.fixture
def own_signals():
    """Has a test answer signals in its own process, as a command does in its."""
    before = {number: signal.signal(number, signal.SIG_DFL) for number in ENDING}
    signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.parametrize("number", ENDING)
def test_a_signal_while_the_result_is_written_ends_the_run(tmp_path, torus, capfd, monkeypatch, own_signals, number):
    monkeypatch.setattr(remesh_command, "write_held", while_writing(lambda: signal.raise_signal(number)))
    out = tmp_path / "out.obj"
    out.write_text("old result")
    unchanged(tmp_path, ["remesh", torus, str(out), "--quads", "100"], exit_codes.CANCELLED)
    assert "nothing was written" in capfd.readouterr().err


@pytest.mark.parametrize("number", ENDING)
def test_a_signal_while_files_are_put_in_place_cuts_nothing_in_two(tmp_path, torus, monkeypatch, own_signals, number):
    put = os.replace

    def put_and_signal(*places):
        put(*places)
        signal.raise_signal(number)

    monkeypatch.setattr(os, "replace", put_and_signal)
    out, report, picture = tmp_path / "out.obj", tmp_path / "report.json", tmp_path / "p.png"
    arguments = ["remesh", torus, str(out), "--quads", "100", "--report", str(report), "--picture", str(picture)]
    assert main(arguments) == exit_codes.OK
    assert json.loads(report.read_text())["status"] == "ok"
    assert out.stat().st_size and picture.stat().st_size
    assert {path.name for path in tmp_path.iterdir()} == {"torus.obj", "out.obj", "report.json", "p.png"}


def test_signals_that_are_held_come_afterwards_unless_nobody_heeds_them(own_signals):
    with pytest.raises(KeyboardInterrupt), signals_held() as came:
        signal.raise_signal(signal.SIGINT)
        assert came == [signal.SIGINT]
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with signals_held() as came:
        signal.raise_signal(signal.SIGINT)
    assert came == []
    assert signal.getsignal(signal.SIGINT) == signal.SIG_IGN


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="signals of POSIX")
def test_the_end_of_the_terminal_is_ignored_where_it_was(torus, own_signals):
    signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as nohup does
    assert main(["check", torus]) == exit_codes.OK
    assert signal.getsignal(signal.SIGHUP) == signal.SIG_IGN


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="no folder in which nobody may make files")
@pytest.mark.parametrize("options", [[], ["--report", "/proc/report.json"]], ids=["mesh", "report"])
def test_a_place_where_no_file_can_be_made(tmp_path, torus, capfd, options):
    if options:
        unchanged(
            tmp_path, ["remesh", torus, str(tmp_path / "out.obj"), "--quads", "100", *options], exit_codes.WRONG_USAGE
        )
    else:
        assert main(["remesh", torus, "/proc/out.obj", "--quads", "100"]) == exit_codes.WRONG_USAGE
    assert "/proc/" in capfd.readouterr().err


@pytest.fixture
def tiny_disk(tmp_path):
    """A file system of 32 kB, full with what is on it."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=32k", "tmpfs", folder], capture_output=True, check=False
    )
    if mounted.returncode:
        pytest.skip("mounting is not allowed here")
    yield folder
    subprocess.run(["umount", folder], check=True)


@pytest.mark.skipif(sys.platform != "linux", reason="tmpfs")
def test_a_full_disk_leaves_the_old_result(tmp_path, torus, capfd, tiny_disk):
    out = tiny_disk / "out.obj"
    out.write_text("old result")
    assert main(["remesh", torus, str(out), "--quads", "2000", "--quiet"]) == exit_codes.WRONG_USAGE
    assert "No space left" in capfd.readouterr().err
    assert out.read_text() == "old result"
    assert [path.name for path in tiny_disk.iterdir()] == ["out.obj"]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
def test_a_device_is_not_replaced(tmp_path, torus, capfd):
    arguments = ["remesh", torus, str(tmp_path / "out.obj"), "--quads", "100", "--report", "/dev/full"]
    unchanged(tmp_path, arguments, exit_codes.WRONG_USAGE)
    assert "no regular file" in capfd.readouterr().err


@pytest.fixture
def nobody():
    """What makes ``subprocess.run`` start a Python program as a user to whom something can be denied, as to root it cannot."""
    if os.geteuid():
        return {}
    user = {"user": 65534, "group": 65534, "extra_groups": [], "cwd": "/"}
    try:
        able = subprocess.run([sys.executable, "-c", "import hybrid_quad"], **user, capture_output=True, check=False)
    except OSError:  # may not change the user, or the program lies where only root can go
        able = None
    if able is None or able.returncode:
        pytest.skip("only root can run the package here")
    return user


@pytest.mark.skipif(os.name != "posix", reason="permissions of POSIX")
def test_a_folder_that_cannot_be_written_to_is_noticed_at_once(nobody):
    """Before the input, which is not there, is looked at."""
    with tempfile.TemporaryDirectory() as folder:  # pytest's own may be shut to other users
        Path(folder).chmod(0o555)
        asked = on_one_thread("remesh", f"{folder}/none.obj", f"{folder}/out.obj")
        child = subprocess.run(asked, **nobody, capture_output=True, text=True, check=False)
        assert child.returncode == exit_codes.WRONG_USAGE, child.stderr
        assert "cannot be written to" in child.stderr
        assert not any(Path(folder).iterdir())


@pytest.mark.skipif(os.name != "posix", reason="permissions of POSIX")
@pytest.mark.parametrize("protected", ["out.obj", "report.json", "p.png"])
def test_a_write_protected_file_is_not_replaced(nobody, protected):
    """Which the owner of its folder could; noticed before the input, which is not there, is looked at."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder).chmod(0o777)
        place = Path(folder) / protected
        place.write_text("old")
        place.chmod(0o444)
        more = ["--report", f"{folder}/report.json", "--picture", f"{folder}/p.png"]
        asked = on_one_thread("remesh", f"{folder}/none.obj", f"{folder}/out.obj", *more)
        child = subprocess.run(asked, **nobody, capture_output=True, text=True, check=False)
        assert child.returncode == exit_codes.WRONG_USAGE, child.stderr
        assert f"{place}: is write-protected" in child.stderr
        assert [path.name for path in Path(folder).iterdir()] == [protected]


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("stage", ["mesh", "sizing"])
def test_interrupted_runs_leave_no_file(tmp_path, number, stage):
    mesh = write_obj(tmp_path / "big.obj", *surfaces.torus(400, 160))
    files = set(tmp_path.iterdir())
    command = [sys.executable, "-m", "hybrid_quad", "remesh", mesh, str(tmp_path / "out.ply"), "--quads", "20000"]
    child = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, preexec_fn=heed_interrupts)
    told = next((line for line in child.stderr if line.rstrip().endswith(f"% {stage}")), None)
    assert told is not None, "the run ended before"
    child.send_signal(number)
    _, errors = child.communicate(timeout=60)
    assert child.returncode == exit_codes.CANCELLED, errors
    assert "nothing was written" in errors
    assert set(tmp_path.iterdir()) == files


def test_an_interruption_while_it_starts_is_answered_as_any_other(monkeypatch, capfd):
    from hybrid_quad.cli import main as module
    from hybrid_quad.cli import program

    def interrupted(_given):
        raise KeyboardInterrupt

    monkeypatch.setattr(module, "_parser", interrupted)
    assert program.main() == exit_codes.CANCELLED
    assert "nothing was written" in capfd.readouterr().err


def test_check(tmp_path, torus, moebius, capfd):
    assert main(["check", torus]) == exit_codes.OK
    assert "nothing is wrong" in capfd.readouterr().out
    report = tmp_path / "defects.json"
    assert main(["check", moebius, "--report", str(report)]) == exit_codes.CANNOT_REMESH
    assert "non_orientable" in capfd.readouterr().out
    assert json.loads(report.read_text())["defects"][0]["code"] == "non_orientable"
    vertices, faces = surfaces.torus()
    turned = faces.copy()
    turned[5] = turned[5, ::-1]
    assert main(["check", write_obj(tmp_path / "turned.obj", vertices, turned)]) == exit_codes.OK
    assert "repaired" in capfd.readouterr().out
    assert main(["check", str(tmp_path / "none.obj")]) == exit_codes.WRONG_USAGE


LINE = "0 0 0\n1 0 0\n"


@pytest.mark.parametrize(
    ("content", "more"),
    [
        (None, []),
        ("1 2\n", []),
        (LINE, ["--guide-radius", "0"]),
        (LINE, ["--guide-strength", "2"]),
    ],
    ids=["no file", "no line", "radius", "strength"],
)
def test_guides_that_cannot_be_taken_are_wrong_usage(tmp_path, content, more):
    lines, out = tmp_path / "lines.txt", tmp_path / "out.obj"
    if content:
        lines.write_text(content)
    mesh = write_obj(tmp_path / "in.obj", *surfaces.torus())
    assert main(["remesh", mesh, str(out), "--quiet", "--guides", str(lines), *more]) == exit_codes.WRONG_USAGE
    assert not out.exists()


def test_symmetry_is_made_and_told(tmp_path, torus, capsys):
    out, report = tmp_path / "out.obj", tmp_path / "r.json"
    arguments = ["remesh", torus, str(out), "--quads", "300", "--report", str(report)]
    assert main([*arguments, "--symmetry", "xz"]) == exit_codes.OK
    said = capsys.readouterr().err
    assert "% (used), y " in said
    assert "% (used)\n" in said
    vertices, polygons = read_mesh(out)
    assert_mirrored(vertices, polygons.vertices.reshape(-1, 4), 0)
    assert_mirrored(vertices, polygons.vertices.reshape(-1, 4), 2)
    assert json.loads(report.read_text())["symmetry"]["planes"] == "xz"
    assert main([*arguments, "--symmetry", "auto", "--symmetry-center", "bounds"]) == exit_codes.OK
    assert json.loads(report.read_text())["symmetry"]["planes"] == "xyz"
    assert main([*arguments, "--symmetry", "x", "--symmetry-center", "9,0,0"]) == exit_codes.CANNOT_REMESH
    assert main([*arguments, "--symmetry", "w"]) == exit_codes.WRONG_USAGE
    assert main([*arguments, "--symmetry", "x", "--symmetry-center", "middle"]) == exit_codes.WRONG_USAGE
