"""The examples run, without a screen; those that need another library where it is installed."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[3] / "examples" / "python"
EXAMPLES = sorted(path.name for path in FOLDER.glob("[!_]*.py"))


def test_there_are_examples():
    assert EXAMPLES


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_runs(name, tmp_path):
    for library in re.findall(r"^(?:from|import) (joblib|dask\.distributed|ray)", (FOLDER / name).read_text(), re.MULTILINE):
        pytest.importorskip(library)
    command = [sys.executable, str(FOLDER / name), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, cwd=FOLDER.parents[1])
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip()
