"""Measured compressor blades to certified CAD.

    import bladecad

    blade = bladecad.build("sections.csv", bladecad.Settings(tolerance=0.012))
    bladecad.export_blade(blade, "blade")

    scanned = bladecad.build_scan("scan.ply")

Names are loaded when they are first asked for: importing bladecad costs nothing, and a model file
can be loaded and evaluated with numpy alone.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bladecad.brep.reread import read_step as read_step
    from bladecad.brep.solid import Solid as Solid
    from bladecad.brep.solid import build_solid as build_solid
    from bladecad.cam.offset import offset_loft as offset_loft
    from bladecad.cam.sheet import CamSheet as CamSheet
    from bladecad.cam.sheet import cam_sheet as cam_sheet
    from bladecad.cam.variant import Variant as Variant
    from bladecad.cam.variant import varied as varied
    from bladecad.curves.sides import BladeLines as BladeLines
    from bladecad.curves.sides import split_sides as split_sides
    from bladecad.data.read import read_sections as read_sections
    from bladecad.data.read_scan import read_scan as read_scan
    from bladecad.data.scan import Scan as Scan
    from bladecad.data.sections import Machine as Machine
    from bladecad.data.sections import Row as Row
    from bladecad.data.sections import Section as Section
    from bladecad.data.sections import Sections as Sections
    from bladecad.data.synthetic import synthetic_blade as synthetic_blade
    from bladecad.data.tolerance_file import read_tolerances as read_tolerances
    from bladecad.data.write import write_sections as write_sections
    from bladecad.deviation.inspecting.inspection import Inspection as Inspection
    from bladecad.deviation.inspecting.inspection import inspect as inspect
    from bladecad.deviation.inspecting.measure import Deviation as Deviation
    from bladecad.deviation.inspecting.measure import measure as measure
    from bladecad.deviation.nearest.feet import Feet as Feet
    from bladecad.deviation.nearest.nominal import Nominal as Nominal
    from bladecad.deviation.nearest.nominal import nominal_of as nominal_of
    from bladecad.deviation.nearest.project import project as project
    from bladecad.deviation.registering.registration import Registration as Registration
    from bladecad.deviation.registering.registration import register as register
    from bladecad.errors import BladecadError as BladecadError
    from bladecad.errors import DataError as DataError
    from bladecad.errors import ExportError as ExportError
    from bladecad.errors import FitError as FitError
    from bladecad.errors import GeometryError as GeometryError
    from bladecad.errors import ToleranceError as ToleranceError
    from bladecad.export.cad.step import write_step as write_step
    from bladecad.export.cad.stl import write_stl as write_stl
    from bladecad.export.check.files import export_check as export_check
    from bladecad.export.files import export_blade as export_blade
    from bladecad.export.model.model_file import load as load
    from bladecad.export.model.model_file import save as save
    from bladecad.export.reports.info import describe as describe
    from bladecad.fit.blade import BladeFit as BladeFit
    from bladecad.fit.blade import Order as Order
    from bladecad.fit.order import fit_blade as fit_blade
    from bladecad.meshes.blade import mesh_blade as mesh_blade
    from bladecad.meshes.named import NamedMesh as NamedMesh
    from bladecad.meshes.sizing import Sizing as Sizing
    from bladecad.pipeline import Build as Build
    from bladecad.pipeline import Check as Check
    from bladecad.pipeline import CheckSettings as CheckSettings
    from bladecad.pipeline import NominalSettings as NominalSettings
    from bladecad.pipeline import Settings as Settings
    from bladecad.pipeline import build as build
    from bladecad.pipeline import check as check
    from bladecad.pipeline import load_nominal as load_nominal
    from bladecad.pipeline.blade_file import BladeFile as BladeFile
    from bladecad.pipeline.blade_file import load_blade as load_blade
    from bladecad.pipeline.cad import CadSettings as CadSettings
    from bladecad.pipeline.cad import cad_blade as cad_blade
    from bladecad.pipeline.cad import export_cad as export_cad
    from bladecad.pipeline.cam import write_cam_sheet as write_cam_sheet
    from bladecad.pipeline.mesh import write_blade_mesh as write_blade_mesh
    from bladecad.pipeline.passage import passage_of as passage_of
    from bladecad.pipeline.passage import write_passage as write_passage
    from bladecad.pipeline.passage_settings import PassageSettings as PassageSettings
    from bladecad.pipeline.scan import build_scan as build_scan
    from bladecad.pipeline.scan_build import ScanBuild as ScanBuild
    from bladecad.pipeline.scan_settings import ScanSettings as ScanSettings
    from bladecad.pipeline.sections_of import CutSettings as CutSettings
    from bladecad.pipeline.sections_of import sections_of as sections_of
    from bladecad.pipeline.write_cut import write_cut as write_cut
    from bladecad.scans.finding.airfoil import Airfoil as Airfoil
    from bladecad.scans.finding.airfoil import find_airfoil as find_airfoil
    from bladecad.scans.fitting.whole import WholeFit as WholeFit
    from bladecad.scans.fitting.whole import fit_scan as fit_scan
    from bladecad.scans.judging.support import Gap as Gap
    from bladecad.scans.judging.support import find_gaps as find_gaps
    from bladecad.scans.slicing.parted import parted as parted
    from bladecad.scans.slicing.slices import slice_airfoil as slice_airfoil
    from bladecad.surface.blade import BladeSurface as BladeSurface
    from bladecad.surface.loft import Loft as Loft
    from bladecad.surface.loft import loft as loft
    from bladecad.surface.triangulate import BladeMesh as BladeMesh
    from bladecad.surface.triangulate import triangulate as triangulate
    from bladecad.surface.volume import volume as volume
    from bladecad.tolerance import Band as Band
    from bladecad.tolerance import Tolerances as Tolerances
    from bladecad.tolerance import uniform as uniform

__version__ = "0.1.0"

__all__ = [
    "Airfoil",
    "Band",
    "BladeFile",
    "BladeFit",
    "BladeLines",
    "BladeMesh",
    "BladeSurface",
    "BladecadError",
    "Build",
    "CadSettings",
    "CamSheet",
    "Check",
    "CheckSettings",
    "CutSettings",
    "DataError",
    "Deviation",
    "ExportError",
    "Feet",
    "FitError",
    "Gap",
    "GeometryError",
    "Inspection",
    "Loft",
    "Machine",
    "NamedMesh",
    "Nominal",
    "NominalSettings",
    "Order",
    "PassageSettings",
    "Registration",
    "Row",
    "Scan",
    "ScanBuild",
    "ScanSettings",
    "Section",
    "Sections",
    "Settings",
    "Sizing",
    "Solid",
    "ToleranceError",
    "Tolerances",
    "Variant",
    "WholeFit",
    "__version__",
    "build",
    "build_scan",
    "build_solid",
    "cad_blade",
    "cam_sheet",
    "check",
    "describe",
    "export_blade",
    "export_cad",
    "export_check",
    "find_airfoil",
    "find_gaps",
    "fit_blade",
    "fit_scan",
    "inspect",
    "load",
    "load_blade",
    "load_nominal",
    "loft",
    "measure",
    "mesh_blade",
    "nominal_of",
    "offset_loft",
    "parted",
    "passage_of",
    "project",
    "read_scan",
    "read_sections",
    "read_step",
    "read_tolerances",
    "register",
    "save",
    "sections_of",
    "slice_airfoil",
    "split_sides",
    "synthetic_blade",
    "triangulate",
    "uniform",
    "varied",
    "volume",
    "write_blade_mesh",
    "write_cam_sheet",
    "write_cut",
    "write_passage",
    "write_sections",
    "write_step",
    "write_stl",
]

_HOMES = {
    "brep.reread": ("read_step",),
    "brep.solid": ("Solid", "build_solid"),
    "cam.offset": ("offset_loft",),
    "cam.sheet": ("CamSheet", "cam_sheet"),
    "cam.variant": ("Variant", "varied"),
    "curves.sides": ("BladeLines", "split_sides"),
    "data.read": ("read_sections",),
    "data.read_scan": ("read_scan",),
    "data.scan": ("Scan",),
    "data.sections": ("Machine", "Row", "Section", "Sections"),
    "data.synthetic": ("synthetic_blade",),
    "data.tolerance_file": ("read_tolerances",),
    "data.write": ("write_sections",),
    "deviation.inspecting.inspection": ("Inspection", "inspect"),
    "deviation.inspecting.measure": ("Deviation", "measure"),
    "deviation.nearest.feet": ("Feet",),
    "deviation.nearest.nominal": ("Nominal", "nominal_of"),
    "deviation.nearest.project": ("project",),
    "deviation.registering.registration": ("Registration", "register"),
    "errors": (
        "BladecadError",
        "DataError",
        "ExportError",
        "FitError",
        "GeometryError",
        "ToleranceError",
    ),
    "export.cad.step": ("write_step",),
    "export.cad.stl": ("write_stl",),
    "export.check.files": ("export_check",),
    "export.files": ("export_blade",),
    "export.model.model_file": ("load", "save"),
    "export.reports.info": ("describe",),
    "fit.blade": ("BladeFit", "Order"),
    "fit.order": ("fit_blade",),
    "meshes.blade": ("mesh_blade",),
    "meshes.named": ("NamedMesh",),
    "meshes.sizing": ("Sizing",),
    "pipeline": (
        "Build",
        "Check",
        "CheckSettings",
        "NominalSettings",
        "Settings",
        "build",
        "check",
        "load_nominal",
    ),
    "pipeline.blade_file": ("BladeFile", "load_blade"),
    "pipeline.cad": ("CadSettings", "cad_blade", "export_cad"),
    "pipeline.cam": ("write_cam_sheet",),
    "pipeline.mesh": ("write_blade_mesh",),
    "pipeline.passage": ("passage_of", "write_passage"),
    "pipeline.passage_settings": ("PassageSettings",),
    "pipeline.scan": ("build_scan",),
    "pipeline.scan_build": ("ScanBuild",),
    "pipeline.scan_settings": ("ScanSettings",),
    "pipeline.sections_of": ("CutSettings", "sections_of"),
    "pipeline.write_cut": ("write_cut",),
    "scans.finding.airfoil": ("Airfoil", "find_airfoil"),
    "scans.fitting.whole": ("WholeFit", "fit_scan"),
    "scans.judging.support": ("Gap", "find_gaps"),
    "scans.slicing.parted": ("parted",),
    "scans.slicing.slices": ("slice_airfoil",),
    "surface.blade": ("BladeSurface",),
    "surface.loft": ("Loft", "loft"),
    "surface.triangulate": ("BladeMesh", "triangulate"),
    "surface.volume": ("volume",),
    "tolerance": ("Band", "Tolerances", "uniform"),
}


def __getattr__(name: str) -> object:
    """Load a public name from its home, once."""
    for home, names in _HOMES.items():
        if name in names:
            value: object = getattr(import_module(f"bladecad.{home}"), name)
            globals()[name] = value
            return value
    raise AttributeError(f"module 'bladecad' has no attribute '{name}'")


def __dir__() -> list[str]:
    return __all__
