"""What `bladecad export` can be asked for, beside what all commands know."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias

import typer

from bladecad.cli import options as ask

FacesChoice: TypeAlias = Literal["2", "4", "1"]
SchemaChoice: TypeAlias = Literal["ap242", "ap214"]
VARIED = "How the blade is changed before it is cut, in this order"


def parse_untwist(text: str) -> Any:
    """Turn "2.5" into degrees at the tip, and "0:0,0.4:1.2,1:2.5" into a table of (u, degrees)."""
    try:
        if ":" not in text:
            return float(text)
        return [[float(word) for word in pair.split(":", 1)] for pair in text.split(",")]
    except ValueError as error:
        raise typer.BadParameter(
            f'"{text}" should be degrees at the tip, or u:degrees,u:degrees'
        ) from error


OutputFile = Annotated[
    Path,
    typer.Option("-o", "--output", metavar="FILE", rich_help_panel=ask.OUT,
                 help=".step, .stp, .igs, .iges, .brep or .stl."),
]  # fmt: skip
Faces = Annotated[
    FacesChoice | None,
    typer.Option("--faces", show_default=False, rich_help_panel=ask.OUT,
                 help="2 sides (usual), 4 zones with edges of their own, or 1 face all round."),
]  # fmt: skip
Schema = Annotated[
    SchemaChoice | None,
    typer.Option("--schema", show_default=False, rich_help_panel=ask.OUT,
                 help="Of STEP: ap242 (usual) or ap214."),
]  # fmt: skip
Tolerance = Annotated[
    float | None,
    typer.Option("--tolerance", metavar="MM", show_default=False, rich_help_panel=ask.OUT,
                 help="Largest distance of faces from the surface or its offset, else 0.001; of "
                 "triangles, else 0.005."),
]  # fmt: skip
Untwist = Annotated[
    Any,
    typer.Option("--untwist", parser=parse_untwist, metavar="DEG|u:DEG,...", show_default=False,
                 help="Turn sections about the stacking axis: the tip by so much, or a table.",
                 rich_help_panel=VARIED),
]  # fmt: skip
Scale = Annotated[
    float,
    typer.Option("--scale", metavar="FACTOR", help="About the origin.", rich_help_panel=VARIED),
]
Shrinkage = Annotated[
    float,
    typer.Option("--shrinkage", metavar="PERCENT", rich_help_panel=VARIED,
                 help="Make it larger by what the part will shrink."),
]  # fmt: skip
Mirror = Annotated[
    ask.AxisChoice | None,
    typer.Option("--mirror", show_default=False, rich_help_panel=VARIED,
                 help="Change the sign of one coordinate."),
]  # fmt: skip
Offset = Annotated[
    float,
    typer.Option("--offset", metavar="MM", rich_help_panel=VARIED,
                 help="Machining allowance on the sides, everywhere the same; below 0 inward."),
]  # fmt: skip
