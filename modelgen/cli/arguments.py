"""The options of the commands, each written once."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer


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
DiagnosisTest = Annotated[
    list[str] | None, typer.Option("--test", metavar="LOG", help="The record for the final errors alone.")
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
Preset = Annotated[
    str, typer.Option(metavar="NAME", help="Processing: default, paper or paper_parallel, see docs/logs.md.")
]
Period = Annotated[
    float | None,
    typer.Option(metavar="S", help="Period of the excitation, found by itself else.", show_default=False),
]
AskedEffects = Annotated[
    list[str] | None,
    typer.Option(
        "--effect", metavar="NAME[:JOINT]", help="Ask for this effect alone; repeatable.", show_default=False
    ),
]
NoExperiment = Annotated[
    bool,
    typer.Option("--no-experiment", help="Do not look for what tells rivalling causes apart."),
]
OptionalTest = Annotated[
    list[str] | None,
    typer.Option("--test", metavar="LOG", help="A record not fitted; repeatable.", show_default=False),
]
Method = Annotated[
    str,
    typer.Option(
        metavar="NAME",
        help="ols, wls (weights by joint), gls (noise that joints share), robust, iv (noisy positions).",
    ),
]
Streamed = Annotated[
    bool, typer.Option("--stream", help="Read block by block, as logs above 512 MB always are.")
]
Consistent = Annotated[
    bool, typer.Option("--consistent", help="The closest parameters of links that could exist.")
]
Parameters = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="<arm>_parameters.yaml of modelgen identify.", show_default=False),
]
Pages = Annotated[
    Path | None,
    typer.Option(metavar="DIR", help="Write effects.md with a picture of each there.", show_default=False),
]
OnlyArms = Annotated[
    list[str] | None, typer.Option(metavar="NAME", help="Only this arm; repeatable.", show_default=False)
]
OneArm = Annotated[
    str,
    typer.Option("--arm", metavar="NAME", help="The arm; not needed where there is one.", show_default=False),
]
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
Dask = Annotated[
    str | None,
    typer.Option(
        "--dask",
        metavar="ADDRESS",
        help="Scheduler of a Dask cluster that has the work: tcp://host:8786.",
        show_default=False,
    ),
]
TrajectoryFile = Annotated[
    Path, typer.Option("--out", metavar="FILE", help="Table to write; its companions lie beside it.")
]
ExcitationPeriod = Annotated[float, typer.Option(metavar="S", help="Period of the trajectory.")]
Harmonics = Annotated[int, typer.Option(metavar="N", help="Harmonics of 1/period.")]
Rate = Annotated[float, typer.Option(metavar="HZ", help="Samples per second.")]
Criterion = Annotated[str, typer.Option(metavar="NAME", help="cond or d_optimal.")]
Coordinates = Annotated[
    str, typer.Option(metavar="NAME", help="motor or joint: what the Fourier series gives.")
]
Starts = Annotated[int, typer.Option(metavar="N", help="Random starts, in parallel.")]
Seed = Annotated[int, typer.Option(metavar="N", min=0, help="Of the random starts.")]
Rest = Annotated[bool, typer.Option("--rest", help="Start and end with zero speed and acceleration.")]
AssumedVelocity = Annotated[
    float | None,
    typer.Option(metavar="V", help="Speed limit of joints without one, rad/s or m/s.", show_default=False),
]
AssumedAcceleration = Annotated[
    float | None,
    typer.Option(metavar="A", help="Likewise the acceleration, rad/s2 or m/s2.", show_default=False),
]
Boxes = Annotated[
    list[str] | None,
    typer.Option(
        metavar="BOX",
        help="LINK=x0:x1,y0:y1,z0:z1 in m, where the origin of its frame must stay; repeatable.",
        show_default=False,
    ),
]
Iterations = Annotated[int, typer.Option(metavar="N", min=1, help="Most iterations of one start.")]
LeverJoint = Annotated[int, typer.Option(metavar="J", help="The joint, counted from 1.", show_default=False)]
ArmsAndLog = Annotated[
    list[str],
    typer.Argument(
        metavar="[ARMS] LOG",
        help="The description, and the log with t, qm<J> and the measured q<J> in rad.",
        show_default=False,
    ),
]
LengthStd = Annotated[
    float, typer.Option(metavar="M", help="How well the lengths of the description are known.")
]
NewName = Annotated[str, typer.Argument(help="Name of the arm, a C identifier.", show_default=False)]
Version = Annotated[bool, typer.Option("--version", help="Print the version and exit.", is_eager=True)]
OfMapping = Annotated[
    bool, typer.Option("--mapping", help="Of the files that say what the columns of a foreign log are.")
]
OfFleet = Annotated[bool, typer.Option("--fleet", help="Of the files that list the arms of a fleet.")]
Begin = Annotated[
    str,
    typer.Option(
        metavar="Q", help='Initial positions: "20 deg", or one by joint: "0.1, 20 deg".', show_default=False
    ),
]
BeginSpeed = Annotated[
    str, typer.Option(metavar="DQ", help="Initial velocities, likewise, per second.", show_default=False)
]
Duration = Annotated[float | None, typer.Option(metavar="S", help="Length.", show_default=False)]
SampleRate = Annotated[
    float | None, typer.Option(metavar="HZ", help="Samples per second. Default: 1000.", show_default=False)
]
Lock = Annotated[
    list[str] | None,
    typer.Option(metavar="JOINT=Q", help="Hold a joint, j2=0 say; repeatable.", show_default=False),
]
Payload = Annotated[
    str,
    typer.Option(
        metavar="M[,X,Y,Z]", help="Point mass at the last link [kg], in its frame [m].", show_default=False
    ),
]
OptionalFile = Annotated[
    Path | None, typer.Option("--out", metavar="FILE", help="CSV to write: t, q, dq.", show_default=False)
]
Logs = Annotated[
    list[str] | None,
    typer.Option(
        "--log",
        metavar="LOG",
        help="Measured log, FILE or FILE@t0:t1, to be held against; repeatable for repeated runs.",
        show_default=False,
    ),
]
InputFile = Annotated[
    Path | None,
    typer.Option(
        "--input", metavar="FILE", help="CSV with t and i<n> (tau<n> where undriven).", show_default=False
    ),
]
Controller = Annotated[
    str,
    typer.Option(
        "--control",
        metavar="NAME",
        help="pi (cascade) or computed_torque, after --reference or the log.",
        show_default=False,
    ),
]
ReferenceFile = Annotated[
    Path | None,
    typer.Option("--reference", metavar="FILE", help="CSV with t and q<n> to follow.", show_default=False),
]
Bandwidth = Annotated[float, typer.Option(metavar="HZ", help="Of the controller.")]
Integrator = Annotated[
    str,
    typer.Option(
        "--method",
        metavar="NAME",
        help="fixed (compiled C), cvodes, DOP853, RK45, LSODA, Radau or BDF.",
        show_default=False,
    ),
]
FixedStep = Annotated[
    float | None, typer.Option("--step", metavar="S", help="Longest fixed step.", show_default=False)
]
Window = Annotated[
    float | None,
    typer.Option(metavar="S", help="Start again from the measured state after so long.", show_default=False),
]
Plot = Annotated[Path | None, typer.Option(metavar="FILE", help="Picture, SVG.", show_default=False)]
Animation = Annotated[
    Path | None, typer.Option(metavar="FILE", help="The moving arm, one HTML file.", show_default=False)
]
