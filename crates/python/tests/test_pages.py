"""Python on the pages of the documentation runs: the blocks of a page one after the other, beside the files of ``examples/models``."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
BLOCK = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
PAGES = [ROOT / "README.md", ROOT / "crates/python/README.md", *sorted((ROOT / "docs").rglob("*.md"))]
SHOWN = [page for page in PAGES if BLOCK.search(page.read_text(encoding="utf-8"))]


def test_pages_show_python():
    assert ROOT / "README.md" in SHOWN


@pytest.mark.parametrize("page", SHOWN, ids=lambda page: str(page.relative_to(ROOT)))
def test_what_a_page_shows_runs(page, tmp_path, monkeypatch):
    shutil.copytree(ROOT / "examples/models", tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for block in BLOCK.findall(page.read_text(encoding="utf-8")):
        exec(compile(block, str(page), "exec"), names)


def test_the_comparison_is_what_the_example_prints():
    shown = (ROOT / "README.md").read_text(encoding="utf-8").splitlines()
    command = [sys.executable, str(ROOT / "examples/python/compare.py")]
    printed = subprocess.run(command, capture_output=True, text=True, check=True, timeout=600).stdout.splitlines()
    rows = [row for row in printed if row.startswith("| ")]
    assert any(row.startswith("| exact") for row in rows)
    assert [row for row in rows if row not in shown] == []


def test_kept_tolerances_are_what_the_example_prints():
    for library in ("scipy", "trimesh", "vtk"):
        pytest.importorskip(library)
    shown = (ROOT / "docs/kept-tolerances.md").read_text(encoding="utf-8").splitlines()
    command = [sys.executable, str(ROOT / "examples/python/kept_tolerances.py")]
    printed = subprocess.run(command, capture_output=True, text=True, check=True, timeout=600).stdout.splitlines()
    # Other tools change, and times do.
    own = [[row.rsplit("|", 2)[0] for row in rows if row.startswith("| limitmesh")] for rows in (printed, shown)]
    assert own[0]
    assert [row for row in own[0] if row not in own[1]] == []
