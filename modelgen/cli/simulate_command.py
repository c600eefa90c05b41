"""The options of modelgen simulate."""

from __future__ import annotations

from modelgen.cli import arguments as given
from modelgen.cli.guard import guarded

# ruff: noqa: PLC0415 - the help is quick


@guarded
def simulate(
    arms: given.Arms = None,
    arm: given.OneArm = "",
    q0: given.Begin = "",
    dq0: given.BeginSpeed = "0",
    duration: given.Duration = None,
    rate: given.SampleRate = None,
    lock: given.Lock = None,
    payload: given.Payload = "",
    parameters: given.Parameters = None,
    without: given.Without = "",
    out: given.OptionalFile = None,
    log: given.Logs = None,
    mapping: given.Mapping = None,
    window: given.Window = None,
    control: given.Controller = "",
    reference: given.ReferenceFile = None,
    inputs: given.InputFile = None,
    bandwidth: given.Bandwidth = 5.0,
    method: given.Integrator = "",
    step: given.FixedStep = None,
    plot: given.Plot = None,
    animation: given.Animation = None,
    as_json: given.Json = False,
) -> None:
    """Simulate the model: free, under control, or with the inputs of a log to be held against it."""
    from modelgen.cli.selecting import one, options, with_parameters
    from modelgen.cli.simulating import Request, run
    from modelgen.functions import Options
    from modelgen.functions.options import prepared

    _, found = one(arms, arm)
    found = prepared(found, options(without, given.Gains.KNOWN, False, False, None))
    values = with_parameters(Options(), parameters, [found]).identified or None
    run(
        found,
        values,
        Request(
            q0,
            dq0,
            duration,
            rate,
            lock or [],
            payload,
            out,
            log or [],
            mapping,
            control,
            reference,
            inputs,
            bandwidth,
            method,
            step,
            window,
            plot,
            animation,
            as_json,
        ),
    )
