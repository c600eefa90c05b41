"""Every mistake in a description: one line, its place, what was found, expected, and comes nearest."""

import pytest

from modelgen.description import loads
from modelgen.errors import InputError
from modelgen.transmission import KINDS

EFFECTS = {
    "viscous_friction": ["coefficient"],
    "coulomb_friction": ["magnitude"],
    "drive_inertia": ["inertia"],
}
GOOD = """\
schema: 1
convention: khalil_kleinfinger
arms:
  arm:
    gravity: [0, 0, -9.81]
    fluid_density: 0
    symbols: {d3: 0.443}
    locked: {j3: 0}
    joints:
      - name: j1
        alpha: 90 deg
        d: 0.116
        r: 0
        limits: {position: [-80 deg, 20 deg], velocity: 28 deg}
        drive:
          type: levered
          l1: 0.323
          l2: 0.058
          length: [0.2679, 0.3684]
          motor: [0, 20850]
          rev: 1
          offset: -106.39 deg
          torque_constant: 1.1e-4
      - name: j2
        d: d3
        drive: {type: direct, ratio: 100, torque_constant: 0.05}
        effects: [viscous_friction, {coulomb_friction: {magnitude: 0.2}}]
      - {name: j3, d: 0.3, drive: {type: none}, limits: {position: [-1, 1]}}
      - {name: j4, type: prismatic, r: 0.1}
      - {name: tip, type: fixed, r: 0.1}
    links:
      j1: {mass: 6.5, com: [0.05, 0.01, -0.03], inertia: [0.03, 0, 0, 0.04, 0, 0.035]}
"""


def complaint(old: str, new: str) -> str:
    assert GOOD.count(old) == 1, f"{old!r} must stand once in the good text"
    with pytest.raises(InputError) as caught:
        loads(GOOD.replace(old, new), "arms.yaml", EFFECTS)
    assert caught.value.where is not None
    text = str(caught.value)
    assert "\n" not in text
    return text


