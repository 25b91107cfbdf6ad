"""The command that comes with the package."""

import subprocess
import sys
from pathlib import Path

COMMAND = Path(sys.executable).with_name("pbrdf-explorer")


def test_the_command_is_the_program(program, example):
    for arguments in (["--version"], ["fit", str(example), "--starts", "1"], ["metals", "Cu", "--wavelength", "650"]):
        here = subprocess.run([COMMAND, *arguments], capture_output=True, encoding="utf-8")
        assert here.returncode == 0, here.stderr
        theirs = [line for line in program(*arguments).splitlines() if "ms" not in line]
        assert [line for line in here.stdout.splitlines() if "ms" not in line] == theirs


def test_its_exit_codes_are_the_programs(tmp_path):
    done = subprocess.run([COMMAND, "fit", tmp_path / "none.csv"], capture_output=True, encoding="utf-8")
    assert done.returncode == 2 and "none.csv" in done.stderr and not done.stdout


def test_without_a_display_it_says_so():
    done = subprocess.run([COMMAND], capture_output=True, encoding="utf-8", env={"PATH": ""})
    assert done.returncode == 2 and "display" in done.stderr
