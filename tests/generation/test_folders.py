"""Folders are written whole or not at all, whatever interrupts the writing."""

import os
import stat
from collections.abc import Callable
from pathlib import Path

import pytest

from modelgen.errors import InputError
from modelgen.generation import folders
from modelgen.generation.folders import MARK, check_output, differences, write_folder

OLD = {MARK: "{}\n", "include/a.h": "old\n", "src/gone.c": "old\n"}
NEW = {MARK: "{ }\n", "include/a.h": "new µ\n", "src/b.c": "new\n"}


def content(folder: Path) -> dict[str, str]:
    return {p.relative_to(folder).as_posix(): p.read_text("utf-8") for p in folder.rglob("*") if p.is_file()}


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_a_folder_holds_exactly_its_files(tmp_path: Path) -> None:
    write_folder(tmp_path / "out" / "arm", OLD)
    write_folder(tmp_path / "out" / "arm", NEW)
    assert content(tmp_path / "out" / "arm") == NEW
    assert names(tmp_path / "out") == ["arm"]
    assert (tmp_path / "out" / "arm" / "src" / "b.c").read_bytes() == b"new\n"


def test_others_may_read_what_is_written(tmp_path: Path) -> None:
    mask = os.umask(0o022)
    try:
        write_folder(tmp_path / "arm", NEW)
    finally:
        os.umask(mask)
    assert stat.S_IMODE((tmp_path / "arm").stat().st_mode) == 0o755
    assert stat.S_IMODE((tmp_path / "arm" / "include" / "a.h").stat().st_mode) == 0o644


def fail_at_call(
    monkeypatch: pytest.MonkeyPatch, owner: object, name: str, number: int, error: BaseException
) -> None:
    """Let the call `number` (from 0) of a function raise."""
    original: Callable[..., object] = getattr(owner, name)
    calls = 0

    def wrapper(*args: object, **kwargs: object) -> object:
        nonlocal calls
        calls += 1
        if calls == number + 1:
            raise error
        return original(*args, **kwargs)

    monkeypatch.setattr(owner, name, wrapper)


STEPS = [
    *((os, "fsync", n) for n in range(3)),
    *((folders, "_write", n) for n in range(3)),
    *((Path, "rename", n) for n in range(2)),
]


@pytest.mark.parametrize("error", [KeyboardInterrupt(), OSError(28, "No space left on device")])
@pytest.mark.parametrize(("owner", "name", "number"), STEPS)
def test_what_is_interrupted_leaves_the_old_folder(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    owner: object,
    name: str,
    number: int,
    error: BaseException,
) -> None:
    write_folder(tmp_path / "arm", OLD)
    fail_at_call(monkeypatch, owner, name, number, error)
    expected = KeyboardInterrupt if isinstance(error, KeyboardInterrupt) else InputError
    with pytest.raises(expected) as raised:
        write_folder(tmp_path / "arm", NEW)
    monkeypatch.undo()
    assert content(tmp_path / "arm") == OLD
    assert names(tmp_path) == ["arm"]
    if expected is InputError:
        line = str(raised.value)
        assert (
            line == f"cannot write {tmp_path / 'arm'}: No space left on device; what was there is unchanged"
        )
    write_folder(tmp_path / "arm", NEW)
    assert content(tmp_path / "arm") == NEW


@pytest.mark.parametrize(("owner", "name", "number"), [*STEPS[:6], (Path, "rename", 0)])
def test_what_is_interrupted_at_first_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, owner: object, name: str, number: int
) -> None:
    fail_at_call(monkeypatch, owner, name, number, KeyboardInterrupt())
    with pytest.raises(KeyboardInterrupt):
        write_folder(tmp_path / "arm", NEW)
    assert names(tmp_path) == []


def test_a_run_that_was_killed_between_its_renamings_is_repaired(tmp_path: Path) -> None:
    write_folder(tmp_path / "arm", OLD)
    (tmp_path / "arm").rename(tmp_path / ".arm.old")
    (tmp_path / ".arm.new").mkdir()
    (tmp_path / ".arm.new" / "half").touch()
    write_folder(tmp_path / "arm", NEW)
    assert content(tmp_path / "arm") == NEW
    assert names(tmp_path) == ["arm"]


def test_a_folder_that_was_not_generated_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "arm").mkdir()
    (tmp_path / "arm" / "thesis.tex").write_text("years of work")
    for write in (lambda: write_folder(tmp_path / "arm", NEW), lambda: check_output(tmp_path, ["arm"])):
        with pytest.raises(InputError, match=r"was not generated \(no manifest.json\); move it away"):
            write()
    assert content(tmp_path / "arm") == {"thesis.tex": "years of work"}


def test_an_empty_folder_is_taken(tmp_path: Path) -> None:
    (tmp_path / "arm").mkdir()
    write_folder(tmp_path / "arm", NEW)
    assert content(tmp_path / "arm") == NEW


def test_a_file_in_the_way_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("kept")
    (tmp_path / "dangling").symlink_to(tmp_path / "nowhere")
    for out in (tmp_path / "file", tmp_path / "file" / "deeper", tmp_path / "dangling"):
        with pytest.raises(InputError, match="is a file, expected a folder; choose another --out"):
            check_output(out, ["arm"])
    with pytest.raises(InputError, match="is a file, expected a folder"):
        check_output(tmp_path, ["file"])
    assert (tmp_path / "file").read_text() == "kept"


def test_a_folder_without_permission_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # A test may run as root, whom no mode of a folder stops.
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    with pytest.raises(InputError, match=f"no permission to write in {tmp_path}; choose another --out"):
        check_output(tmp_path / "new" / "out", ["arm"])


def test_differences_name_what_is_missing_changed_and_extra(tmp_path: Path) -> None:
    write_folder(tmp_path / "arm", OLD)
    assert differences(tmp_path / "arm", OLD) == []
    assert differences(tmp_path / "arm", NEW) == [
        ("include/a.h", "changed"),
        (MARK, "changed"),
        ("src/b.c", "missing"),
        ("src/gone.c", "extra"),
    ]
    assert {kind for _, kind in differences(tmp_path / "nothing", NEW)} == {"missing"}


def test_a_change_of_one_line_ending_is_a_difference(tmp_path: Path) -> None:
    write_folder(tmp_path / "arm", OLD)
    (tmp_path / "arm" / "src" / "gone.c").write_bytes(b"old\r\n")
    assert differences(tmp_path / "arm", OLD) == [("src/gone.c", "changed")]


def test_what_python_leaves_beside_a_module_is_no_difference(tmp_path: Path) -> None:
    write_folder(tmp_path / "arm", OLD)
    (tmp_path / "arm" / "__pycache__").mkdir()
    (tmp_path / "arm" / "__pycache__" / "a.pyc").touch()
    assert differences(tmp_path / "arm", OLD) == []
