"""What benchmarks tell of the programs that they start."""

import signal
import sys

import pytest

pytest.importorskip("resource")

from measuring import measure

SMALL = [sys.executable, "-I", "-S", "-c"]
BIG = "x = b'x' * (100 << 20)"


def test_the_peak_is_the_program_s_own():
    held = bytearray(b"x") * (200 << 20)
    measured = measure([*SMALL, "pass"], 60, 0)
    assert held and measured.status == "ok" and 1 < measured.peak_mb < 100


def test_the_peak_is_that_of_the_program_and_what_it_started():
    code = f"import subprocess; subprocess.run({[*SMALL, BIG]})"
    assert measure([*SMALL, code], 60, 0).peak_mb > 100


def test_how_a_program_ends_is_told():
    failed = measure([*SMALL, "raise SystemExit('no such luck')"], 60, 0)
    assert (failed.status, failed.message) == ("failed", "no such luck")
    crashed = measure([*SMALL, "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)"], 60, 0)
    assert (crashed.status, crashed.message.split()) == ("crash", ["signal", str(int(signal.SIGSEGV))])
    missing = measure(["no-such-program"], 60, 0)
    assert missing.status == "failed" and "no-such-program" in missing.message


def test_limits_hold():
    over = measure([*SMALL, "import time; time.sleep(60)"], 0.5, 0)
    assert over.status == "timeout" and 0.4 < over.seconds < 30 and over.cpu_seconds < 0.5
    busy = measure([*SMALL, "while True: pass"], 60, 0, cpu_seconds=1)
    assert (busy.status, busy.message) == ("timeout", "more than 1 s of the processor")
    assert measure([*SMALL, "x = b'x' * (1 << 30)"], 60, 500).status == "failed"


def test_variables_and_output_are_the_program_s(tmp_path):
    code = "import os; print(os.environ.get('HOME'), os.environ['WISH'])"
    with (tmp_path / "log").open("w") as log:
        assert measure([*SMALL, code], 60, 0, environment={"WISH": "a b"}, output=log).status == "ok"
    assert (tmp_path / "log").read_text() == "None a b\n"
