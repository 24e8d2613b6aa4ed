"""Rows of numbers in groups, under headings or between blank lines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from bladecad.data.text import Text, is_row


@final
@dataclass(frozen=True)
class Block:
    """Lines of numbers that belong together.

    headings : the comment or text lines above it, `##` comments left out
    rows     : line indices, starting at 0
    """

    headings: tuple[str, ...]
    rows: tuple[int, ...]

    def name(self, default: str) -> str:
        """Return the last heading, cleaned of its comment sign, else `default`."""
        words = self.headings[-1].lstrip(" \t#!%*").split() if self.headings else []
        return (
            default if len(words) < 2 and "".join(words).strip("+").isdigit() else " ".join(words)
        )


def blocks(text: Text) -> tuple[Block, ...]:
    """Group the rows of a file; where every group has a heading, blank lines do not split."""
    found: list[Block] = []
    headings: list[str] = []
    rows: list[int] = []
    for i, line in enumerate((*text.lines, "")):
        if line.strip() and not line.lstrip().startswith("#") and is_row(line):
            rows.append(i)
            continue
        if rows:
            found.append(Block(tuple(headings), tuple(rows)))
            headings, rows = [], []
        if line.strip() and not line.lstrip().startswith("##"):
            headings.append(line)
    return _joined(found)


def _joined(found: list[Block]) -> tuple[Block, ...]:
    headed = [bool(block.headings) for block in found]
    if sum(headed) < 2 or not headed[0]:
        return tuple(found)
    joined: list[Block] = []
    for block in found:
        if block.headings:
            joined.append(block)
        else:
            joined[-1] = Block(joined[-1].headings, joined[-1].rows + block.rows)
    return tuple(joined)
