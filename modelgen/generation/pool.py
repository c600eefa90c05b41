"""Generating several arms at once, each in a process."""

from __future__ import annotations

import copyreg
import signal
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any

from modelgen.description.objects import Arm
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
    results = []
    if workers <= 1:
        for arm, own in zip(arms, by_arm, strict=True):
            results.append(generate_arm(arm, own, artefacts))
            done(arm.name)
        return results
    # One arm needs no processes, and is done before they would be loaded.
    import multiprocessing  # noqa: PLC0415
    from concurrent.futures import ProcessPoolExecutor  # noqa: PLC0415

    # A frozen mapping is pickled by its content.
    copyreg.pickle(MappingProxyType, _by_content)
    # Forked from a clean server where that exists: a fork of this process would inherit its threads' locks.
    methods = multiprocessing.get_all_start_methods()
    context = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
    if hasattr(context, "set_forkserver_preload"):
        context.set_forkserver_preload([__name__])
    with ProcessPoolExecutor(workers, mp_context=context, initializer=_ignore_interrupt) as pool:
        futures = [
            pool.submit(generate_arm, arm, own, artefacts) for arm, own in zip(arms, by_arm, strict=True)
        ]
        try:
            for arm, future in zip(arms, futures, strict=True):
                results.append(future.result())
                done(arm.name)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return results


def _by_content(mapping: MappingProxyType[Any, Any]) -> tuple[Callable[..., Any], tuple[Any]]:
    return _frozen, (dict(mapping),)


def _frozen(content: dict[Any, Any]) -> MappingProxyType[Any, Any]:
    return MappingProxyType(content)


def _ignore_interrupt() -> None:
    """Ctrl-C reaches the whole group; the parent process answers for all."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
