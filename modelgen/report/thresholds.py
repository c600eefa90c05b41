"""The page of thresholds: name, usual value, unit, meaning and source of each.

python -m modelgen.report.thresholds > docs/thresholds.md
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from inspect import getdoc

from modelgen.diagnosis.options import Thresholds
from modelgen.thresholds import Group, Value

_HEAD = """# Thresholds

*Which numbers decide, where do they come from, and how do I set another one?* Here is every number on which a
decision of the diagnosis depends, and every number by which a log is refused or its processing chosen.
[How a cause is named](diagnosis_method.md) says what they are for. A caller passes other values by name:

```python
mg.diagnose(arm, train=["a.csv", "b.csv"], test="c.csv", thresholds={"selection.min_delta_bic": 10.0})
```

`settings.thresholds` of diagnosis.json lists the values that are not the usual ones. Numbers that set how
finely something is computed, as steps of a search do, are no thresholds. They are beside the code that uses
them. This page is written by `python -m modelgen.report.thresholds`.
"""


def page() -> str:
    """Text of thresholds.md, a section for each stage."""
    usual = Thresholds()
    stages = {name: getattr(usual, name) for name in usual.__dataclass_fields__}
    return "\n".join([_HEAD, *(line for name, group in stages.items() for line in _section(name, group))])


def _section(stage: str, group: Group) -> Iterator[str]:
    """Lines of one stage."""
    text = (getdoc(type(group)) or "").split(" See docs/")[0].replace("\n", " ")
    yield f"## {stage.capitalize()}\n\n{text}\n"
    yield "| name | value | unit | meaning | source |\n|---|---|---|---|---|"
    for e in group.entries():
        cells = (f"`{stage}.{e.name}`", _value(e.value), e.unit, e.meaning, e.source)
        yield "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"
    yield ""


def _value(value: Value) -> str:
    """Numbers as a person writes them."""
    return ", ".join(f"{x:z.4g}" for x in value) if isinstance(value, tuple) else f"{value:z.4g}"


if __name__ == "__main__":
    sys.stdout.write(page())
