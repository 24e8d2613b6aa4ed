"""How OpenFOAM's own files begin."""

from __future__ import annotations


def foam_header(kind: str, name: str, location: str) -> str:
    """The FoamFile entry of a file of that class."""
    return (
        "FoamFile\n{\n    version     2.0;\n    format      ascii;\n"
        f"    class       {kind};\n"
        f'    location    "{location}";\n'
        f"    object      {name};\n}}\n"
    )