def test_the_good_text_is_good() -> None:
    assert list(loads(GOOD, "arms.yaml", EFFECTS)) == ["arm"]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        # keys
        (
            "gravity:",
            "gravitiy:",
            "5:5: arm.gravitiy: found the unknown key 'gravitiy', did you mean 'gravity'?",
        ),
        (
            "offset:",
            "ofset:",
            "22:11: arm.joints.0.drive.ofset: found the unknown key 'ofset', did you mean 'offset'?",
        ),
        (
            "{mass:",
            "{weight:",
            "arm.links.j1.weight: found the unknown key 'weight', available: mass, com, inertia",
        ),
        ("          rev: 1\n", "", "16:11: arm.joints.0.drive: the key 'rev' is missing"),
        ("schema: 1\n", "", "1:1: the key 'schema' is missing"),
        (
            "        alpha: 90 deg\n",
            "        alpha: 1\n        alpha: 2\n",
            "12:9: the key 'alpha' is given twice",
        ),
        # head of the file
        ("schema: 1", "schema: 2", "1:9: schema: found 2, expected 1"),
        ("schema: 1", "schema: true", "1:9: schema: found true, expected a whole number"),
        ("khalil_kleinfinger", "denavit", "2:13: convention: found 'denavit', expected khalil_kleinfinger"),
        # types
        ("[0, 0, -9.81]", "9.81", "5:14: arm.gravity: found 9.81, expected a list"),
        ("[0, 0, -9.81]", "[0, -9.81]", "5:14: arm.gravity: found 2 entries, expected 3 entries"),
        ("[0, 0, -9.81]", "[0, 0, down]", "5:21: arm.gravity.2: found 'down', expected a number"),
        (
            "d: 0.116",
            "d: [0.116]",
            "12:12: arm.joints.0.d: found a list of 1, expected a number or an expression",
        ),
        ("d: 0.116", "d: true", "12:12: arm.joints.0.d: found true, expected a number"),
        ("d: 0.116", "d:", "arm.joints.0.d: found nothing, expected a number"),
        ("name: j1", "name: 1", "10:15: arm.joints.0.name: found 1, expected text"),
        ("name: j1", "name: j 1", "arm.joints.0.name: found 'j 1', expected a name"),
        ("drive: {type: none}", "drive: none", "arm.joints.2.drive: found 'none', expected a mapping"),
        (
            "drive: {type: none}",
            "drive: {}",
            "arm.joints.2.drive: the key 'type' is missing, expected one of none",
        ),
        (
            "type: levered",
            "type: lever",
            "16:17: arm.joints.0.drive.type: found 'lever', "
            "expected one of none, direct, levered, slider_crank, did you mean 'levered'?",
        ),
        ("type: prismatic", "type: prism", "found 'prism', expected one of revolute, prismatic, fixed"),
        ("rev: 1", "rev: 2", "21:16: arm.joints.0.drive.rev: found 2, expected one of 1, -1"),
        ("rev: 1", "rev: 0.5", "arm.joints.0.drive.rev: found 0.5, expected a whole number"),
        (
            "  arm:",
            "  7arm:",
            "4:3: 7arm: found '7arm', expected a name: a letter, then letters, digits and _",
        ),
        # units and expressions
        ("alpha: 90 deg", "alpha: 90 mm", "11:16: arm.joints.0.alpha: found '90 mm', expected an angle"),
        ("d: 0.116", "d: 5 deg", "12:12: arm.joints.0.d: found '5 deg', expected a length"),
        ("alpha: 90 deg", "alpha: ninety", "the name 'ninety' is not known, available: pi, d3"),
        (
            "alpha: 90 deg",
            "alpha: .nan",
            'found nan, expected an angle such as 1.57, pi/2 or "90 deg": its value is not finite',
        ),
        ("fluid_density: 0", "fluid_density: .inf", "its value is not finite"),
        ("[-1, 1]", "[-1 mm, 1]", "arm.joints.2.limits.position.0: found '-1 mm', expected an angle"),
        (
            "r: 0.1}\n      - {name: tip",
            "limits: {velocity: 1 deg}}\n      - {name: tip",
            "found '1 deg', expected a length",
        ),
        ("ratio: 100", "ratio: 100 deg", "expected a plain number"),
        # levers
        (
            "[0.2679, 0.3684]",
            "[0.2, 0.3684]",
            "19:20: arm.joints.0.drive.length.0: found the actuator length 0.2 m, "
            "an impossible triangle: with l1 = 0.323 m and l2 = 0.058 m it must lie between "
            "|l1 - l2| = 0.265 m and l1 + l2 = 0.381 m",
        ),
        (
            "[0.2679, 0.3684]",
            "[0.2679, 0.4]",
            "19:28: arm.joints.0.drive.length.1: found the actuator length 0.4 m, an impossible triangle",
        ),
        (
            "[0.2679, 0.3684]",
            "[0.265, 0.3684]",
            "19:20: arm.joints.0.drive.length.0: at the length 0.265 m "
            "the stroke reaches the lever's dead centre: inner angle 0 deg",
        ),
        (
            "[0.2679, 0.3684]",
            "[0.2679, 0.381]",
            "reaches the lever's dead centre: inner angle 180 deg, expected at least 0.5 deg from 180 deg",
        ),
        (
            "[-80 deg, 20 deg]",
            "[-91 deg, 20 deg]",
            "14:28: arm.joints.0.limits.position: found the joint range -91 deg to 20 deg, "
            "but the actuator's stroke allows -89.8",
        ),
        ("offset: -106.39 deg", "offset: -60 deg", "correct the range, or the drive's length, rev or offset"),
        (
            "[0.2679, 0.3684]",
            "[0.3, 0.3]",
            "19:19: arm.joints.0.drive.length: both lengths are 0.3 m, expected a stroke",
        ),
        (
            "[0, 20850]",
            "[7, 7]",
            "20:18: arm.joints.0.drive.motor: both motor values are 7, expected a range",
        ),
        ("l1: 0.323", "l1: 0", "17:15: arm.joints.0.drive.l1: found 0 m, expected a length above 0"),
        ("l1: 0.323", "l1: -0.323", "found -0.323 m, expected a length above 0"),
        # drives
        ("ratio: 100", "ratio: 0", "26:38: arm.joints.1.drive.ratio: found 0, expected a value other than 0"),
        ("ratio: 100", "ratio: d3 - d3", "arm.joints.1.drive.ratio: found 0, expected a value other than 0"),
        ("torque_constant: 0.05", "torque_constant: 0", "found 0, expected a value other than 0"),
        ("torque_constant: 1.1e-4", "torque_constant: .nan", "found nan, expected a number"),
        ("ratio: 100", "current: -1, ratio: 100", "found -1, expected a magnitude above 0"),
        (
            "type: fixed,",
            "type: fixed, drive: {type: direct, ratio: 1, torque_constant: 1},",
            "found a drive on a fixed joint",
        ),
        (
            "      - name: j1\n",
            "      - name: j1\n        type: prismatic\n",
            "found a levered drive on a prismatic joint",
        ),
        # joints
        (
            "name: j2",
            "name: j1",
            "24:15: arm.joints.1.name: a joint before is called 'j1' as well, names must differ",
        ),
        ("name: j2", "name: base", "'base' names the arm's base"),
        (
            "name: tip, ",
            "name: tip, antecedent: j5, ",
            "found 'j5', which is no joint of this arm, available: base, j1, j2, j3, j4, tip",
        ),
        (
            "name: j1\n",
            "name: j1\n        antecedent: j2\n",
            "11:21: arm.joints.0.antecedent: the antecedents form a cycle, j1 <- j2 <- j1",
        ),
        ("name: tip, ", "name: tip, antecedent: tip, ", "the antecedents form a cycle, tip <- tip"),
        ("[-80 deg, 20 deg]", "[20 deg, -80 deg]", "found 20 deg to -80 deg, expected the lower end first"),
        (
            "velocity: 28 deg",
            "velocity: -28 deg",
            "14:57: arm.joints.0.limits.velocity: found '-28 deg', expected a magnitude above 0",
        ),
        ("type: fixed,", "type: fixed, limits: {velocity: 1},", "found limits on a fixed joint"),
        ("type: fixed,", "type: fixed, effects: [viscous_friction],", "found effects on a fixed joint"),
        # locked
        (
            "locked: {j3: 0}",
            "locked: {j33: 0}",
            "8:14: arm.locked.j33: 'j33' is no joint of this arm, did you mean 'j3'?",
        ),
        ("locked: {j3: 0}", "locked: {tip: 0}", "'tip' is a fixed joint, it has no coordinate to lock"),
        (
            "locked: {j3: 0}",
            "locked: {j3: 1.5}",
            "8:18: arm.locked.j3: found 85.9437 deg, "
            "which lies outside the joint's range -57.2958 deg to 57.2958 deg",
        ),
        ("locked: {j3: 0}", "locked: {j1: 90 deg}", "which lies outside the joint's range -80 deg to 20 deg"),
        ("locked: {j3: 0}", "locked: {j1: 0, j2: 0, j3: 0, j4: 0}", "no joint of this arm moves"),
        # effects
        (
            "[viscous_friction,",
            "[viscuous_friction,",
            "27:19: arm.joints.1.effects.0: there is no effect 'viscuous_friction', "
            "did you mean 'viscous_friction'?",
        ),
        (
            "{magnitude: 0.2}",
            "{magnitud: 0.2}",
            "coulomb_friction has no parameter 'magnitud', did you mean 'magnitude'?",
        ),
        (
            "[viscous_friction,",
            "[coulomb_friction,",
            "the effect 'coulomb_friction' is listed twice on this joint",
        ),
        ("[viscous_friction,", "[3,", "found 3, expected an effect's name"),
        ("{magnitude: 0.2}", "0.2", "arm.joints.1.effects.1.coulomb_friction: found 0.2, expected a mapping"),
        ("{magnitude: 0.2}", "{magnitude: high}", "the name 'high' is not known"),
        # links
        (
            "      j1: {mass",
            "      j9: {mass",
            "32:7: arm.links.j9: 'j9' is no joint of this arm, available: j1, j2, j3, j4, tip",
        ),
        ("mass: 6.5", "mass: -6.5", "found -6.5 kg, expected a mass that is not negative"),
        ("mass: 6.5", "mass: 0", "found an inertia without mass, expected zeros for a link of mass 0"),
        (
            "[0.03, 0, 0, 0.04, 0, 0.035]",
            "[0.03, 0, 0, 0.04, 0, 0.08]",
            "the largest exceeds the sum of the others",
        ),
        ("[0.03, 0, 0, 0.04, 0, 0.035]", "[0.03, 0.1, 0, 0.04, 0, 0.035]", "expected none negative"),
        ("[0.03, 0, 0, 0.04, 0, 0.035]", "[0.03, 0.04, 0.035]", "found 3 entries, expected 6 entries"),
        # arm
        (
            "fluid_density: 0",
            "fluid_density: -1",
            "6:20: arm.fluid_density: found -1 kg/m^3, expected 0 or more",
        ),
        ("  arm:", "  while:", "4:3: while: 'while' is a keyword of C or C++"),
        ("  arm:", "  namespace:", "'namespace' is a keyword of C or C++"),
        (
            "  arm:",
            "  math:",
            "4:3: math: 'math' hides the C library's header <math.h>; choose another name, for",
        ),
        ("  arm:", "  String:", "'String' hides the C library's header <string.h>"),
        ("  arm:", "  m:", "'m' is a library of the C run time, libm"),
        ("  arm:", "  test:", "'test' is a target that CMake keeps for itself"),
        ("  arm:", "  aux:", "'aux' is the name of a device on Windows"),
        ("  arm:", "  COM3:", "'COM3' is the name of a device on Windows, which no folder can have"),
        ("  arm:", "  _arm:", "expected a name: a letter"),
        ("  arm:", "  my-arm:", "expected a name: a letter, then letters, digits and _"),
        ("  arm:", "  a__b:", "holds two _ in a row"),
        (
            "fluid_density: 0",
            "version: 1.2 beta",
            "arm.version: found '1.2 beta', expected a version: at most 64 letters, digits and . + _ -",
        ),
        ("fluid_density: 0", "version: 1.2", "arm.version: found 1.2, expected text (put quotes around it)"),
        # symbols
        ("{d3: 0.443}", "{pi: 3}", "7:15: arm.symbols.pi: 'pi' belongs to the expressions themselves"),
        ("{d3: 0.443}", "{cos: 3}", "'cos' belongs to the expressions themselves"),
        ("{d3: 0.443}", "{mm: 3}", "'mm' is a unit"),
        ("{d3: 0.443}", "{int: 3}", "'int' is a keyword"),
        ("{d3: 0.443}", "{lambda: 3}", "'lambda' is a keyword"),
        ("{d3: 0.443}", "{XX2: 3}", "'XX2' could be a standard parameter"),
        ("{d3: 0.443}", "{M3: 3}", "'M3' could be a standard parameter"),
        ("{d3: 0.443}", "{MX2R: 3}", "'MX2R' could be a standard parameter"),
        ("{d3: 0.443}", "{q1: 3}", "'q1' could be a standard parameter or a signal"),
        ("{d3: 0.443}", "{parameters: 3}", "'parameters' is an argument of the generated functions"),
        ("{d3: 0.443}", "{d-3: 3}", "found 'd-3', expected a name"),
        ("{d3: 0.443}", "{d3: far}", "7:19: arm.symbols.d3: found 'far', expected a number"),
    ],
)
def test_a_mistake_is_told_with_its_place(old: str, new: str, message: str) -> None:
    text = complaint(old, new)
    assert text.startswith("arms.yaml:")
    assert message in text


