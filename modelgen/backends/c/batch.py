"""Functions over many states: vectors of the host's processor, a state in each lane.

A block of states whose inputs, pivots and results are all as they should be is computed in vectors. Any other
one goes through the function itself, state after state, as does what remains at the end: every status that is
not 0 comes from there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from modelgen.backends.body import body, unset
from modelgen.backends.c.dialect import INDENT, OUTPUT_LIMIT, CDialect, arrays, literal
from modelgen.backends.c.lengths import argument_length
from modelgen.backends.c.pairs import Pair, pairs
from modelgen.backends.c.source import checked_output
from modelgen.backends.c.walk import column_walk
from modelgen.backends.elements import Element, local_names
from modelgen.backends.text import wrapped_code
from modelgen.functions.objects import Argument, Function, Model, least_guarded

BATCH = "_batch"  # suffix of the functions
SHARED = ("parameters", "geometry")  # inputs that all states have in common
UNARY = ("tan", "asin", "acos", "atan", "exp", "log", "tanh")  # functions that lanes ask one after the other
BINARY = ("atan2", "pow")


@dataclass(frozen=True)
class Batch:
    """A function over many states, ready for the templates; lines of code without the functions' heads."""

    name: str
    title: str
    signature: str
    declared: str
    inner: str
    names: str
    one: tuple[str, ...]
    block: tuple[str, ...]
    spread: tuple[str, ...]
    index: str
    load: tuple[str, ...]


def lane_by_lane() -> dict[str, list[tuple[str, str]]]:
    """Functions of one and of two arguments that every lane calls for itself: names, and those of macros."""
    return {
        "unary": [(name, name.upper()) for name in UNARY],
        "binary": [(name, name.upper()) for name in BINARY],
    }


def batches(model: Model) -> list[Batch]:
    """One for each function that is asked for. Raises ValueError as `literal` does."""
    return [_batch(model, function) for function in model.functions if function.name in model.batch]


def _batch(model: Model, function: Function) -> Batch:
    arm = model.arm.name
    real, lanes = f"{arm}_real_t", f"{arm}_lanes_t"
    inputs = [
        f"const {real} {a.name}[{argument_length(model, function, a) if a.name in SHARED else ''}]"
        for a in function.arguments
    ]
    outputs = [f"{real} {name}[]" for name in arrays(function)]
    between = f",\n{INDENT}"
    declared = between.join(["size_t n", *inputs, *outputs, f"{arm}_status_t status[]"])
    vectors = [f"const {lanes} {a.name}[]" for a in function.arguments if a.size]
    title = function.name.replace("_", " ")
    return Batch(
        name=function.name,
        title=title[0].upper() + title[1:],
        signature=f"{arm}_status_t {arm}_{function.name}{BATCH}(\n{INDENT}{declared})",
        declared=declared,
        inner=between.join([*vectors, *outputs]),
        names=", ".join(["n", *(a.name for a in function.arguments), *arrays(function), "status"]),
        one=tuple(_one(arm, function)),
        block=tuple(_block(model, function)),
        spread=tuple(_spread(arm, function)),
        index=_index(arm, function),
        load=tuple(_load(arm, function)),
    )


def _one(arm: str, function: Function) -> list[str]:
    """A state of its own, through the function itself."""
    own = [a for a in function.arguments if a.size and a.name not in SHARED]
    lines = [f"{INDENT}{arm}_real_t one_{a.name}[{a.size}];" for a in own]
    lines += [f"{INDENT}{arm}_real_t one_{name}[{size}];" for name, size in arrays(function).items()]
    lines.append(f"{INDENT}size_t k;")
    for a in own:
        lines += _each(a.size, f"one_{a.name}[k] = {a.name}[k * n + i];")
    given = [f"one_{a.name}" if a in own else a.name for a in function.arguments]
    given += [f"one_{name}" for name in arrays(function)]
    lines.append(wrapped_code(f"status[i] = {arm}_{function.name}({', '.join(given)});", INDENT, INDENT * 2))
    for name, size in arrays(function).items():
        lines += _each(size, f"{name}[k * n + i] = one_{name}[k];")
    return [*lines, f"{INDENT}return status[i];"]


