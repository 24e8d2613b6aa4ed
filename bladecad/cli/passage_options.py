"""What can be asked about the passage round a blade."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import typer

PASSAGE = "The passage round the blade"

Passage = Annotated[
    bool,
    typer.Option("--passage", rich_help_panel=PASSAGE,
                 help="The periodic flow domain of one blade, not the blade alone."),
]  # fmt: skip
Row = Annotated[
    bool,
    typer.Option("--row", rich_help_panel=PASSAGE, help="The domain of all blades of the row."),
]
Walls = Annotated[
    Path | None,
    typer.Option("--walls", metavar="FILE", show_default=False, rich_help_panel=PASSAGE,
                 help="Hub and shroud: .inf, .geomTurbo, or a table curve,z_mm,r_mm."),
]  # fmt: skip
Blades = Annotated[
    int | None,
    typer.Option("--blades", metavar="N", show_default=False, rich_help_panel=PASSAGE,
                 help="Blades in the row, where the file does not say."),
]  # fmt: skip
TipGap = Annotated[
    float,
    typer.Option("--tip-gap", metavar="MM", rich_help_panel=PASSAGE,
                 help="Between blade and shroud, along its normal."),
]  # fmt: skip
HubGap = Annotated[
    float,
    typer.Option("--hub-gap", metavar="MM", rich_help_panel=PASSAGE,
                 help="Between blade and hub, of a cantilevered stator."),
]  # fmt: skip
Inlet = Annotated[
    float | None,
    typer.Option("--inlet", metavar="MM", show_default=False, rich_help_panel=PASSAGE,
                 help="Along both walls ahead of the leading edge; else a chord."),
]  # fmt: skip
Outlet = Annotated[
    float | None,
    typer.Option("--outlet", metavar="MM", show_default=False, rich_help_panel=PASSAGE,
                 help="Along both walls behind the trailing edge; else a chord."),
]  # fmt: skip
Step = Annotated[
    bool,
    typer.Option("--step", rich_help_panel=PASSAGE,
                 help="The passage of one blade as a STEP solid, too, beside the mesh."),
]  # fmt: skip


def refuse_alone(given: Mapping[str, Any]) -> None:
    """Raise ToleranceError where an option of the passage is given for a blade alone."""
    from bladecad.errors import ToleranceError

    names = [name for name, value in given.items() if value not in (None, 0.0, False)]
    if names:
        flag = names[0].replace("_", "-")
        raise ToleranceError(f"--{flag} is about the passage; give --passage or --row with it")
