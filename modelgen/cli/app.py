"""The commands and their options. What a command needs is imported when it is called: the help is quick."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from modelgen import __version__
from modelgen.cli.guard import guarded

# ruff: noqa: PLC0415 - see above

app = typer.Typer(
    name="modelgen",
    help="From the YAML description of a robot arm to its dynamic model in C99, CasADi and NumPy.",
    epilog="Exit status: 0 done, 1 a check failed, 2 bad input. Messages go to stderr, data to stdout.",
    add_completion=False,
    # A traceback that Python prints itself can be copied into a report.
    pretty_exceptions_enable=False,
)


class Gains(StrEnum):
    """How the drive gains enter the model."""

    KNOWN = "known"
    ESTIMATED = "estimated"
    ROW_WISE = "row_wise"


Arms = Annotated[
    Path | None,
    typer.Argument(
        metavar="ARMS",
        help="Description in YAML. Default: arms.yaml here, else the shipped arms.",
        show_default=False,
    ),
]
Without = Annotated[
    str,
    typer.Option(
        metavar="PARTS", help="Leave out drives, effects or both: drives,effects.", show_default=False
    ),
]
DriveGains = Annotated[Gains, typer.Option(help="Drive gains: known, estimated, or scaled row by row.")]
RuntimeGeometry = Annotated[
    bool, typer.Option("--runtime-geometry", help="Lever geometry, offsets and symbols become an input.")
]
SinCos = Annotated[
    bool, typer.Option("--sincos-inputs", help="Sines and cosines of the joint angles become inputs.")
]
JacobianLink = Annotated[
    str | None,
    typer.Option(
        metavar="LINK", help="Link that the Jacobian belongs to. Default: the last.", show_default=False
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print machine-readable data.")]
Train = Annotated[
    list[str], typer.Option(metavar="LOG", help="A training record, FILE or FILE@t0:t1 [s]; repeatable.")
]
Test = Annotated[
    list[str], typer.Option(metavar="LOG", help="The record that nothing but the final errors looks at.")
]
Folder = Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder to write into.")]
Mapping = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Mapping file of a foreign log.", show_default=False),
]
CutOff = Annotated[
    float | None,
    typer.Option(metavar="HZ", help="Low-pass of effort and regressor.", show_default=False),
]
Period = Annotated[
    float | None,
    typer.Option(metavar="S", help="Period of the excitation, found by itself else.", show_default=False),
]
Pages = Annotated[
    Path | None,
    typer.Option(metavar="DIR", help="Write effects.md with a picture of each there.", show_default=False),
]
OnlyArms = Annotated[
    list[str] | None, typer.Option(metavar="NAME", help="Only this arm; repeatable.", show_default=False)
]
OneArm = Annotated[str, typer.Option(metavar="NAME", help="The arm.", show_default=False)]
OutFolder = Annotated[Path, typer.Option(metavar="DIR", help="Folder that gets one folder per arm.")]
OutFile = Annotated[Path, typer.Option(metavar="FILE", help="File to write; it must not exist.")]
Check = Annotated[bool, typer.Option("--check", help="Write nothing; exit 1 where DIR differs.")]
Serialised = Annotated[
    bool, typer.Option("--casadi", help="Also write the CasADi functions serialised: <arm>/casadi/.")
]
Plant = Annotated[
    bool, typer.Option("--casadi-plant", help="Also write the C plant for casadi.external: <arm>/plant/.")
]
MaxFlash = Annotated[
    int | None,
    typer.Option(metavar="BYTES", min=1, help="Most flash that a function may take.", show_default=False),
]
MaxStack = Annotated[
    int | None,
    typer.Option(metavar="BYTES", min=1, help="Most stack that a function may take.", show_default=False),
]
Target = Annotated[
    str, typer.Option(metavar="NAME", help="Whose compiler measures them: cortex-m4f, cortex-m7, host.")
]
Jobs = Annotated[
    int | None,
    typer.Option(
        "-j", "--jobs", metavar="N", min=1, help="Processes. Default: one per processor.", show_default=False
    ),
]
NewName = Annotated[str, typer.Argument(help="Name of the arm, a C identifier.", show_default=False)]
Version = Annotated[bool, typer.Option("--version", help="Print the version and exit.", is_eager=True)]


OfMapping = Annotated[
    bool, typer.Option("--mapping", help="Of the files that say what the columns of a foreign log are.")
]


@app.callback(invoke_without_command=True)
def _common(context: typer.Context, version: Version = False) -> None:
    if version:
        typer.echo(f"modelgen {__version__}")
        raise typer.Exit
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())
        raise typer.Exit


@app.command()
@guarded
def generate(
    arms: Arms = None,
    arm: OnlyArms = None,
    out: OutFolder = Path("generated"),
    check: Check = False,
    without: Without = "",
    gains: DriveGains = Gains.KNOWN,
    runtime_geometry: RuntimeGeometry = False,
    sincos_inputs: SinCos = False,
    jacobian_link: JacobianLink = None,
    casadi: Serialised = False,
    casadi_plant: Plant = False,
    max_flash: MaxFlash = None,
    max_stack: MaxStack = None,
    target: Target = "cortex-m4f",
    jobs: Jobs = None,
    as_json: Json = False,
) -> None:
    """Write C99 and CasADi functions of every arm."""
    from modelgen.cli.generating import budget_of, run
    from modelgen.cli.selecting import options, selected

    chosen = options(without, gains, runtime_geometry, sincos_inputs, jacobian_link)
    budget = budget_of(target, max_flash, max_stack)
    file, found = selected(arms, arm or [])
    artefacts = [name for name, asked in (("casadi", casadi), ("plant", casadi_plant)) if asked]
    run(
        found,
        file,
        chosen,
        out,
        check=check,
        artefacts=artefacts,
        budget=budget,
        processes=jobs,
        as_json=as_json,
    )


@app.command()
@guarded
def show(
    arm: OneArm,
    arms: Arms = None,
    without: Without = "",
    gains: DriveGains = Gains.KNOWN,
    runtime_geometry: RuntimeGeometry = False,
    sincos_inputs: SinCos = False,
    jacobian_link: JacobianLink = None,
    as_json: Json = False,
) -> None:
    """Print base parameters, their grouping, and what the functions cost."""
    from modelgen.cli.selecting import options, selected
    from modelgen.cli.showing import run

    chosen = options(without, gains, runtime_geometry, sincos_inputs, jacobian_link)
    _, (found,) = selected(arms, [arm])
    run(found, chosen, as_json=as_json)


@app.command()
@guarded
def diagnose(
    arm: OneArm,
    train: Train,
    test: Test,
    out: Folder,
    arms: Arms = None,
    mapping: Mapping = None,
    cutoff: CutOff = None,
    period: Period = None,
    as_json: Json = False,
) -> None:
    """Name what the model gets wrong in logs, extend it by the cause, and measure the gain."""
    from modelgen.cli.diagnosing import run
    from modelgen.cli.selecting import selected

    file, (found,) = selected(arms, [arm])
    run(
        Path(file),
        found,
        train,
        test,
        out,
        mapping=mapping,
        cutoff=cutoff,
        period=period,
        as_json=as_json,
    )


@app.command()
@guarded
def effects(as_json: Json = False, pages: Pages = None) -> None:
    """Print the catalogue of effects: names, parameters, units, bounds."""
    from modelgen.cli.catalogue import run, write_pages

    if pages is not None:
        from modelgen.report.signatures import pages as made

        write_pages(pages, made())
    else:
        run(as_json=as_json)


@app.command()
@guarded
def schema(of_mapping: OfMapping = False) -> None:
    """Print a JSON Schema of the description, or of a mapping file, for editors."""
    import json

    if of_mapping:
        from modelgen.dataset.mapping_schema import mapping_json_schema

        typer.echo(json.dumps(mapping_json_schema(), indent=2))
        return
    from modelgen.description import json_schema
    from modelgen.effects import known_effects

    typer.echo(json.dumps(json_schema(known_effects()), indent=2))


@app.command()
@guarded
def init(
    name: NewName,
    out: OutFile = Path("arms.yaml"),
) -> None:
    """Write a commented description that generates as it stands."""
    from modelgen.cli.starting import run

    run(name, out)


@app.command()
@guarded
def cmake_dir() -> None:
    """Print the folder of ModelgenGenerate.cmake, which generates at build time."""
    from modelgen.resources import cmake_folder

    typer.echo(cmake_folder())


def main() -> None:
    """Entry of the command `modelgen`. Ends the process with its exit status."""
    app(prog_name="modelgen")
