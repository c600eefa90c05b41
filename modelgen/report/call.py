"""How a result was asked for, and the commands that follow on it, to be copied as they are."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from os import PathLike, fspath
from pathlib import Path
from typing import Any

import numpy as np

from modelgen.dataset import parse
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.excitation.limits import bounds
from modelgen.options import ExcitationOptions, words_of
from modelgen.resources import shipped_arms

# Where the commands of a page run.
WHERE = "in the folder in which modelgen was called"
_USUAL = "arms.yaml"


@dataclass(frozen=True)
class Call:
    """How a result was asked for.

    arm: as described. train, test: records as given, FILE or FILE@t0:t1; none where one of them is no file.
    options: of the call. folder: where the results are written, as given.
    """

    arm: Arm
    train: tuple[str, ...] = ()
    test: tuple[str, ...] = ()
    options: Any = None
    folder: Path = field(default_factory=Path)

    @property
    def description(self) -> str:
        """Path of the arm's description; empty where modelgen finds it without."""
        where = self.arm.where
        if where is None or not Path(where.file).is_file():
            return _USUAL
        return "" if Path(where.file) == shipped_arms() else where.file

    @property
    def first(self) -> str:
        """What is to be done before a command can run, as the begin of a sentence; empty where nothing is."""
        where = self.arm.where
        if where is not None and Path(where.file).is_file():
            return ""
        return f"Write the description of the arm, which no file has, into {_USUAL}. "

    def beside(self, name: str) -> str:
        """Path of a file that is written together with the page."""
        return str(self.folder / name)

    def command(self, name: str, *words: str, description: str | None = None) -> str:
        """A command for the arm, of this or another description. words: its options."""
        path = self.description if description is None else description
        return command(name, path, self.arm.name, *words)

    def diagnosing(self) -> str:
        """The command that names what the model lacks; empty where there is no pair of records for it."""
        if not self.train or not self.test:
            return ""
        records = [*_repeated("--train", self.train), "--test", self.test[0]]
        return self.command("diagnose", *records, *self.kept(), "--out", self.beside("diagnosis"))

    def identifying(
        self, out: str, description: str, cutoff: float | None = None, *, consistent: bool = False
    ) -> str:
        """The command that fits a description to the same records in a band [Hz], by default its own; empty
        where they are no files. consistent: with links that could exist.
        """
        logs = self.train or self.test
        if not logs:
            return ""
        records = _repeated("--train", logs)
        records += _repeated("--test", self.test) if self.train else []
        kept = words_of(self.options, ("mapping", "period"))
        kept += [] if cutoff is None else ["--cutoff", f"{cutoff:.6g}"]
        kept += ["--consistent"] if consistent else []
        return self.command("identify", *records, *kept, "--out", self.beside(out), description=description)

    def by_instruments(self, description: str | None = None) -> str:
        """The command that fits the same records by instrumental variables; empty where they are no files."""
        if not self.train:
            return ""
        records = [*_repeated("--train", self.train), *_repeated("--test", self.test), "--method", "iv"]
        kept = words_of(self.options, ("mapping", "period", "cutoff", "without"))
        out = self.beside("by_instruments")
        return self.command("identify", *records, *kept, "--out", out, description=description)

    def refining(self, out: str, description: str) -> str:
        """The command that tunes a description on the training records' motion; empty where they are no
        files.
        """
        if not self.train:
            return ""
        kept = [*_repeated("--log", self.train), *words_of(self.options, ("mapping",))]
        return self.command("refine", *kept, "--out", self.beside(out), description=description)

    def refining_again(self, out: str, window: float) -> str:
        """The command of a refinement with another window [s]; empty where its logs are no files."""
        if not self.train:
            return ""
        kept = words_of(self.options, ("mapping", "parameters", "free"))
        words = [*_repeated("--log", self.train), *kept, "--window", f"{window:g}"]
        return self.command("refine", *words, "--out", self.beside(out))

    def exciting(self, out: str, speeds: Sequence[float] = (), description: str | None = None) -> str:
        """The command for a motion that determines the parameters; empty where the arm lacks limits.

        speeds: the largest (n,) that records have [rad/s, m/s]: the limit of joints without one.
        """
        options = _limits(self.arm, speeds)
        if options is None:
            return ""
        return self.command("excite", *options, "--out", out, description=description)

    def kept(self) -> list[str]:
        """Options of the call that a diagnosis of its records has too."""
        if getattr(self.options, "preset", "default") != "default":
            return words_of(self.options, ("mapping",))
        return words_of(self.options, ("mapping", "cutoff", "period"))


def command(name: str, path: Path | str | None, arm: str, *words: str) -> str:
    """A command of modelgen for an arm of a description, to be typed as it stands. words: further ones."""
    named = ["--arm", arm] if arm else []
    return shlex.join(["modelgen", name, *([str(path)] if path else []), *named, *words])


def given(arm: Arm, train: Sequence[Any], test: Sequence[Any], options: Any) -> Call:
    """How a result was asked for, with its logs as they were given; without them where one is no file."""
    every = [*train, *test]
    if not all(isinstance(log, str | PathLike) for log in every) or not files_of(map(fspath, every)):
        return Call(arm, options=options)
    return Call(arm, tuple(map(fspath, train)), tuple(map(fspath, test)), options)


def files_of(names: Iterable[str]) -> tuple[str, ...]:
    """Records by their names; none where one of them is no file."""
    every = tuple(names)
    return every if all(parse(name).path.exists() for name in every) else ()


def _repeated(option: str, values: Iterable[str]) -> list[str]:
    return [word for value in values for word in (option, value)]


def _limits(arm: Arm, speeds: Sequence[float]) -> list[str] | None:
    """Options by which `excite` has every limit that it needs; None where options give none."""
    joints = [arm.joints[i] for i in arm.coordinates]
    free = [k for k, j in enumerate(joints) if j.limits.velocity is None and j.drive.limits.velocity is None]
    least = float(np.min(np.asarray(speeds)[free])) if free and len(speeds) else None
    words = [] if least is None else ["--velocity", f"{least:z.2g}"]
    try:
        bounds(arm, ExcitationOptions(velocity=least))
    except InputError:
        return None
    return words
