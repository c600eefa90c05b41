"""The cases of the test suite. Seeds in order of the list; magnitudes as hidden.cases.draw finds them."""

from hidden.cases import Case, Hidden

NULLS = (
    Case("direct2", 401),
    Case("direct3", 402),
    Case("levered2", 403),
    Case("levered3", 404, rate=1000.0),
    Case("mixed2", 405, encoder="joint"),
    Case("mixed3", 406),
)
SINGLES = (
    Case("mixed3", 101, (Hidden("friction_offset", 1, 1.3, 0.0513561),)),
    Case("direct3", 102, (Hidden("asymmetric_viscous_friction", 2, 1.3, 0.468338),)),
    Case("direct2", 103, (Hidden("stribeck_friction", 2, 1.3, 0.522718),)),
    Case("direct3", 104, (Hidden("load_dependent_friction", 3, 1.3, 0.572668),)),
    Case("levered2", 105, (Hidden("nonlinear_viscous_friction", 1, 1.3, 1.41662),)),
    Case("direct2", 106, (Hidden("position_dependent_friction", 2, 1.3, 0.140231),)),
    Case("mixed2", 107, (Hidden("friction_warm_up", 2, 1.3, 0.152544),)),
    Case("mixed2", 108, (Hidden("presliding", 2, 1.3, 0.0454231),)),
    Case("direct2", 109, (Hidden("torque_ripple", 1, 1.3, 0.658138),)),
    Case("levered2", 1110, (Hidden("lever_geometry", 2, 1.3, 2.00597),)),
    Case("levered2", 111, (Hidden("spring", 1, 1.3, 0.622015),)),
    Case("mixed3", 112, (Hidden("base_tilt", 2, 1.3, 0.0908685),)),
    Case("levered2", 113, (Hidden("fluid_drag", 2, 1.3, 0.384374),)),
    Case("direct3", 114, (Hidden("time_delay", 2, 1.3, 3.35321),)),
)
OUTSIDE = (
    Case("direct2", 201, (Hidden("hard_spot", 1, 1.3, 0.145807),)),
    Case("direct3", 202, (Hidden("external_contact", 3, 1.3, 0.0429235),)),
    Case("mixed3", 1223503423, (Hidden("supply_sag", 1, 1.3, 0.044738),)),
)
PAIRS = (
    Case(
        "mixed3",
        2301,
        (Hidden("stribeck_friction", 2, 1.15, 1.20516), Hidden("base_tilt", 3, 1.15, 0.0499758)),
    ),
    Case(
        "levered2",
        302,
        (Hidden("load_dependent_friction", 1, 1.15, 1.09022), Hidden("time_delay", 1, 1.15, 3.4105)),
    ),
)
