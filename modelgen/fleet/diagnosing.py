"""The diagnosis of one unit, as a job: whatever happens, it ends with a row."""

from __future__ import annotations

import time
import traceback
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from modelgen.api.description import load_arms
from modelgen.api.diagnosis import Diagnosis, diagnose
from modelgen.description import Arm
from modelgen.diagnosis.result import rounded
from modelgen.effects.placement import titled
from modelgen.errors import InputError, suggest
from modelgen.fleet.store import Row, fingerprint, folder, keep, written
from modelgen.fleet.units import Unit
from modelgen.options import DiagnosisOptions
from modelgen.report.diagnosis_sentences import cause_title, doubted, harmful, worth
from modelgen.report.following import Step, following
from modelgen.report.words import sentence
from modelgen.report.writing import write

CRASHED = "the process ended: out of memory, or a crash"


@dataclass(frozen=True)
class Job:
    """A unit, the fleet's folder, and whether the extended model's code is wanted. called: the folder as it
    was given, which the commands of the unit's page name.
    """

    unit: Unit
    out: str
    code: bool = False
    called: str = ""


def done(job: Job) -> Row:
    """Diagnose a unit and keep what was found, a failure too. Its row."""
    unit, begin, cpu = job.unit, time.perf_counter(), time.process_time()
    row = blank(unit)
    with written(Path(job.out), unit.name) as new:
        made_of: str | None = None
        try:
            made_of = fingerprint(unit)
            d = _diagnosed(unit)
            called = folder(Path(job.called or job.out), unit.name)
            write(d.found, new, code=job.code, called=called, call=d.call)
            row |= _found(d) | _next(d, called)
            row["report"] = f"units/{unit.name}/report.html"
        except InputError as error:
            row["error"] = _short(str(error), unit)
        except Exception as error:  # a mistake of ours must not stop the others; it keeps its traceback
            made_of = None
            row["error"] = f"a mistake in modelgen: {type(error).__name__}: {_short(str(error), unit)}"
            (new / "traceback.txt").write_text(traceback.format_exc(), encoding="utf-8")
        row["seconds"] = round(time.perf_counter() - begin, 3)
        row["cpu_seconds"] = round(time.process_time() - cpu, 3)
        keep(new, row, made_of)
    return row


def crashed(job: Job) -> Row:
    """Keep that a unit has ended its process. Its row."""
    row = blank(job.unit) | {"error": CRASHED}
    with written(Path(job.out), job.unit.name) as new:
        keep(new, row, None)
    return row


def blank(unit: Unit) -> Row:
    """A row that says nothing but what was asked."""
    return {"unit": unit.name, "arm": unit.arm, "train": list(unit.train), "test": list(unit.test)}


def _diagnosed(unit: Unit) -> Diagnosis:
    mapping = None if unit.mapping is None else unit.path(unit.mapping)
    train, test = ([unit.path(spec) for spec in specs] for specs in (unit.train, unit.test))
    options = DiagnosisOptions(mapping=mapping, cutoff=unit.cutoff, period=unit.period, processes=1)
    return diagnose(_arm(unit), train, test, options)


def _arm(unit: Unit) -> Arm:
    arms = load_arms(unit.path(unit.description))
    if unit.arm is None:
        if len(arms) != 1:
            raise InputError(
                f"{unit.description}: found {len(arms)} arms, expected the key 'arm' with one of them"
                f"{suggest('', arms)}"
            )
        return next(iter(arms.values()))
    if unit.arm not in arms:
        raise InputError(f"{unit.description}: found no arm '{unit.arm}'{suggest(unit.arm, arms)}")
    return arms[unit.arm]


def _short(message: str, unit: Unit) -> str:
    """One line, with paths as the fleet's file has them, and its words for what is an option of a command."""
    there = message.replace("(--mapping)", "(`mapping` of the unit)")
    return " ".join(there.replace(unit.base.rstrip("/\\") + "/", "").split())


def _found(d: Diagnosis) -> Row:
    """A diagnosis as a flat row: lists by cause, by joint, by parameter."""
    said = d.to_json()
    fit, error = said["lack_of_fit"], said["error"]
    gains = [g for g in error["gain_percent"] if g is not None]
    worse = harmful(d.found)
    return {
        "arm": said["arm"],
        "begins": [x.begins for x in d.found.log.recorded()],
        "verdict": said["verdict"],
        "reason": said["reason"],
        "causes": [c["effect"] for c in said["causes"]],
        "joints": [c["joint"] for c in said["causes"]],
        "joint_names": [c["joint_name"] for c in said["causes"]],
        "titles": [cause_title(d.found, c) for c in d.found.causes],
        "suspects": [cause_title(d.found, c) for c in d.found.suspects],
        "failed_checks": [
            [x.name for x in c.checks if x.decides and x.passed is False] for c in d.found.suspects
        ],
        "worth": sentence(worth(d.found)) if said["causes"] else None,
        "doubts": doubted(d.found) if said["causes"] else [],
        "harms": [c in worse for c in d.found.causes],
        "delta_bic": [c["evidence"]["delta_bic"] for c in said["causes"]],
        "cross_gain_percent": [c["evidence"]["cross_gain_percent"] for c in said["causes"]],
        "ambiguous_with": [_places(d.arm, c["ambiguous_with"]) for c in said["causes"]],
        "aliases": [_places(d.arm, c["aliases"]) for c in said["causes"]],
        "cause_parameters": [
            {"cause": c["effect"], "joint": c["joint"], "name": name}
            | {key: value[key] for key in ("value", "std", "unit")}
            for c in said["causes"]
            for name, value in c["parameters"].items()
        ],
        "lack_of_fit": None if fit is None else fit["statistic"],
        "lack_of_fit_threshold": None if fit is None else fit["threshold"],
        "error_unit": error["unit"],
        "error_before": error["before"],
        "error_after": error["after"],
        "gain_percent": error["gain_percent"],
        "best_gain_percent": max(gains) if gains and said["causes"] else None,
        "overall_gain_percent": error["overall_gain_percent"],
        "overall_gain_interval_percent": error["overall_gain_interval_percent"],
        "parameters": [
            {"name": name, "value": rounded(e.value), "std": rounded(e.std), "unit": e.unit}
            for name, e in d.parameters.items()
        ],
        "not_identifiable": [
            n["effect"]
            for n in said["not_identifiable"]
            if not any(n["effect"] == c["effect"] for c in said["causes"])
        ],
    }


def _next(d: Diagnosis, called: Path) -> Row:
    """What to do first after a diagnosis, and the command for it. called: its folder, which that names."""
    steps = following(d.found, replace(d.call, folder=called))
    step = next((s for s in steps if s.command), steps[0] if steps else Step(""))
    return {"next": step.text, "command": step.command}


def _places(arm: Arm, causes: list[dict[str, Any]]) -> list[str]:
    return [titled(arm, c["effect"], c["joint"]) for c in causes]
