"""The commands and their options. What a command needs is imported when it is called: the help is quick."""

from __future__ import annotations

from pathlib import Path

import typer

from modelgen import __version__
from modelgen.cli import arguments as given
from modelgen.cli.fleet_command import fleet
from modelgen.cli.guard import guarded
from modelgen.cli.identify_command import identify
from modelgen.cli.refine_command import refine
from modelgen.cli.simulate_command import simulate

# ruff: noqa: PLC0415 - see above

app = typer.Typer(
    name="modelgen",
    help="From the YAML description of a robot arm to its dynamic model in C99, CasADi and NumPy.",
    epilog="Exit status: 0 done, 1 a check failed, 2 bad input. Messages go to stderr, data to stdout.",
    add_completion=False,
    # A traceback that Python prints itself can be copied into a report.
    pretty_exceptions_enable=False,
)


@app.callback(invoke_without_command=True)
def _common(context: typer.Context, version: given.Version = False) -> None:
    if version:
        typer.echo(f"modelgen {__version__}")
        raise typer.Exit
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())
        raise typer.Exit


@app.command()
@guarded
def generate(
    arms: given.Arms = None,
    arm: given.OnlyArms = None,
    out: given.OutFolder = Path("generated"),
    check: given.Check = False,
    without: given.Without = "",
    gains: given.DriveGains = given.Gains.KNOWN,
    runtime_geometry: given.RuntimeGeometry = False,
    sincos_inputs: given.SinCos = False,
    jacobian_link: given.JacobianLink = None,
    casadi: given.Serialised = False,
    casadi_plant: given.Plant = False,
    max_flash: given.MaxFlash = None,
    max_stack: given.MaxStack = None,
    target: given.Target = "cortex-m4f",
    jobs: given.Jobs = None,
    parameters: given.Parameters = None,
    as_json: given.Json = False,
) -> None:
    """Write C99 and CasADi functions of every arm, with identified parameters folded in where given."""
    from modelgen.cli.generating import budget_of, run
    from modelgen.cli.selecting import beside, options, selected, with_parameters

    chosen = options(without, gains, runtime_geometry, sincos_inputs, jacobian_link)
    budget = budget_of(target, max_flash, max_stack)
    file, found = selected(arms, arm or [])
    own = beside(Path(file), found, chosen) if parameters is None else {}
    chosen = with_parameters(chosen, parameters, found)
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
        identified=own,
    )


@app.command()
@guarded
def show(
    arms: given.Arms = None,
    arm: given.OneArm = "",
    without: given.Without = "",
    gains: given.DriveGains = given.Gains.KNOWN,
    runtime_geometry: given.RuntimeGeometry = False,
    sincos_inputs: given.SinCos = False,
    jacobian_link: given.JacobianLink = None,
    as_json: given.Json = False,
) -> None:
    """Print base parameters, their grouping, and what the functions cost."""
    from modelgen.cli.selecting import one, options
    from modelgen.cli.showing import run

    chosen = options(without, gains, runtime_geometry, sincos_inputs, jacobian_link)
    _, found = one(arms, arm)
    run(found, chosen, as_json=as_json)


app.command()(identify)


@app.command()
@guarded
def diagnose(
    train: given.Train,
    out: given.Folder,
    test: given.DiagnosisTest = None,
    arms: given.Arms = None,
    arm: given.OneArm = "",
    mapping: given.Mapping = None,
    cutoff: given.CutOff = None,
    period: given.Period = None,
    effect: given.AskedEffects = None,
    no_experiment: given.NoExperiment = False,
    jobs: given.Jobs = None,
    as_json: given.Json = False,
) -> None:
    """Name what the model gets wrong in logs, extend it by the cause, and measure the gain."""
    from modelgen.cli.selecting import one
    from modelgen.report.figures import Pen

    file, found = one(arms, arm)
    with Pen(hands=0 if jobs == 1 else 2) as pen:  # it gets ready while the rest is loaded
        from modelgen.cli.diagnosing import run

        run(
            Path(file),
            found,
            train,
            test or [],
            out,
            mapping=mapping,
            cutoff=cutoff,
            period=period,
            effects=effect or [],
            experiment=not no_experiment,
            jobs=jobs,
            as_json=as_json,
            pen=pen,
        )


