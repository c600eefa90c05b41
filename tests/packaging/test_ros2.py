"""The ROS 2 package of an arm: library and class against NumPy, the node against stand-ins for ROS."""

import os
import re
import shutil
import subprocess
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from arms_support import ARMS, base_vector, inputs, model, standard_vector
from c_support import CXX_COMPILERS
from c_support import write as write_files

import modelgen as mg
from modelgen.backends import NumpyFunction
from modelgen.backends.c.dialect import arrays
from modelgen.evaluation import with_effect
from modelgen.functions import Function, Options, build_model, nominal_base
from modelgen.generation import GeneratedArm, generate, generate_arm
from modelgen.packaging.ros2 import package_name

ARM = "ariane4"
PACKAGE = f"ros2/{ARM}_model"
STAND_INS = Path(__file__).parent / "ros2_stand_ins"
SUFFIXES = ("_standard", "_identified", "_nominal")
pytestmark = pytest.mark.xdist_group(ARM)


def run(*command: object, given: str = "", **environment: str) -> str:
    done = subprocess.run(
        [str(part) for part in command],
        capture_output=True,
        text=True,
        check=False,
        input=given,
        env={**os.environ, **environment},
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return done.stdout


@pytest.fixture(scope="module")
def made() -> GeneratedArm:
    return generate_arm(ARMS[ARM], Options(), ("ros2",))


@pytest.fixture(scope="module")
def package(made: GeneratedArm, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The package alone: it needs nothing of the arm's folder."""
    folder = tmp_path_factory.mktemp("workspace")
    write_files(made.artefacts, folder)
    return folder / PACKAGE


def built(source: Path, build: Path, *options: str) -> Path:
    """Configure, build and install with CMake, all C files in one unit and unoptimised."""
    if shutil.which("cmake") is None:
        pytest.skip("needs cmake (Debian: cmake)")
    quick = ("-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_UNITY_BUILD=ON", "-DCMAKE_UNITY_BUILD_BATCH_SIZE=0")
    prefix = build / "prefix"
    run("cmake", "-S", source, "-B", build, *quick, f"-DCMAKE_INSTALL_PREFIX={prefix}", *options)
    run("cmake", "--build", build)
    run("cmake", "--install", build)
    return prefix


def array(values: np.ndarray) -> str:
    return "{{" + ", ".join(repr(float(x)) for x in values) + "}}"


def call(function: Function, values: list[np.ndarray]) -> str:
    """C++ that calls a method and prints its status and outputs."""
    lines, passed = ["    {", "        arm::Model model{std::array<double, arm::N_PARAMETERS>{}};"], []
    for a, value in zip(function.arguments, values, strict=True):
        if a.name == "parameters":
            lines.append(
                f"        model = arm::Model{{std::array<double, arm::N_PARAMETERS>{array(value)}}};"
            )
        else:
            lines.append(f"        const arm::Vector<{a.size}> {a.name}{array(value)};")
            passed.append(a.name)
    lines += [f"        arm::Vector<{size}> {name}{{}};" for name, size in arrays(function).items()]
    arguments = ", ".join([*passed, *arrays(function)])
    lines.append(f'        std::printf("%d", model.{function.name}({arguments}));')
    lines += [f"        print({name});" for name in arrays(function)]
    return "\n".join([*lines, '        std::printf("\\n");', "    }"])


PROGRAM = f"""
#include <{ARM}_model/{ARM}.hpp>
#include <cstdio>
namespace arm = modelgen::{ARM};
template <typename Values>
void print(const Values& values)
{{
    for (double x : values) {{
        std::printf(" %.17g", x);
    }}
}}
int main()
{{
CALLS
    return 0;
}}
"""


def test_every_method_of_the_installed_class_gives_what_numpy_computes(package: Path, tmp_path: Path) -> None:
    prefix = built(package, tmp_path / "library")
    rng = np.random.default_rng(11)
    functions = [f for f in model(ARM).functions if not f.name.endswith(SUFFIXES) and not f.parts]
    assert {"inverse_dynamics", "forward_dynamics", "energy", "jacobian"} <= {f.name for f in functions}
    values = [inputs(model(ARM), f, rng) for f in functions]
    app = tmp_path / "app"
    calls = "\n".join(call(f, given) for f, given in zip(functions, values, strict=True))
    write_files({"main.cpp": PROGRAM.replace("CALLS", calls)}, app)
    (app / "CMakeLists.txt").write_text(
        f"cmake_minimum_required(VERSION 3.16)\nproject(app CXX)\nfind_package({ARM}_model REQUIRED)\n"
        f"add_executable(app main.cpp)\ntarget_link_libraries(app PRIVATE {ARM}_model::{ARM}_model)\n"
        "install(TARGETS app DESTINATION bin)\n",
        encoding="utf-8",
    )
    lines = run(built(app, tmp_path / "app_build", f"-DCMAKE_PREFIX_PATH={prefix}") / "bin/app").splitlines()
    for f, given, line in zip(functions, values, lines, strict=True):
        result = NumpyFunction(f)(*given)
        expected = np.concatenate([np.ravel(x) for x in (result if isinstance(result, tuple) else (result,))])
        found = np.array(line.split(), float)
        assert found[0] == 0, f.name
        # Rounding alone; a solution of linear equations is worse than the rest by their condition.
        np.testing.assert_allclose(found[1:], expected, rtol=1e-10, atol=1e-10 * np.abs(expected).max())


@pytest.fixture(scope="module")
def node(package: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The node, built where CMake finds the stand-ins in the place of ROS."""
    names = ("ament_cmake", "rclcpp", "std_msgs", "trajectory_msgs")
    found = [f"-D{name}_DIR={STAND_INS / 'cmake'}" for name in names]
    strict = "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wconversion -Wshadow -Werror"
    prefix = built(package, tmp_path_factory.mktemp("node"), *found, strict)
    assert (prefix / f"share/{ARM}_model/package.xml").is_file()
    return prefix / f"lib/{ARM}_model/{ARM}_feed_forward"


def message(names: list[str], *vectors: np.ndarray, points: int = 1) -> str:
    parts = [str(points), str(len(names)), *names]
    for vector in vectors:
        parts += [str(len(vector)), *(repr(float(x)) for x in vector)]
    return " ".join(parts)


def test_the_node_answers_a_desired_state_with_the_inverse_dynamics(node: Path) -> None:
    f = next(f for f in model(ARM).functions if f.name == "inverse_dynamics")
    q, dq, ddq, p = inputs(model(ARM), f, np.random.default_rng(3))
    none, first, order = np.array([]), np.eye(3)[0], [2, 0, 3, 1]
    names = [["j1", "j2", "j3", "gripper"][i] for i in order]
    mixed = [np.append(x, 9.0)[order] for x in (q, dq, ddq)]
    wrong = {
        message([], q, dq, ddq, points=2): "~/desired: found 2 points, expected 1",
        message([], q[:2], dq, ddq): "~/desired: found 2 positions, expected 3",
        message(names, mixed[0], mixed[1][:3], none): "~/desired: found 3 velocities, expected 4",
        message(names, mixed[0], none, mixed[2][:3]): "~/desired: found 3 accelerations, expected 4",
        message(["j1", "j2", "j9"], q, dq, ddq): "~/desired: found no joint j3",
        message([], q + 9 * first, dq, ddq): "~/desired: a lever would leave its stroke",
        message([], q, dq + 1e9 * first, ddq): "~/desired: a number is not finite or beyond its bound",
    }
    right = {
        message([], q, dq, ddq): (q, dq, ddq),
        message(names, *mixed): (q, dq, ddq),
        message([], q, none, none): (q, 0 * q, 0 * q),
    }
    given = "\n".join([*wrong, *right])
    lines = run(node, given=given, PARAMETERS=" ".join(repr(float(x)) for x in p)).splitlines()
    assert lines[: len(wrong)] == list(wrong.values())
    for line, state in zip(lines[len(wrong) :], right.values(), strict=True):
        topic, *numbers = line.split()
        assert topic == "~/input"
        np.testing.assert_allclose(np.array(numbers, float), NumpyFunction(f)(*state, p), rtol=1e-10)


@pytest.mark.parametrize(
    ("parameters", "said"),
    [
        ("1 2 3", "parameters: found 3 values, expected 24 base parameters in the order of ariane4.h"),
        (None, "parameters: found 0 values, expected 24 base parameters in the order of ariane4.h"),
        ("1e30 " * 24, "parameters: a value is not finite or beyond its bound"),
    ],
)
def test_the_node_does_not_start_without_its_parameters(
    node: Path, parameters: str | None, said: str
) -> None:
    environment = os.environ | ({} if parameters is None else {"PARAMETERS": parameters})
    done = subprocess.run([str(node)], capture_output=True, text=True, check=False, env=environment)
    assert (done.returncode, done.stdout.strip()) == (1, said)


@pytest.mark.parametrize("compiler", CXX_COMPILERS)
@pytest.mark.parametrize("real", ["float", "double"])
def test_the_headers_compile_without_a_warning(
    compiler: str, real: str, package: Path, tmp_path: Path
) -> None:
    source = tmp_path / "main.cpp"
    source.write_text(f"#include <{ARM}_model/{ARM}_feed_forward.hpp>\n", encoding="utf-8")
    flags = ["-std=c++17", "-Wall", "-Wextra", "-pedantic", "-Wconversion", "-Wshadow", "-Werror"]
    run(compiler, *flags, f"-DARIANE4_REAL={real}", "-I", package / "include", "-fsyntax-only", source)


def test_values_at_hand_are_in_the_class() -> None:
    """Nominal values where they were asked for, identified ones before them."""
    name, arm = "gravity_link1", ARMS["gravity_link1"]
    plain = build_model(arm)
    nominal = nominal_base(plain)
    other = dict(
        zip(nominal, base_vector(plain, standard_vector(plain, np.random.default_rng(2))), strict=True)
    )
    options = Options(nominal=True, derivatives=False)
    for values in ({}, other):
        files = generate_arm(arm, replace(options, identified=values), ("ros2",)).artefacts
        header = files[f"ros2/{name}_model/include/{name}_model/{name}.hpp"]
        for of, expected in (("NOMINAL", nominal), ("IDENTIFIED", values)):
            listed = re.search(rf"N_PARAMETERS> {of}_PARAMETERS = \{{ \{{\n(.*?)\}} \}};", header, re.DOTALL)
            assert (listed is not None) == bool(expected)
            if listed:
                rows = re.findall(r"^ +(\S+), +/\* (\w+) \[", listed[1], re.MULTILINE)
                assert {row[1]: float(row[0]) for row in rows} == expected
        best = "IDENTIFIED_PARAMETERS" if values else "NOMINAL_PARAMETERS"
        assert f"Model() noexcept : Model({best}) {{}}" in header
        source = files[f"ros2/{name}_model/src/{name}_feed_forward.cpp"]
        assert f"std::vector<double>(arm::{best}.begin(), arm::{best}.end())" in source


def test_an_arm_whose_inverse_dynamics_read_more_has_no_node() -> None:
    """The play of a backlash is a state: no message holds it."""
    arm = with_effect(ARMS["gravity_link1"], "backlash", 1, {"play": 0.001, "stiffness": 50.0})
    files = generate_arm(arm, Options(derivatives=False), ("ros2",)).artefacts
    folder = "ros2/gravity_link1_model"
    assert not [path for path in files if "feed_forward" in path]
    assert "There is no feed-forward node" in files[f"{folder}/README.md"]
    assert "`state`" in files[f"{folder}/README.md"]
    assert "feed_forward" not in files[f"{folder}/CMakeLists.txt"]
    assert "rclcpp" not in files[f"{folder}/package.xml"]


def test_package_xml_by_rep_149(made: GeneratedArm) -> None:
    """What the third format demands, with one maintainer who has an address."""
    root = ET.fromstring(made.artefacts[f"{PACKAGE}/package.xml"])
    assert root.attrib == {"format": "3"}
    once = ("name", "version", "description", "maintainer", "license", "buildtool_depend")
    assert [len(root.findall(tag)) for tag in once] == [1] * len(once)
    assert root.findtext("name") == f"{ARM}_model"
    assert re.fullmatch(r"\d+\.\d+\.\d+", root.findtext("version") or "")
    assert "@" in root.find("maintainer").attrib["email"]  # type: ignore[union-attr]
    assert root.findtext("license") == "0BSD"
    assert root.findtext("export/build_type") == root.findtext("buildtool_depend") == "ament_cmake"
    assert f"project({ARM}_model VERSION" in made.artefacts[f"{PACKAGE}/CMakeLists.txt"]


@pytest.mark.parametrize(("arm", "name"), [("My_Arm", "my_arm_model"), ("a__b_", "a_b_model")])
def test_names_of_packages_follow_rep_144(arm: str, name: str) -> None:
    assert package_name(arm) == name


def test_the_package_is_an_artefact(tmp_path: Path, checkout: Path) -> None:
    """Same bytes again, none of them in the manifest or in git; a check that asks for it finds a change."""
    name, arm = "gravity_link1", ARMS["gravity_link1"]
    made = generate_arm(arm, Options(), ("ros2",))
    package = f"ros2/{name}_model"
    mg.generate(arm, tmp_path, generation=mg.GenerationOptions(ros2=True, processes=1))
    assert {p: (tmp_path / name / p).read_text(encoding="utf-8") for p in made.artefacts} == made.artefacts
    assert "ros2/" not in (tmp_path / name / "manifest.json").read_text(encoding="utf-8")
    committed = (checkout / "generated" / name / "manifest.json").read_text(encoding="utf-8")
    assert made.files["manifest.json"] == committed
    (tmp_path / name / package / "package.xml").write_text("other", encoding="utf-8")
    assert generate([arm], tmp_path, Options(), check=True, processes=1).drift == ()
    drift = generate([arm], tmp_path, Options(), check=True, artefacts=("ros2",), processes=1).drift
    assert [(d.path.relative_to(tmp_path / name).as_posix(), d.kind) for d in drift] == [
        (f"{package}/package.xml", "changed")
    ]
    ignored = ["git", "check-ignore", f"generated/{name}/{package}/package.xml"]
    done = subprocess.run(ignored, cwd=checkout, capture_output=True, text=True, check=False)
    if "not a git repository" not in done.stderr:
        assert done.returncode == 0
