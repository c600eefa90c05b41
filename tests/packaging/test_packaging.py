"""The packaging of an arm: each build system takes the folder as it is."""

import importlib.util
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from arms_support import ARMS, EVERY_ARM, generated, library
from c_support import C_COMPILERS, WARNINGS, one_source
from c_support import write as write_files
from ruamel.yaml import YAML

from modelgen.functions import Options
from modelgen.generation import GeneratedArm, generate_arm

ARM = "ariane4"
SOME = [pytest.param(name, marks=pytest.mark.xdist_group(name)) for name in ("ariane4", "scara", "ur10e")]
VERSION = re.compile(r"\d+\.\d+\.\d+")


@pytest.fixture(scope="module")
def made() -> GeneratedArm:
    return generated(ARM)


@pytest.fixture
def folder(made: GeneratedArm, tmp_path: Path) -> Path:
    write_files(made.files, tmp_path / ARM)
    return tmp_path / ARM


def run(*command: object, cwd: Path | None = None) -> str:
    done = subprocess.run(
        [str(part) for part in command], capture_output=True, text=True, check=False, cwd=cwd
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return done.stdout


def self_tested(folder: Path, name: str, real: str, target: Path, arm: Path | None = None) -> int:
    """Compile the arm, where it is not given as a library, and its self-test, and run it."""
    flags = [*WARNINGS, "-O0", f"-D{name.upper()}_REAL={real}", "-I", folder / "include"]
    test = folder / "examples/self_test/main.c"
    run(C_COMPILERS[0], "-std=c99", *flags, test, arm or one_source(folder), "-o", target, "-lm")
    return subprocess.run([str(target)], check=False).returncode


@pytest.mark.parametrize("name", EVERY_ARM)
def test_the_self_test_agrees_in_float_and_double(
    name: str, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """With the library that other tests of the arm call; of its sources they say that no warning is given."""
    write_files(generated(name).files, tmp_path)
    for real in ("float", "double"):
        arm = library(name, real, tmp_path_factory)
        assert self_tested(tmp_path, name, real, tmp_path / real, arm) == 0, real


@pytest.mark.xdist_group(ARM)
@pytest.mark.parametrize("variant", ["row_wise", "runtime_geometry", "sincos"])
def test_the_self_test_agrees_whatever_the_options(variant: str, tmp_path: Path) -> None:
    write_files(generated(ARM, variant).files, tmp_path)
    assert self_tested(tmp_path, ARM, "double", tmp_path / "double") == 0


@pytest.mark.xdist_group(ARM)
@pytest.mark.parametrize(
    "function", ["gravity", "regressor_standard", "forward_dynamics", "joint_from_motor"]
)
def test_the_self_test_finds_a_number_changed(function: str, folder: Path) -> None:
    """One constant off by a twentieth, in single precision."""
    path = folder / f"src/{ARM}_{function}.c"
    head, brace, body = path.read_text(encoding="utf-8").partition("    return status;\n    }\n")
    found = re.search(r"_C\((-?0\.\d{4,})\) \*", body) or re.search(r"_C\((-?\d+\.\d{4,})\) \*", body)
    assert found
    changed = body[: found.start(1)] + repr(float(found[1]) * 1.05) + body[found.end(1) :]
    path.write_text(head + brace + changed, encoding="utf-8")
    number = self_tested(folder, ARM, "float", folder / "broken")
    tests = (folder / "examples/self_test/main.c").read_text(encoding="utf-8")
    assert number > 0
    before = tests[: tests.index(f"return {number};")]
    assert re.findall(rf"{ARM}_(\w+)\(", before)[-1] == function


@pytest.mark.xdist_group(ARM)
def test_a_header_of_another_version_is_refused(folder: Path, tmp_path: Path) -> None:
    """The header of the arm generated with other options, beside these sources."""
    other = generate_arm(ARMS[ARM], Options(without=frozenset({"effects"})))
    header = f"include/{ARM}.h"
    (folder / header).write_text(other.files[header], encoding="utf-8")
    source = folder / f"src/{ARM}_gravity.c"
    command = [C_COMPILERS[0], "-std=c99", "-I", folder / "include", "-c", source, "-o", tmp_path / "x.o"]
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert "are of different generations: generate the arm again" in done.stderr


def needs_cmake() -> None:
    if shutil.which("cmake") is None:
        pytest.skip("needs cmake (Debian: cmake)")


APPLICATION = f"""
#include "{ARM}.h"
int main(void)
{{
    {ARM}_real_t q[3] = {{0}}, p[24] = {{0}}, out[3];
    return sizeof(out[0]) == sizeof(float) && {ARM}_gravity(q, p, out) == {ARM.upper()}_STATUS_STROKE ? 0 : 1;
}}
"""


@pytest.mark.xdist_group("cmake")
@pytest.mark.parametrize(
    "found",
    [
        f"add_subdirectory(../{ARM} {ARM})",
        f"include(FetchContent)\nFetchContent_Declare({ARM} SOURCE_DIR ${{CMAKE_SOURCE_DIR}}/../{ARM})\n"
        f"FetchContent_MakeAvailable({ARM})",
    ],
    ids=["add_subdirectory", "FetchContent"],
)
def test_cmake_in_another_project(found: str, folder: Path, tmp_path: Path) -> None:
    needs_cmake()
    application(tmp_path, found)
    run("cmake", "-S", tmp_path / "app", "-B", tmp_path / "build", f"-D{ARM.upper()}_REAL=float")
    run("cmake", "--build", tmp_path / "build")
    run(tmp_path / "build/app")


@pytest.mark.xdist_group("cmake")
def test_cmake_tested_installed_and_found(folder: Path, tmp_path: Path) -> None:
    needs_cmake()
    build, prefix = tmp_path / "own", tmp_path / "prefix"
    run("cmake", "-S", folder, "-B", build, f"-D{ARM.upper()}_REAL=float", f"-DCMAKE_INSTALL_PREFIX={prefix}")
    run("cmake", "--build", build)
    run("ctest", "--output-on-failure", cwd=build)
    run("cmake", "--install", build)
    application(tmp_path, f"find_package({ARM} REQUIRED)")
    run("cmake", "-S", tmp_path / "app", "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", tmp_path / "build")
    run(tmp_path / "build/app")


def application(tmp_path: Path, found: str) -> None:
    (tmp_path / "app").mkdir()
    (tmp_path / "app/main.c").write_text(APPLICATION, encoding="utf-8")
    (tmp_path / "app/CMakeLists.txt").write_text(
        f"cmake_minimum_required(VERSION 3.16)\nproject(app C)\n{found}\nadd_executable(app main.c)\n"
        f"target_link_libraries(app PRIVATE modelgen::{ARM})\n",
        encoding="utf-8",
    )


DESCRIPTION = """\
schema: 1
convention: khalil_kleinfinger
arms:
  pendulum:
    gravity: [0, -9.81, 0]
    joints:
      - {name: j1, alpha: 0, d: 0.1, r: 0, drive: {type: direct, ratio: 50, torque_constant: 0.02}}
"""


@pytest.mark.xdist_group("cmake")
def test_modelgen_generate_follows_the_description(checkout: Path, tmp_path: Path) -> None:
    """1 N m at a gear of 50, then of 100, half the current; a description that is wrong stops the build."""
    needs_cmake()
    arms = tmp_path / "arms.yaml"
    arms.write_text(DESCRIPTION, encoding="utf-8")
    (tmp_path / "main.c").write_text(
        '#include <stdio.h>\n#include "pendulum.h"\nint main(void) {\n'
        "    pendulum_real_t q[1] = {0}, p[PENDULUM_N_PARAMETERS], out[1];\n"
        "    for (int i = 0; i < PENDULUM_N_PARAMETERS; ++i) { p[i] = 1 / (pendulum_real_t)9.81; }\n"
        '    int status = pendulum_gravity(q, p, out);\n    printf("%d %d %.4f", status, (int)sizeof q, '
        "(double)out[0]);\n    return 0;\n}\n",
        encoding="utf-8",
    )
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.16)\nproject(app C)\n"
        f"set(ENV{{PYTHONPATH}} {checkout})\nset(MODELGEN_COMMAND {sys.executable} -m modelgen)\n"
        f"include({checkout}/cmake/ModelgenGenerate.cmake)\n"
        "modelgen_generate(ARMS_FILE arms.yaml ARMS pendulum REAL float)\n"
        "add_executable(app main.c)\ntarget_link_libraries(app PRIVATE modelgen::pendulum)\n",
        encoding="utf-8",
    )
    build = tmp_path / "build"
    run("cmake", "-S", tmp_path, "-B", build)
    for ratio, current in ((50, "1.0000"), (100, "0.5000")):
        arms.write_text(DESCRIPTION.replace("ratio: 50", f"ratio: {ratio}"), encoding="utf-8")
        run("cmake", "--build", build)
        assert run(build / "app") == f"0 4 {current}"
    arms.write_text(DESCRIPTION.replace("ratio: 50", "ratio: 0"), encoding="utf-8")
    done = subprocess.run(["cmake", "--build", str(build)], capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert "ratio: found 0" in " ".join(done.stderr.split())


def test_the_folder_of_the_cmake_functions_is_told(checkout: Path) -> None:
    told = run(sys.executable, "-m", "modelgen", "cmake-dir", cwd=checkout).strip()
    assert (Path(told) / "ModelgenGenerate.cmake").is_file()


@pytest.mark.xdist_group("platformio")
def test_platformio_packs_the_folder(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if importlib.util.find_spec("platformio") is None:
        pytest.skip("needs platformio (pip)")
    monkeypatch.setenv("PLATFORMIO_CORE_DIR", str(tmp_path / "core"))
    monkeypatch.setenv("PLATFORMIO_SETTING_ENABLE_TELEMETRY", "no")
    run(sys.executable, "-m", "platformio", "pkg", "pack", folder, "--output", tmp_path / "packed.tar.gz")
    listed = run("tar", "tzf", tmp_path / "packed.tar.gz").split()
    assert {"library.json", f"include/{ARM}.h", f"src/{ARM}_gravity.c"} <= set(listed)


def test_library_json_by_its_schema(made: GeneratedArm) -> None:
    """What PlatformIO's documentation asks for: name, version, and patterns of names."""
    content = json.loads(made.files["library.json"])
    assert re.fullmatch(r"[A-Za-z0-9_+. -]{1,50}", content["name"])
    assert VERSION.fullmatch(content["version"])
    assert content["build"] == {
        "includeDir": "include",
        "srcDir": "src",
        "flags": ["-ffp-contract=fast", "-fno-math-errno"],
    }
    assert f"include/{content['headers']}" in made.files


def test_library_properties_by_its_schema(made: GeneratedArm) -> None:
    """Arduino's library specification 1.5: the fields, and the header found below src/."""
    lines = made.files["library.properties"].splitlines()
    fields = dict(line.split("=", 1) for line in lines if not line.startswith("#"))
    assert list(fields)[:4] == ["name", "version", "author", "maintainer"]
    assert all(fields.values())
    assert fields["category"] == "Device Control"
    assert VERSION.fullmatch(fields["version"])
    assert re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_.\- ]{0,62}", fields["name"])
    assert f"src/{fields['includes']}" in made.files


@pytest.mark.xdist_group(ARM)
def test_src_alone_is_enough_to_include(folder: Path, tmp_path: Path) -> None:
    """As Arduino builds: src/ on the path of headers, every C file below it compiled."""
    sources = sorted(str(path) for path in (folder / "src").glob("*.c"))
    run(C_COMPILERS[0], "-std=c99", "-I", folder / "src", "-fsyntax-only", *sources)


def test_esp_idf_and_zephyr_by_their_schemas(made: GeneratedArm) -> None:
    idf = YAML(typ="safe").load(made.files["idf_component.yml"])
    assert VERSION.fullmatch(idf["version"])
    assert set(idf) <= {"version", "description", "url", "dependencies"}
    module = YAML(typ="safe").load(made.files["zephyr/module.yml"])
    assert set(module) == {"name", "build"}
    assert f"{module['build']['cmake']}/CMakeLists.txt" in made.files
    assert module["build"]["kconfig"] in made.files
    kconfig = made.files[module["build"]["kconfig"]]
    symbols = set(re.findall(r"^config (\w+)$", kconfig, re.MULTILINE))
    assert {f"CONFIG_{symbol}" for symbol in symbols} == set(
        re.findall(r"CONFIG_\w+", made.files["zephyr/CMakeLists.txt"])
    )


FRAMEWORKS = {
    "esp-idf": (
        "set(ESP_PLATFORM 1)\nset(COMPONENT_LIB component)\n"
        "function(idf_component_register)\n"
        '  cmake_parse_arguments(PARSE_ARGV 0 c "" "" "SRCS;INCLUDE_DIRS;PRIV_INCLUDE_DIRS")\n'
        "  list(TRANSFORM c_SRCS PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)\n"
        "  add_library(component STATIC ${c_SRCS})\n"
        "  target_include_directories(component PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/${c_INCLUDE_DIRS})\n"
        "endfunction()\n",
        "",
    ),
    "zephyr": (
        f"set(CONFIG_MODELGEN_{ARM.upper()} y)\nset(CONFIG_MODELGEN_{ARM.upper()}_FLOAT y)\n"
        "function(zephyr_library_named name)\n  add_library(component STATIC)\nendfunction()\n"
        "function(zephyr_library_sources)\n  target_sources(component PRIVATE ${ARGV})\nendfunction()\n"
        "function(zephyr_include_directories)\n  target_include_directories(component PUBLIC ${ARGV})\n"
        "endfunction()\n"
        "function(zephyr_compile_definitions)\n  target_compile_definitions(component PUBLIC ${ARGV})\n"
        "endfunction()\n"
        "function(zephyr_library_compile_options)\n  target_compile_options(component PRIVATE ${ARGV})\n"
        "endfunction()\ncmake_policy(SET CMP0076 NEW)\n",
        "/zephyr",
    ),
}


@pytest.mark.xdist_group("cmake")
@pytest.mark.parametrize("framework", list(FRAMEWORKS))
def test_cmake_of_the_frameworks(framework: str, folder: Path, tmp_path: Path) -> None:
    """Their CMake functions as stand-ins: the component compiles, in float, and links."""
    needs_cmake()
    stand_ins, below = FRAMEWORKS[framework]
    application(tmp_path, f"{stand_ins}add_subdirectory(../{ARM}{below} component)")
    lists = tmp_path / "app/CMakeLists.txt"
    text = lists.read_text(encoding="utf-8").replace(f"modelgen::{ARM}", "component m")
    lists.write_text(text, encoding="utf-8")
    run("cmake", "-S", tmp_path / "app", "-B", tmp_path / "build")
    run("cmake", "--build", tmp_path / "build")
    run(tmp_path / "build/app")


def test_the_readme_lists_every_function(made: GeneratedArm) -> None:
    text = made.files["README.md"]
    functions = text.split("## Functions")[1].split("\n## ")[0]
    for name, counts in made.operations.items():
        if not name.endswith("_standard"):
            (row,) = [line for line in functions.splitlines() if line.startswith(f"| `{name}` |")]
            total = sum(counts[kind] for kind in ("mul", "add", "neg"))
            assert re.search(rf"\| {total}(,|\b)", row), name
    assert "q[3] [rad]" in text
    assert "3 × 24" in text
    assert not re.search(r"\d{4}-\d\d-\d\d", text), "no date"


@pytest.mark.parametrize("name", SOME)
def test_the_example_of_the_readme_compiles(name: str, tmp_path: Path) -> None:
    files = generated(name).files
    write_files(files, tmp_path)
    (block,) = re.findall(r"```c\n(.*?)```", files["README.md"], re.DOTALL)
    include, _, body = block.partition("\n")
    source = tmp_path / "example.c"
    source.write_text(f"{include}\nint main(void)\n{{\n{body}return 0;\n}}\n", encoding="utf-8")
    run(C_COMPILERS[0], "-std=c99", "-Wall", "-Werror", "-I", tmp_path / "include", "-fsyntax-only", source)
