"""What `bladecad export` says about a file it has read back."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bladecad.brep.joints import Joint
    from bladecad.pipeline.cad import CadBlade, CadExport


def cad_lines(made: CadBlade, found: CadExport, output: Path) -> Iterator[str]:
    """Numbers, a line for every joint, and last the file in one line."""
    file, witnesses, asked = found.written.file, made.solid.witnesses, made.settings.tolerance
    agreement = found.written.agreement
    yield f"faces            {', '.join(file.faces)}"
    yield (
        f"volume           {file.volume:.9g} mm3, {witnesses.volume_error:.1e} from quadrature, "
        f"{agreement.volume_error:.1e} from the file"
    )
    away = f"{1e3 * found.error:.3g} um, {1e3 * asked:.3g} um allowed"
    yield f"from the surface {away}{_offset(made)}"
    yield f"edge tolerance   {1e3 * witnesses.edge_tolerance:.3g} um"
    for joint in found.joints:
        yield _joint(joint)
    within = "" if found.error <= asked else "; OUT OF TOLERANCE"
    yield (
        f"{output}: {file.format}, one valid solid of {len(file.faces)} faces, "
        f"{found.written.size / 1e3:.0f} kB, read back and confirmed{within}"
    )


def _offset(made: CadBlade) -> str:
    offset = made.settings.offset
    return f", offset by {offset:g} mm" if offset else ""


def _joint(joint: Joint) -> str:
    """One joint: where, how long, and how smooth."""
    names = " | ".join(dict.fromkeys(joint.faces))
    kind = f"{joint.edge} edge" if joint.edge != "seam" else "seam"
    return (
        f"{kind:<16} {names}: {joint.length:.4g} mm, gap {1e3 * joint.gap:.2g} um, "
        + (f"G1 {joint.angle:.1e} deg, " if joint.smooth else f"corner of {joint.angle:.3g} deg, ")
        + f"G2 {joint.jump:.1e} of {joint.curvature:.3g} 1/mm"
    )
