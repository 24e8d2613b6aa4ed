"""The steps of the method, one line each.

build   sections in, a measured solid out
scan.build_scan   a scan in, a measured solid out
check   a nominal blade and a scan in, a verdict out
"""

from bladecad.pipeline.build import Build as Build
from bladecad.pipeline.build import Settings as Settings
from bladecad.pipeline.build import build as build
from bladecad.pipeline.build import fit as fit
from bladecad.pipeline.build import load as load
from bladecad.pipeline.build import split as split
from bladecad.pipeline.build import surface_of as surface_of
from bladecad.pipeline.check import Check as Check
from bladecad.pipeline.check import CheckSettings as CheckSettings
from bladecad.pipeline.check import check as check
from bladecad.pipeline.clock import Clock as Clock
from bladecad.pipeline.clock import Progress as Progress
from bladecad.pipeline.nominal import NominalSettings as NominalSettings
from bladecad.pipeline.nominal import load_nominal as load_nominal