def _each(size: int, statement: str, indent: str = INDENT) -> list[str]:
    return [f"{indent}for (k = 0; k < {size}; ++k) {{", f"{indent}{INDENT}{statement}", f"{indent}}}"]


def _spread(arm: str, function: Function) -> list[str]:
    """What all states have in common, in every lane."""
    shared = [a for a in function.arguments if a.size and a.name in SHARED]
    lines = [f"{INDENT}{arm}_lanes_t all_{a.name}[{a.size}];" for a in shared]
    usable = [_usable(arm, a) for a in shared]
    whole = f"n - n % {arm.upper()}_LANES"
    if usable:
        whole = f"{' && '.join(usable)} ? {whole} : 0"
    lines.append(wrapped_code(f"const size_t whole = {whole};", INDENT, INDENT * 2))
    lines += [f"{INDENT}size_t k;"]
    for a in shared:
        lines += _each(a.size, f"all_{a.name}[k] = {arm}_lanes_all({a.name}[k]);")
    return lines


def _index(arm: str, function: Function) -> str:
    """Where the block's states begin in every row; unknown to the compiler where it would keep sums of it."""
    walk = column_walk(arm, function)
    return f"{arm}_lanes_distance(i)" if walk and walk.wide else "i"


def _load(arm: str, function: Function) -> list[str]:
    """A block of states in vectors, and the call of the function over them."""
    own = [a for a in function.arguments if a.size and a.name not in SHARED]
    inner = INDENT * 2
    lines = [f"{inner}{arm}_lanes_t block_{a.name}[{a.size}];" for a in own]
    for a in own:
        lines += _each(a.size, f"block_{a.name}[k] = {arm}_lanes_load({a.name} + k * n + at);", inner)
    given = [f"{'block' if a in own else 'all'}_{a.name}" for a in function.arguments if a.size]
    given += [f"{name} + at" for name in arrays(function)]
    call = f"const int good = {arm}_{function.name}_lanes(n, {', '.join(given)});"
    return [*lines, wrapped_code(call, inner, INDENT * 3)]


def _usable(arm: str, a: Argument) -> str:
    test = f"{arm}_within({a.name}, {a.size}, {literal(arm, a.bound * a.bound)})"
    return f"{arm.upper()}_PARAMETERS_USABLE({test})" if a.name == "parameters" else test


def _block(model: Model, function: Function) -> list[str]:
    """The program over vectors, and whether all is well in every lane."""
    arm = model.arm.name
    dialect = _Lanes(arm, function, local_names(model, function), checked=bool(checked_output(function)))
    together, rest = pairs(function.program)
    lines = [*dialect.indices()]
    conditions = _conditions(arm, function)
    first = conditions[0] if conditions else f"{dialect.constant(0.0)} <= {dialect.constant(0.0)}"
    lines.append(wrapped_code(f"{arm}_lanes_bits_t good = {first};", INDENT, INDENT * 2))
    lines += [wrapped_code(f"good &= {c};", INDENT, INDENT * 2) for c in conditions[1:]]
    if dialect.checked:
        lines.append(f"{INDENT}{arm}_lanes_t total = {dialect.constant(0.0)};")
    maybe = ["n", *(a.name for a in function.arguments if a.size and a.name in SHARED)]
    lines += [f"{INDENT}(void){name};" for name in maybe]
    lines += dialect.walk.begin() if dialect.walk else []
    lines += [dialect.pair(pair) for pair in together]
    lines += body(replace(function, program=rest), {}, dialect)
    if dialect.walk:
        lines += [line for column in list(dialect.walk.zeros) for line in dialect.walk.to(column)]
    else:
        lines += [
            dialect.zero(output, index) for output, missing in unset(function).items() for index in missing
        ]
    if dialect.checked:  # as `bounded` of the private header has it of every output
        lines.append(f"{INDENT}good &= total <= {dialect.constant(OUTPUT_LIMIT)};")
    return [*lines, f"{INDENT}return {arm}_lanes_every(good);"]