def test_arms_whose_files_would_collide() -> None:
    joints = "{joints: [{name: j1}]}"
    text = f"schema: 1\nconvention: khalil_kleinfinger\narms:\n  Arm: {joints}\n  arm: {joints}\n"
    with pytest.raises(InputError) as caught:
        loads(text)
    assert str(caught.value).startswith(
        "arms.yaml:5:3: arm: the files of the arms 'Arm' and 'arm' would collide"
    )


def test_the_first_mistake_is_told() -> None:
    text = GOOD.replace("d: 0.116", "d: true").replace("mass: 6.5", "mass: true")
    with pytest.raises(InputError, match=r"^arms\.yaml:12:12: "):
        loads(text)


def test_a_misspelt_key_is_told_rather_than_the_one_that_is_missing() -> None:
    assert "found the unknown key 'ratoi', did you mean 'ratio'?" in complaint("ratio: 100", "ratoi: 100")


def test_a_key_in_a_wrong_place_is_told_its_own() -> None:
    assert "drive.limits: found the unknown key 'limits'; it belongs in arms.joints" in complaint(
        "ratio: 100", "ratio: 100, limits: {velocity: 1}"
    )


def test_a_key_of_another_kind_of_drive_is_told_which() -> None:
    said = complaint("ratio: 100", "ratio: 100, lever: 0.1")
    assert "drive.lever: found the unknown key 'lever'; it belongs to the type " in said
    assert all(kind in KINDS for kind in said.rpartition("the type ")[2].split(" or "))
    assert "found the unknown key 'mass'; it belongs in arms.links" in complaint("arms:", "mass: 2\narms:")


def test_without_a_catalogue_any_effect_will_do() -> None:
    arm = loads(GOOD.replace("[viscous_friction,", "[unheard_of,"))["arm"]
    assert arm.joints[1].effects[0].name == "unheard_of"
