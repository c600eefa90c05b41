"""Terms in print: read back they are the same tree, and every parenthesis is needed."""

import ast
from collections.abc import Sequence

from c_support import tokens
from hypothesis import given
from hypothesis import strategies as st

from modelgen.backends.printing import expression
from modelgen.graph import Term


class Plain:
    """Numbers as in Python, x0, x1, ... for elements and t0, t1, ... for temporaries."""

    def constant(self, value: float) -> str:
        return repr(value)

    def element(self, vector: str, index: int) -> str:
        return f"{vector}{index}"

    def temporary(self, number: int) -> str:
        return f"t{number}"

    def call(self, function: str, arguments: Sequence[str]) -> str:
        return f"{function}({', '.join(arguments)})"


class Reader:
    """Recursive descent through an expression of C, by the grammar of the language standard."""

    def __init__(self, text: str) -> None:
        self.tokens = [*tokens(text), "end"]

    def take(self, *wanted: str) -> str | None:
        return self.tokens.pop(0) if self.tokens[0] in wanted else None

    def whole(self) -> Term:
        term = self.additive()
        assert self.tokens == ["end"], self.tokens
        return term

    def additive(self) -> Term:
        left = self.multiplicative()
        while sign := self.take("+", "-"):
            left = ("add" if sign == "+" else "sub", left, self.multiplicative())
        return left

    def multiplicative(self) -> Term:
        left = self.unary()
        while sign := self.take("*", "/"):
            left = ("mul" if sign == "*" else "div", left, self.unary())
        return left

    def unary(self) -> Term:
        if self.take("-"):
            return ("neg", self.unary())
        if self.take("("):
            inner = self.additive()
            assert self.take(")"), self.tokens
            return inner
        token = self.tokens.pop(0)
        if self.take("("):
            arguments = [self.additive()]
            while self.take(","):
                arguments.append(self.additive())
            assert self.take(")"), self.tokens
            return ("call", token, *arguments)
        if token[0].isdigit():
            return ("const", float(token))
        assert token[0] in "xt", token
        return ("in", "x", int(token[1:])) if token[0] == "x" else ("let", int(token[1:]))


def read_python(text: str) -> Term:
    def convert(node: ast.expr) -> Term:
        match node:
            case ast.BinOp(left, operator, right):
                name = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul", ast.Div: "div"}[type(operator)]
                return (name, convert(left), convert(right))
            case ast.UnaryOp(ast.USub(), operand):
                return ("neg", convert(operand))
            case ast.Call(ast.Name(function), arguments):
                return ("call", function, *map(convert, arguments))
            case ast.Constant(value):
                return ("const", value)
            case ast.Name(name):
                return ("in", "x", int(name[1:])) if name[0] == "x" else ("let", int(name[1:]))
        raise AssertionError(ast.dump(node))

    return convert(ast.parse(text, mode="eval").body)


def signs_apart(term: Term) -> Term:
    """The tree with a negative constant as the negation that it is in the text."""
    if term[0] == "const":
        return ("neg", ("const", -term[1])) if term[1] < 0 else term
    return tuple(signs_apart(part) if isinstance(part, tuple) else part for part in term)


leaves = st.one_of(
    st.builds(lambda i: ("in", "x", i), st.integers(0, 3)),
    st.builds(lambda i: ("let", i), st.integers(0, 3)),
    st.builds(lambda v: ("const", v), st.floats(-1e6, 1e6, allow_subnormal=False).filter(bool)),
)
terms = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.tuples(st.sampled_from(["add", "sub", "mul", "div"]), inner, inner),
        st.tuples(st.just("neg"), inner),
        st.tuples(st.just("call"), st.just("sin"), inner),
        st.tuples(st.just("call"), st.just("atan2"), inner, inner),
    ),
    max_leaves=10,
)


@given(terms)
def test_c_reads_the_tree_that_was_printed(term: Term) -> None:
    assert Reader(expression(term, Plain())).whole() == signs_apart(term)


@given(terms)
def test_python_reads_the_tree_that_was_printed(term: Term) -> None:
    assert read_python(expression(term, Plain())) == signs_apart(term)


@given(terms)
def test_no_pair_of_parentheses_can_be_taken_away(term: Term) -> None:
    text = expression(term, Plain())
    tree = Reader(text).whole()
    open_at: list[int] = []
    for end, character in enumerate(text):
        if character == "(":
            open_at.append(end)
        elif character == ")":
            begin = open_at.pop()
            less = f"{text[:begin]}{text[begin + 1 : end]}{text[end + 1 :]}"
            try:
                assert Reader(less).whole() != tree, f"{text} could be {less}"
            except (AssertionError, ValueError) as error:
                if "could be" in str(error):
                    raise


def test_what_a_reader_sees() -> None:
    x, y, z = (("in", "x", i) for i in range(3))
    assert expression(("add", ("add", x, y), ("mul", y, z)), Plain()) == "x0 + x1 + x1 * x2"
    assert expression(("sub", x, ("sub", y, z)), Plain()) == "x0 - (x1 - x2)"
    assert expression(("mul", ("neg", x), ("add", y, ("const", -2.0))), Plain()) == "-x0 * (x1 + -2.0)"
    assert expression(("neg", ("neg", x)), Plain()) == "-(-x0)"