app.command()(simulate)
app.command()(refine)
app.command()(fleet)


@app.command()
@guarded
def excite(
    arms: given.Arms = None,
    arm: given.OneArm = "",
    out: given.TrajectoryFile = Path("trajectory.csv"),
    period: given.ExcitationPeriod = 80.0,
    harmonics: given.Harmonics = 5,
    rate: given.Rate = 10.0,
    criterion: given.Criterion = "cond",
    coordinates: given.Coordinates = "motor",
    starts: given.Starts = 8,
    seed: given.Seed = 0,
    rest: given.Rest = False,
    velocity: given.AssumedVelocity = None,
    acceleration: given.AssumedAcceleration = None,
    box: given.Boxes = None,
    iterations: given.Iterations = 150,
    jobs: given.Jobs = None,
    dask: given.Dask = None,
    as_json: given.Json = False,
) -> None:
    """Compute a trajectory that determines the base parameters well, within the arm's limits."""
    from modelgen.cli.exciting import run
    from modelgen.cli.selecting import one
    from modelgen.excitation import Settings
    from modelgen.excitation import box as parsed

    settings = Settings(
        period=period,
        harmonics=harmonics,
        rate=rate,
        criterion=criterion,
        coordinates=coordinates,
        starts=starts,
        seed=seed,
        rest=rest,
        velocity=velocity,
        acceleration=acceleration,
        boxes=tuple(parsed(text) for text in box or []),
        iterations=iterations,
        processes=jobs,
        dask=dask,
    )
    _, found = one(arms, arm)
    run(found, settings, out, as_json=as_json)


@app.command()
@guarded
def calibrate(
    files: given.ArmsAndLog,
    joint: given.LeverJoint,
    arm: given.OneArm = "",
    out: given.Folder = Path("calibration"),
    length_std: given.LengthStd = 0.01,
    as_json: given.Json = False,
) -> None:
    """Fit a lever's geometry to motor counts and measured joint angles."""
    from modelgen.cli.calibrating import run
    from modelgen.cli.selecting import one
    from modelgen.errors import InputError

    if len(files) > 2:
        raise InputError(f"found {len(files)} files ({', '.join(files)}), expected [ARMS] LOG")
    file, found = one(Path(files[0]) if len(files) == 2 else None, arm)
    run(Path(file), found, joint, files[-1], out, length_std=length_std, as_json=as_json)


@app.command()
@guarded
def effects(as_json: given.Json = False, pages: given.Pages = None) -> None:
    """Print the catalogue of effects: names, parameters, units, bounds."""
    from modelgen.cli.catalogue import run, write_pages

    if pages is not None:
        from modelgen.report.catalogue import pages as made

        write_pages(pages, made())
    else:
        run(as_json=as_json)


@app.command()
@guarded
def schema(of_mapping: given.OfMapping = False, of_fleet: given.OfFleet = False) -> None:
    """Print a JSON Schema of the description, of a mapping file or of a fleet, for editors."""
    import json

    if of_fleet:
        from modelgen.fleet.schema import fleet_json_schema

        typer.echo(json.dumps(fleet_json_schema(), indent=2))
        return
    if of_mapping:
        from modelgen.dataset.mapping.schema import mapping_json_schema

        typer.echo(json.dumps(mapping_json_schema(), indent=2))
        return
    from modelgen.description import json_schema
    from modelgen.effects import known_effects

    typer.echo(json.dumps(json_schema(known_effects()), indent=2))


@app.command()
@guarded
def init(
    name: given.NewName,
    out: given.OutFile = Path("arms.yaml"),
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
