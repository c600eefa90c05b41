"""Arrays in a file of MATLAB, versions 5 to 7 (Level 5 MAT-File Format, The MathWorks).

Read here, since SciPy's reader ends the process where a damaged file says sizes that are none. What is no
array of numbers and no struct of them (text, cells, objects) is passed over.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from math import prod
from pathlib import Path
from typing import TypeAlias

import numpy as np

from modelgen.errors import DamagedFileError, InputError

HEAD = 128  # bytes before the first variable
DEEPEST = 8  # structs in structs
_ENDS = {b"IM": "<", b"MI": ">"}
# Elements by the number of their type: how numbers are stored, an array, a compressed element.
_STORED = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
_ARRAY, _COMPRESSED = 14, 15
# Arrays by the number of their class, and the bit of those with an imaginary part.
_STRUCT, _NUMBERS, _COMPLEX = 2, range(6, 16), 0x0800
_HDF = b"\x89HDF\r\n\x1a\n"  # of a file of version 7.3, after a head of up to 512 bytes

Tree: TypeAlias = "np.ndarray | dict[str, Tree]"


def matlab_arrays(path: Path, data: bytes) -> dict[str, Tree]:
    """Arrays by name, structs of one element as mappings, of the bytes of a file that messages call `path`.

    Raises InputError for files of other versions and damaged ones.
    """
    if _HDF in data[:1024]:
        raise InputError(
            f"{path}: this is a file of MATLAB 7.3, expected one of version 7: "
            "save('log.mat', '-v7') in MATLAB writes it"
        )
    if data[126:128] not in _ENDS:
        raise InputError(
            f"{path}: this is no MATLAB file of version 5 to 7; save('log.mat', '-v7') in MATLAB writes one"
        )
    elements = _Elements(_ENDS[data[126:128]])
    try:
        return dict(elements.variables(data[HEAD:]))
    except (ValueError, zlib.error, struct.error) as error:
        raise DamagedFileError(f"{path}: this MATLAB file is damaged: {error}") from None


class _Elements:
    """The elements of a file, whose numbers are in an order of bytes, "<" or ">"."""

    def __init__(self, order: str) -> None:
        self.order = order

    def variables(self, data: bytes) -> Iterator[tuple[str, Tree]]:
        """Names and arrays of the variables. Raises ValueError where sizes do not fit."""
        for kind, inner in self._parts(data):
            if kind == _COMPRESSED:
                yield from self.variables(zlib.decompress(inner))
            elif kind == _ARRAY:
                name, found = self._array(inner, 0)
                if found is not None:
                    yield name, found

    def _parts(self, data: bytes) -> Iterator[tuple[int, bytes]]:
        """Types and bytes of the elements one after the other."""
        at = 0
        while at < len(data):
            if len(data) - at < 8:
                raise ValueError("it ends within an element")
            word, size = struct.unpack(f"{self.order}II", data[at : at + 8])
            begin = at + 8
            if word >> 16:  # four bytes at most, in the place of their number
                word, size, begin = word & 0xFFFF, word >> 16, at + 4
                at += 8
                if size > 4:
                    raise ValueError(f"found {size} bytes where four have room")
            else:
                at = begin + size + (0 if word == _COMPRESSED else -size % 8)
            if begin + size > len(data):
                raise ValueError(f"an element of {size} bytes goes beyond the end")
            yield word, data[begin : begin + size]

    def _array(self, data: bytes, depth: int) -> tuple[str, Tree | None]:
        """Name and content of an array; None for what holds no numbers."""
        parts = self._parts(data)
        (_, flags), *rest = [part for _, part in zip(range(3), parts, strict=False)] or [(0, b"")]
        if len(flags) < 4 or len(rest) < 2:
            return "", None
        (word,) = struct.unpack(f"{self.order}I", flags[:4])
        kind, ((_, sizes), (_, letters)) = word & 0xFF, rest
        name = letters.decode("ascii", "replace")
        if kind == _STRUCT and depth < DEEPEST and self._shape(sizes) == (1, 1):
            return name, self._fields(parts, depth)
        if kind not in _NUMBERS or word & _COMPLEX:
            return name, None
        shape = self._shape(sizes)
        stored, numbers = next(parts, (9, b""))
        if stored not in _STORED:
            raise ValueError(f"found numbers of an unknown type, {stored}, in {name}")
        values = np.frombuffer(numbers, np.dtype(self.order + _STORED[stored]))
        if len(values) != prod(shape):
            raise ValueError(f"found {len(values)} numbers in {name}, expected {prod(shape)}")
        return name, values.reshape(shape, order="F")

    def _fields(self, parts: Iterator[tuple[int, bytes]], depth: int) -> dict[str, Tree]:
        """The fields of a struct by name."""
        (_, size), (_, letters) = next(parts, (0, b"")), next(parts, (0, b""))
        (length,) = struct.unpack(f"{self.order}i", size)
        if length <= 0:
            raise ValueError(f"found names of {length} letters in a struct")
        words = [letters[k : k + length] for k in range(0, len(letters), length)]
        names = [word.split(b"\0")[0].decode("ascii", "replace") for word in words]
        found: dict[str, Tree] = {}
        for name, (_, inner) in zip(names, parts, strict=False):
            _, value = self._array(inner, depth + 1)
            if value is not None:
                found[name] = value
        return found

    def _shape(self, sizes: bytes) -> tuple[int, ...]:
        if len(sizes) % 4 or not sizes:
            raise ValueError("found an array without a size")
        shape = struct.unpack(f"{self.order}{len(sizes) // 4}i", sizes)
        if min(shape) < 0:
            raise ValueError(f"found an array of the size {shape}")
        return shape
