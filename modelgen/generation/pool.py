"""Generating several arms at once, each in a process."""

from __future__ import annotations

import copyreg
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any

from modelgen.description.objects import Arm
from modelgen.errors import InputError
from modelgen.functions import Options
from modelgen.generation.arm import GeneratedArm, generate_arm


def generate_arms(
    arms: Sequence[Arm],
    options: Options,
    processes: int,
    done: Callable[[str], None],
    artefacts: Collection[str] = (),
    identified: Mapping[str, Mapping[str, float]] | None = None,
) -> list[GeneratedArm]:
    """Every arm's files, in the order of the arms; `done` is called with the name of each that is ready.

    identified: values of base parameters by name, by arm; those of the options for the others.
    Raises InputError of the first arm, in that order, that has one.
    """
    values = identified or {}
    by_arm = [replace(options, identified=values.get(a.name, options.identified)) for a in arms]
    workers = min(processes, len(arms))
    results: list[GeneratedArm] = []
    if workers <= 1:
        for arm, own in zip(arms, by_arm, strict=True):
            results.append(generate_arm(arm, own, artefacts))
            done(arm.name)
        return results
    # One arm needs no processes, and is done before they would be loaded.
    from modelgen.jobs import Where, run  # noqa: PLC0415

    # A frozen mapping is pickled by its content.
    copyreg.pickle(MappingProxyType, _by_content)
    made: dict[int, GeneratedArm | InputError] = {}
    jobs = [(arm, own, artefacts) for arm, own in zip(arms, by_arm, strict=True)]
    failed = False
    for k, result in run(_generated, jobs, Where(workers)):
        made[k] = result
        failed = failed or isinstance(result, InputError)
        while not failed and isinstance(ready := made.get(len(results)), GeneratedArm):
            results.append(ready)
            done(ready.name)
    for k in range(len(jobs)):  # in the order of the arms, in which they are told
        if isinstance(error := made[k], InputError):
            raise error
    return results


def _generated(job: tuple[Arm, Options, Collection[str]]) -> GeneratedArm | InputError:
    try:
        return generate_arm(*job)
    except InputError as error:
        return error


def _by_content(mapping: MappingProxyType[Any, Any]) -> tuple[Callable[..., Any], tuple[Any]]:
    return _frozen, (dict(mapping),)


def _frozen(content: dict[Any, Any]) -> MappingProxyType[Any, Any]:
    return MappingProxyType(content)
