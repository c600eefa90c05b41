"""The cases of the test suite. Seeds in order of the list; magnitudes as hidden.drawing.draw finds them."""

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
    Case("mixed3", 101, (Hidden("friction_offset", 1, 1.3, 0.0513666),)),
    Case("direct3", 102, (Hidden("asymmetric_viscous_friction", 2, 1.3, 0.487992),)),
    Case("direct2", 103, (Hidden("stribeck_friction", 2, 1.3, 0.5279),)),
    Case("direct3", 104, (Hidden("load_dependent_friction", 3, 1.3, 0.589572),)),
    Case("levered2", 105, (Hidden("nonlinear_viscous_friction", 1, 1.3, 1.64154),)),
    Case("direct2", 106, (Hidden("position_dependent_friction", 2, 1.3, 0.138163),)),
    Case("mixed2", 107, (Hidden("friction_warm_up", 2, 1.3, 0.154747),)),
    Case("mixed2", 108, (Hidden("presliding", 2, 1.3, 0.0434325),)),
    Case("direct2", 109, (Hidden("torque_ripple", 1, 1.3, 0.659292),)),
    Case("levered2", 1110, (Hidden("lever_geometry", 2, 1.3, 1.85877),)),
    Case("levered2", 111, (Hidden("spring", 1, 1.3, 0.951724),)),
    Case("mixed3", 112, (Hidden("base_tilt", 2, 1.3, 0.0905979),)),
    Case("levered2", 113, (Hidden("fluid_drag", 2, 1.3, 0.384645),)),
    Case("direct3", 114, (Hidden("time_delay", 2, 1.3, 3.35345),)),
)
OUTSIDE = (
    Case("direct2", 201, (Hidden("hard_spot", 1, 1.3, 0.145554),)),
    Case("direct3", 202, (Hidden("external_contact", 3, 1.3, 0.0428856),)),
    Case("mixed3", 1223503423, (Hidden("supply_sag", 1, 1.3, 0.0447983),)),
)
PAIRS = (
    Case(
        "mixed3",
        2301,
        (Hidden("stribeck_friction", 2, 1.15, 1.20664), Hidden("base_tilt", 3, 1.15, 0.0495497)),
    ),
    Case(
        "levered2",
        302,
        (Hidden("load_dependent_friction", 1, 1.15, 1.20521), Hidden("time_delay", 1, 1.15, 3.42008)),
    ),
)
