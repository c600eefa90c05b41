"""The commands, one file each."""

from modelgen.cli.commands.calibrate import calibrate
from modelgen.cli.commands.cmake_dir import cmake_dir
from modelgen.cli.commands.diagnose import diagnose
from modelgen.cli.commands.draw import draw
from modelgen.cli.commands.effects import effects
from modelgen.cli.commands.excite import excite
from modelgen.cli.commands.export import export
from modelgen.cli.commands.fleet import fleet
from modelgen.cli.commands.generate import generate
from modelgen.cli.commands.identify import identify
from modelgen.cli.commands.import_ import import_
from modelgen.cli.commands.init import init
from modelgen.cli.commands.inspect import inspect
from modelgen.cli.commands.refine import refine
from modelgen.cli.commands.schema import schema
from modelgen.cli.commands.show import show
from modelgen.cli.commands.simulate import simulate

__all__ = [
    "calibrate",
    "cmake_dir",
    "diagnose",
    "draw",
    "effects",
    "excite",
    "export",
    "fleet",
    "generate",
    "identify",
    "import_",
    "init",
    "inspect",
    "refine",
    "schema",
    "show",
    "simulate",
]
