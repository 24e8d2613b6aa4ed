"""Imports begun ahead."""

import subprocess
import sys

from bladecad.pipeline.ahead import BODY, import_ahead

PROGRAM = """
import sys
from bladecad.pipeline.ahead import BODY, import_ahead
before = "cadquery" in sys.modules
import_ahead(*BODY).join()
print(before, all(name in sys.modules for name in (*BODY, "cadquery")))
"""


def test_what_is_named_is_imported():
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True
    )
    assert run.stdout.split() == ["False", "True"]
    assert run.stderr == ""


def test_what_cannot_be_imported_is_left_to_who_needs_it(tmp_path, monkeypatch):
    (tmp_path / "broken_module.py").write_text("1 / 0")
    monkeypatch.syspath_prepend(tmp_path)
    import_ahead("broken_module", "no_such_module", *BODY[:1]).join()
    assert "broken_module" not in sys.modules
    assert BODY[0] in sys.modules
