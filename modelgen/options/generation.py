"""Options of generated code, beside those of the functions."""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.options.field import documented, option


@documented()
@dataclass(frozen=True)
class GenerationOptions:
    """Artefacts, budgets and processes of a generation."""

    casadi: bool = option(False, "Also write the CasADi functions serialised: <arm>/casadi/.")
    casadi_plant: bool = option(False, "Also write the C plant for casadi.external: <arm>/plant/.")
    ros2: bool = option(False, "Also write a ROS 2 package of library, class and node: <arm>/ros2/.")
    max_flash: int | None = option(
        None, "Most flash that a function may take.", "BYTES", least=1, unit="bytes"
    )
    max_stack: int | None = option(
        None, "Most stack that a function may take.", "BYTES", least=1, unit="bytes"
    )
    target: str = option("cortex-m4f", "Whose compiler measures them: cortex-m4f, cortex-m7, host.", "NAME")
    processes: int | None = option(
        None, "Processes. Default: one per processor.", "N", ["-j", "--jobs"], least=1
    )
