"""Many drapes of one part: cases, where they run, rows, ranking, and the best seed and heading."""

from geomdrap.sweep.angles import parse_angles
from geomdrap.sweep.case import Case, Job
from geomdrap.sweep.objective import CRITERIA, Objective
from geomdrap.sweep.optimize import Optimum, optimize
from geomdrap.sweep.origins import locate_origins
from geomdrap.sweep.plies import Ply, lay_plies
from geomdrap.sweep.ranking import ranked
from geomdrap.sweep.row import Row
from geomdrap.sweep.run import Sweep, cases_of, run

__all__ = [
    "CRITERIA",
    "Case",
    "Job",
    "Objective",
    "Optimum",
    "Ply",
    "Row",
    "Sweep",
    "cases_of",
    "lay_plies",
    "locate_origins",
    "optimize",
    "parse_angles",
    "ranked",
    "run",
]
