"""The blades of the ladder: the repository's own, and the published ones where present."""

from __future__ import annotations

from pathlib import Path
from typing import Final, NamedTuple

from bladecad.curves.sides import BladeLines, split_sides
from bladecad.errors import DataError
from bladecad.pipeline import Settings, load, split
from bladecad.replay.layout import POINTS, paper_layout

REPOSITORY: Final = Path(__file__).resolve().parents[2]
DEFAULT: Final = "Rotor 37, 15 x 71"


class Known(NamedTuple):
    """A blade, by name and by its file below fixtures/ or ../shared/data/.

    points   : a side, None for as many as were measured; with a number, laid out as the paper's
    settings : how it is read
    """

    name: str
    path: Path
    points: int | None = None
    settings: Settings = Settings()


FIXTURES: Final = {
    "Rotor 37, running": "rotor37/sections.csv",
    "Rotor 37, cold": "rotor37-cold/tp1337_sections.csv",
}
PUBLISHED: Final = {
    "Hannover IGV": "hannover-4ac-front/0_IGV_Vane.crv",
    "Hannover rotor 1": "hannover-4ac-front/1_Rotor1_Blade.crv",
    "Hannover stator 1": "hannover-4ac-front/2_Stator1_Vane.crv",
    "Hannover rotor 2": "hannover-4ac-front/3_Rotor2_Blade.crv",
    "Hannover stator 2": "hannover-4ac-front/4_Stator2_Vane.crv",
    "HECC impeller": "nasa-hecc-main/design/"
    "HECCvanedCoordinates_impeller_main_blade_section_01.txt",
    "HECC exit guide vane": "nasa-hecc-main/design/HECCvanedCoordinates_EGV_00.txt",
    "HECC diffuser vane": "nasa-hecc-main/design/HECCvanedCoordinates_diffuser_main_vane_00.txt",
    "AutoBlade rotor": "geomturbo-samples/rotor_db.geomTurbo",
    "AutoBlade impeller": "geomturbo-samples/cc_autoblade.geomTurbo",
    "STAC rotor": "stac-turbine/R1_TS-3_profile.crv",
    "STAC stator": "stac-turbine/S1_TS-1_profile.crv",
}


def default_blade() -> Known:
    """Rotor 37 of the repository in the paper's layout.

    Raises
    ------
    DataError
        If the package was installed without its repository.
    """
    path = REPOSITORY / "fixtures" / FIXTURES["Rotor 37, running"]
    if not path.is_file():
        raise DataError(f"{path.name} of Rotor 37 is not in fixtures/; name an INPUT to replay")
    return Known(DEFAULT, path, POINTS)


def others() -> list[Known]:
    """The further blades of the ladder that are present."""
    below = {REPOSITORY / "fixtures": FIXTURES, REPOSITORY.parent / "shared" / "data": PUBLISHED}
    known = [Known(n, folder / p) for folder, files in below.items() for n, p in files.items()]
    return [blade for blade in known if blade.path.is_file()]


def lines_of(blade: Known) -> BladeLines:
    """Read a blade and break it at its edges, laid out anew if it is the paper's."""
    sections, _, keep = load(blade.path, blade.settings)
    lines = split(sections, blade.settings, keep)
    return split_sides(paper_layout(lines)) if blade.points else lines
