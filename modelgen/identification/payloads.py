"""Payloads that an arm carries in some of its records, as the user gives them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from modelgen.dataset import Chosen, Prepared, Record, parse
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.functions.nominal import payload_base
from modelgen.identification.cut_off import without_cut_off
from modelgen.identification.objects import Identification
from modelgen.identification.validation import regression_of
from modelgen.numeric import Array
from modelgen.simulation.values import numbers

CLEARLY = 4.0  # deviations by which a payload is not what was said
NOTABLE = 0.1  # of the payload, which errors of the model may explain


def payloads_of(
    given: Sequence[str] | Mapping[str | int, float | Sequence[float]], logs: Sequence[Any]
) -> dict[int, list[float]]:
    """Mass [kg] and, if wanted, x, y, z [m] by number of the log, training logs first.

    given: LOG=M[,X,Y,Z] each, or logs (by what they were given as, or by number) with their values.
    """
    pairs: list[tuple[str, str | float | Sequence[float], str]]
    if isinstance(given, Mapping):
        pairs = [(str(log), values, f"{log}") for log, values in given.items()]
    else:
        pairs = [(text.rpartition("=")[0], text.rpartition("=")[2], text) for text in given]
    named = [log if isinstance(log, str) else getattr(log, "name", str(k)) for k, log in enumerate(logs)]
    found: dict[int, list[float]] = {}
    for log, values, text in pairs:
        places = [k for k, name in enumerate(named) if log in (name, str(parse(name).path))]
        if isinstance(given, Mapping) and not places and log.isdecimal() and int(log) < len(named):
            places = [int(log)]
        if not log or not places:
            raise InputError(
                f"--payload {text}: expected LOG=KG or LOG=KG,X,Y,Z with one of the logs {', '.join(named)}"
            )
        mass = numbers("--payload", values)
        if not mass or mass[0] <= 0:
            raise InputError(f"--payload {text}: expected a mass above 0 kg")
        found |= dict.fromkeys(places, mass)
    return found


def payload_questions(
    found: Identification,
    train: Sequence[Prepared],
    evaluator: Evaluator,
    payloads: Mapping[int, Sequence[float]],
    logs: Sequence[Any],
) -> list[str]:
    """Questions about known payloads: where they are, and how heavy where the efforts deny them.

    payloads: by number of the log. logs: as they were given, the training logs first. Efforts from which the
    torque constants were found by a payload cannot deny it.
    """
    denied = [] if found.gains else _denied(train, found.model, evaluator, found.solution.theta, payloads)
    points = [log for k, log in enumerate(logs) if len(payloads.get(k, ())) == 1]
    if not points:
        return denied
    names = ", ".join(log if isinstance(log, str) else getattr(log, "name", "a table") for log in points)
    return [
        *denied,
        f"The payload of {names} counts as a point at the origin of the last link's frame: where is it? "
        "--payload LOG=KG,X,Y,Z says so, in metres in that frame.",
    ]


def _denied(
    train: Sequence[Prepared],
    model: Model,
    evaluator: Evaluator,
    theta: Array,
    payloads: Mapping[int, Sequence[float]],
) -> list[str]:
    """Questions about payloads that the efforts deny, set against the other training records.

    Each record may have its payload so many times besides, beside parameters (p,) that all share. theta: for
    columns that depend on the load [base].
    """
    carrying = [k for k in range(len(train)) if k in payloads]
    if len(carrying) == len(train):
        carrying = carrying[1:]  # what all of them carry is a part of the last link
    if not carrying:
        return []
    added = [payload_base(model, payloads.get(k, ())) for k in range(len(train))]
    regression = regression_of(evaluator, model, train, theta, added)
    more = [np.zeros((*columns.shape[:2], len(carrying))) for columns in regression.columns]
    for i, k in enumerate(carrying):
        more[k][:, :, i] = regression.columns[k] @ added[k]
    solution, size = regression.beside(more).solve(), len(theta)
    spread = np.sqrt(np.maximum(np.diag(solution.covariance), 0.0))
    asked = []
    for i, k in enumerate(carrying, size):
        other, std = float(solution.theta[i]), float(spread[i])
        if solution.determined[i] and abs(other) > max(CLEARLY * std, NOTABLE):
            mass, name = payloads[k][0], train[k].record.name
            shown = f"{(1.0 + other) * mass:.3g} ± {std * mass:.1g} kg"
            asked.append(
                f"--payload {name}={mass:g}: beside the other training records its efforts show {shown}. Is "
                "it the right record, the right mass in the right place, and are the torque constants right? "
                "--gains estimated finds these from it."
            )
    return asked


def without_cut_off_by_payload(
    train: Sequence[Record],
    test: Sequence[Record],
    payloads: Mapping[int, Sequence[float]],
    chosen: Chosen,
    arm: Arm,
) -> tuple[list[Record], list[Record]]:
    """The records with the samples named at which efforts are cut off.

    Records with one payload are those of an arm of their own, whose last link is another.
    """
    every = [*train, *test]
    own = [tuple(payloads.get(k, ())) for k in range(len(every))]
    for payload in dict.fromkeys(own[: len(train)]):
        some = [k for k, x in enumerate(own) if x == payload]
        fitted = [k for k in some if k < len(train)]
        parts = without_cut_off(
            [every[k] for k in fitted], [every[k] for k in some[len(fitted) :]], chosen, arm
        )
        for k, record in zip(some, [*parts[0], *parts[1]], strict=True):
            every[k] = record
    return every[: len(train)], every[len(train) :]
