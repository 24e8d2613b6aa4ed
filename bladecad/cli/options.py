"""What can be asked for, said once for all commands.

The choices are spelled out here because their own modules import numpy, and `--help` must not; a
test compares them.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias, get_args

import typer

ModelChoice: TypeAlias = Literal["modal", "segmented", "paper", "affine", "second-order"]
SpectrumChoice: TypeAlias = Literal["shared", "varying"]
LawChoice: TypeAlias = Literal["spline", "linear"]
UnitChoice: TypeAlias = Literal["mm", "cm", "m", "in", "ft"]
AxisChoice: TypeAlias = Literal["x", "y", "z"]
LeadChoice: TypeAlias = Literal["low", "high"]
HandChoice: TypeAlias = Literal["left", "right"]
EdgesChoice: TypeAlias = Literal["file", "find"]
FitChoice: TypeAlias = Literal["best", "none"]

PAIRS, DEGREES = range(1, 13), range(3, 41)
READ, FIT, OUT = "How the file is read", "How the blade is fitted", "What is written"
SCAN = "Scans alone"


def parse_order(text: str) -> Any:
    """Turn "4,5,17" into an Order: LE pairs, TE pairs, degree of the core."""
    try:
        le, te, degree = (int(word) for word in text.split(","))
    except ValueError as error:
        raise typer.BadParameter(f'"{text}" should be m_LE,m_TE,p, such as 4,4,17') from error
    if le not in PAIRS or te not in PAIRS or degree not in DEGREES:
        raise typer.BadParameter(
            f"{text}: pairs must lie in {PAIRS[0]} .. {PAIRS[-1]}, "
            f"the degree in {DEGREES[0]} .. {DEGREES[-1]}"
        )
    from bladecad.fit.blade import Order

    return Order(le, te, degree)


def parse_numbers(text: str) -> Any:
    """Turn "0.1,0.5,0.9" into numbers."""
    try:
        return tuple(float(word) for word in text.split(","))
    except ValueError as error:
        raise typer.BadParameter(f'"{text}" should be numbers, such as 0.1,0.5,0.9') from error


def parse_direction(text: str) -> Any:
    """Keep "x", "y" and "z", and turn "1,0,0.1" into a direction."""
    if text in get_args(AxisChoice):
        return text
    direction = parse_numbers(text)
    if len(direction) != 3 or not any(direction) or not all(map(math.isfinite, direction)):
        raise typer.BadParameter(f'"{text}" should be x, y, z or a direction such as 1,0,0.1')
    return direction


def parse_span(text: str) -> Any:
    """Turn "121.5:148.9" into two heights."""
    try:
        low, high = (float(word) for word in text.split(":"))
    except ValueError as error:
        raise typer.BadParameter(f'"{text}" should be two heights, such as 12.5:80') from error
    if not low < high or not math.isfinite(high - low):
        raise typer.BadParameter(f'"{text}": the lower height comes first')
    return low, high


def check_name(name: str | None) -> str | None:
    """Refuse names that are no file names."""
    if name is not None and (
        not name.strip()
        or name.startswith(".")
        or {*name} & {*'/\\:*?"<>|'}
        or not name.isprintable()
    ):
        raise typer.BadParameter(f'"{name}" is no name for a file')
    return name


Input = Annotated[
    Path, typer.Argument(metavar="INPUT", help="File, folder, or one file of a numbered family.")
]
Blade = Annotated[
    Path, typer.Argument(metavar="MODEL", help="Model file, or sections that are fitted first.")
]
OutputFolder = Annotated[
    Path,
    typer.Option("-o", "--output", metavar="DIR", help="Folder for the files.",
                 rich_help_panel=OUT),
]  # fmt: skip
OutputModel = Annotated[
    Path,
    typer.Option("-o", "--output", metavar="MODEL.json", help="Model file.", rich_help_panel=OUT),
]
Name = Annotated[
    str | None,
    typer.Option(callback=check_name, help="Name of the blade and its files; else that of INPUT.",
                 show_default=False, rich_help_panel=OUT),
]  # fmt: skip
Force = Annotated[bool, typer.Option("--force", help="Replace what is there.", rich_help_panel=OUT)]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print the verdict alone.")]
Verbose = Annotated[bool, typer.Option("--verbose", "-v", help="Log each step on stderr.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]

Tolerance = Annotated[
    float,
    typer.Option(metavar="MM", help="Largest distance of fit and points, mm.", rich_help_panel=FIT),
]
ChordError = Annotated[
    float, typer.Option(metavar="MM", help="Of the triangles, mm.", rich_help_panel=OUT)
]
FitTolerance = Annotated[
    float,
    typer.Option("--fit-tolerance", metavar="MM", rich_help_panel=READ,
                 help="Largest distance of fit and points, where MODEL is sections."),
]  # fmt: skip
Model = Annotated[ModelChoice, typer.Option(help="Linear system.", rich_help_panel=FIT)]
OrderOf = Annotated[
    Any,
    typer.Option("--order", parser=parse_order, metavar="m_LE,m_TE,p",
                 help="Fixed size of a modal fit; else the smallest within tolerance.",
                 show_default=False, rich_help_panel=FIT),
]  # fmt: skip
Spectrum = Annotated[
    SpectrumChoice,
    typer.Option(help="Rates, the same for all sections or not.", rich_help_panel=FIT),
]
Law = Annotated[LawChoice, typer.Option(help="Blend between sections.", rich_help_panel=FIT)]
Units = Annotated[
    UnitChoice | None,
    typer.Option(help="Unit of the file; else as it says, else mm.", show_default=False,
                 rich_help_panel=READ),
]  # fmt: skip
Axis = Annotated[
    AxisChoice | None,
    typer.Option(help="Machine axis; else as the file says, else z.", show_default=False,
                 rich_help_panel=READ),
]  # fmt: skip
AnyAxis = Annotated[
    Any,
    typer.Option("--axis", parser=parse_direction, metavar="x|y|z|a,b,c", show_default=False,
                 help="Machine axis of sections; else as the file says, else z. Of a scan the "
                 "stacking axis, hub to tip; else found.", rich_help_panel=READ),
]  # fmt: skip
ScanAxis = Annotated[
    Any,
    typer.Option("--axis", parser=parse_direction, metavar="x|y|z|a,b,c", show_default=False,
                 help="Stacking axis, hub to tip; else found.", rich_help_panel=READ),
]  # fmt: skip
Span = Annotated[
    Any,
    typer.Option("--span", parser=parse_span, metavar="a:b", show_default=False,
                 help="Heights along the axis between which it is airfoil, mm; else found.",
                 rich_help_panel=SCAN),
]  # fmt: skip
About = Annotated[
    Any,
    typer.Option("--about", parser=parse_direction, metavar="x|y|z|a,b,c", show_default=False,
                 help="Machine axis through the origin: cut by cylinders about it, not by planes.",
                 rich_help_panel=SCAN),
]  # fmt: skip
Cone = Annotated[
    float | None,
    typer.Option("--cone", metavar="DEG", show_default=False,
                 help="Half angle of cones about that axis instead.", rich_help_panel=SCAN),
]  # fmt: skip
Stations = Annotated[
    int | None,
    typer.Option("--stations", metavar="N", show_default=False,
                 help="How many sections a scan is cut into; else 21.", rich_help_panel=SCAN),
]  # fmt: skip
Align = Annotated[
    bool,
    typer.Option("--align", help="Write files in the frame of the blade, not of the scan.",
                 rich_help_panel=SCAN),
]  # fmt: skip
AllowPartial = Annotated[
    bool,
    typer.Option("--allow-partial", rich_help_panel=SCAN,
                 help="Build one of several blades, or what large gaps leave of one."),
]  # fmt: skip
Lead = Annotated[
    LeadChoice | None,
    typer.Option("--le", help="Leading edge at the low or high end of the axis; else by shape.",
                 show_default=False, rich_help_panel=READ),
]  # fmt: skip
Suction = Annotated[
    HandChoice | None,
    typer.Option(help="Suction side, seen along the chord from outside; else by shape.",
                 show_default=False, rich_help_panel=READ),
]  # fmt: skip
Edges = Annotated[
    EdgesChoice,
    typer.Option(help="Edge points as the file names them, or found.", rich_help_panel=READ),
]