def _conditions(arm: str, function: Function) -> list[str]:
    """What has to hold of the inputs that every state has of its own.

    One sum of squares, each input's in proportion to its bound's, holds less than every bound alone: a block
    within all bounds and beyond that sum goes state after state.
    """
    found: list[str] = []
    own = sorted((a for a in function.arguments if a.size and a.name not in SHARED), key=lambda a: -a.bound)
    for i, a in enumerate(own):
        squares = f"{arm}_lanes_squares({a.name}, {a.size})"
        if i:
            factor = _in_lanes(arm, a.bound**2 / own[i - 1].bound ** 2)
            before = found.pop()
            squares = f"{f'({before})' if i > 1 else before} * {factor} + {squares}"
        found.append(squares)
    if own:
        found.append(f"{found.pop()} <= {_in_lanes(arm, own[-1].bound ** 2)}")
    for r in function.ranges:
        element = f"{r.argument}[{r.index}]"
        low, high = _in_lanes(arm, r.low), _in_lanes(arm, r.high)
        found.append(f"({element} >= {low}) & ({element} <= {high})")
    return found


def _in_lanes(arm: str, value: float) -> str:
    """A number in every lane."""
    return literal(arm, value).replace(f"{arm.upper()}_C(", f"{arm.upper()}_K(", 1)


class _Lanes(CDialect):
    """Statements over vectors."""

    def __init__(
        self, arm: str, function: Function, named: Mapping[str, Sequence[Element | None]], *, checked: bool
    ) -> None:
        super().__init__(arm, function, named)
        self.real = f"const {arm}_lanes_t"
        self.checked = checked
        self.walk = column_walk(arm, function)

    def constant(self, value: float) -> str:
        """Write a number as a literal in every lane."""
        return _in_lanes(self.arm, value)

    def call(self, function: str, arguments: Sequence[str]) -> str:
        """A function of the header of lanes."""
        return f"{self.arm}_lanes_{function}({', '.join(arguments)})"

    def pair(self, pair: Pair) -> str:
        """Sine and cosine of one angle."""
        sine, cosine = self.temporary(pair.sine), self.temporary(pair.cosine)
        angle = self.element(*pair.angle[1:])
        return (
            f"{INDENT}{self.arm}_lanes_t {sine}, {cosine};\n"
            f"{INDENT}{self.arm}_lanes_sincos({angle}, &{sine}, &{cosine});"
        )

    def store(self, output: str, index: int, text: str) -> str:
        """Store an element, and add up the magnitudes where they are tested."""
        put = f"total += {self.arm}_lanes_put" if self.checked else f"{self.arm}_lanes_store"
        before, place = [], self._place(output, index)
        if self.walk:
            row, column = self.walk.split(index)
            before, place = self.walk.to(column), self.walk.place(row, column)
        return "\n".join([*before, wrapped_code(f"{put}({place}, {text});", INDENT, INDENT * 2)])

    def zero(self, output: str, index: int) -> str:
        """Store an element that is always zero."""
        return f"{INDENT}{self.arm}_lanes_store({self._place(output, index)}, {self.constant(0.0)});"

    def guard(self, status: int, text: str) -> str:
        """Take note where a value is not what it must be; false for what is not a number."""
        return wrapped_code(f"good &= {text} > {self.constant(least_guarded(status))};", INDENT, INDENT * 2)

    def _place(self, output: str, index: int) -> str:
        array, offset = self.places[output]
        number = offset + index
        return f"{array} + {number} * n" if number else array
