"""C of the table of functions that the harness calls."""

from __future__ import annotations

from collections.abc import Mapping

_CALL = """\
static const double *call_{key}(const double *q, const double *dq, const double *third)
{{
    static double out[{size}];
    (void)dq;
    (void)third;
    {call};
    return out;
}}
"""


def harness_source(head: str, calls: Mapping[str, tuple[str, int]]) -> str:
    """C text of a peer. `calls`: name -> (call that writes `out`, size of the result)."""
    text = [head, '#include "peer.h"', ""]
    text += [_CALL.format(key=key, size=size, call=call) for key, (call, size) in calls.items()]
    rows = "".join(f'    {{"{key}", {size}, call_{key}}},\n' for key, (_, size) in calls.items())
    text += [f"static const struct peer_function functions[] = {{\n{rows}    {{0, 0, 0}}}};"]
    text += ["", "const struct peer_function *peer_open(const char *model)", "{", "    (void)model;"]
    return "\n".join([*text, "    return functions;", "}", ""])
