"""Functions of a program for a Cortex-M, called one by one in an emulated processor, without a board."""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from elftools.elf.elffile import ELFFile
from numpy.typing import NDArray
from unicorn import arm_const

from firmware.build import plain, symbols
from firmware.targets import Target

# Half typed: what it exports is not declared.
_unicorn: Any = importlib.import_module("unicorn")

_FLASH, _RAM, _MEGABYTE = 0x00000000, 0x20000000, 1 << 20
_SIZE = 4 * _MEGABYTE
_BUFFERS = _RAM + 2 * _MEGABYTE  # arguments, above the program's data and below the stack
_STACK = _RAM + _SIZE - 64
_RETURN = _FLASH + _SIZE - 16  # nothing is there: the emulation ends when the function returns
_COPROCESSORS = 0xF << 20
_ENABLE = 1 << 30  # FPEXC.EN
_WIDE = 0b11101  # leading bits of the first half of a 32-bit instruction, and above


class Machine:
    """A program loaded into an emulated Cortex-M; `real` is the type of the arm's numbers."""

    def __init__(self, program: Path, target: Target, *, count: bool = False) -> None:
        self.real = np.dtype(np.float32 if target.real == "float" else np.float64)
        self.instructions = 0
        self._lengths: dict[tuple[int, int], int] = {}
        self._emulator = self._processor(target)
        self.symbols = self._load(program)
        if count:
            self._emulator.hook_add(_unicorn.UC_HOOK_BLOCK, self._block)

    def call(self, name: str, inputs: Sequence[Any], sizes: Sequence[int]) -> tuple[int, NDArray[np.float64]]:
        """Status and outputs of a function, which are NaN before the call.

        Adds to `instructions` what the call executed, library functions included, where it counts.
        Raises KeyError for an unknown function, unicorn.UcError where the processor would fault.
        """
        e = self._emulator
        address, addresses = _BUFFERS, []
        arrays = [np.asarray(x, dtype=self.real) for x in inputs]
        arrays += [np.full(size, np.nan, dtype=self.real) for size in sizes]
        for array in arrays:
            e.mem_write(address, array.tobytes() or b"\0")
            addresses.append(address)
            address += -(-max(array.nbytes, 1) // 8) * 8
        registers = (arm_const.UC_ARM_REG_R0, arm_const.UC_ARM_REG_R1, arm_const.UC_ARM_REG_R2)
        for register, value in zip((*registers, arm_const.UC_ARM_REG_R3), addresses, strict=False):
            e.reg_write(register, value)
        e.mem_write(_STACK, np.array(addresses[4:], dtype=np.uint32).tobytes() or b"\0")
        e.reg_write(arm_const.UC_ARM_REG_SP, _STACK)
        e.reg_write(arm_const.UC_ARM_REG_LR, _RETURN | 1)
        e.emu_start(self.symbols[name] | 1, _RETURN)
        status = int(np.uint32(e.reg_read(arm_const.UC_ARM_REG_R0)).astype(np.int32))
        first = len(inputs)
        read = [
            np.frombuffer(bytes(e.mem_read(place, array.nbytes)), dtype=self.real)
            for place, array in zip(addresses[first:], arrays[first:], strict=True)
        ]
        return status, np.concatenate(read).astype(float)

    @staticmethod
    def _processor(target: Target) -> Any:
        if target.name == "cortex-m4f":
            e = _unicorn.Uc(_unicorn.UC_ARCH_ARM, _unicorn.UC_MODE_THUMB | _unicorn.UC_MODE_MCLASS)
            e.ctl_set_cpu_model(arm_const.UC_CPU_ARM_CORTEX_M4)
        else:
            # unicorn's M profile has no double precision; its general core runs the same Thumb instructions.
            e = _unicorn.Uc(_unicorn.UC_ARCH_ARM, _unicorn.UC_MODE_THUMB)
            e.ctl_set_cpu_model(arm_const.UC_CPU_ARM_MAX)
        e.mem_map(_FLASH, _SIZE)
        e.mem_map(_RAM, _SIZE)
        access = e.reg_read(arm_const.UC_ARM_REG_C1_C0_2)
        e.reg_write(arm_const.UC_ARM_REG_C1_C0_2, access | _COPROCESSORS)
        e.reg_write(arm_const.UC_ARM_REG_FPEXC, _ENABLE)
        return e

    def _load(self, program: Path) -> dict[str, int]:
        with program.open("rb") as file:
            elf = ELFFile(file)
            for segment in elf.iter_segments():
                if segment["p_type"] == "PT_LOAD" and segment["p_filesz"]:
                    self._emulator.mem_write(segment["p_vaddr"], segment.data())
            return {
                plain(symbol.name): symbol["st_value"] & ~1
                for symbol in symbols(elf)
                if symbol["st_info"]["type"] == "STT_FUNC"
            }

    def _block(self, emulator: Any, address: int, size: int, _: object) -> None:
        """Called at every straight run of instructions."""
        key = address, size
        if key not in self._lengths:
            self._lengths[key] = _instructions(bytes(emulator.mem_read(address, size)))
        self.instructions += self._lengths[key]


def _instructions(code: bytes) -> int:
    """Number of Thumb instructions in straight code: some take two bytes, some four."""
    count = position = 0
    while position < len(code):
        half = int.from_bytes(code[position : position + 2], "little")
        position += 4 if half >> 11 >= _WIDE else 2
        count += 1
    return count
