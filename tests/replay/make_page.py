"""Write docs/paper.md and its pictures anew: python tests/replay/make_page.py."""

import shutil
import tempfile
from pathlib import Path

from bladecad.replay.results import replayed
from bladecad.replay.write import write, write_page

DOCS = Path(__file__).resolve().parents[2] / "docs"

if __name__ == "__main__":
    results = replayed(progress=print)
    write_page(results, DOCS / "paper.md", "paper/")
    (DOCS / "paper").mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        write(results, Path(folder))
        for picture in Path(folder).glob("*.png"):
            shutil.copy(picture, DOCS / "paper")
