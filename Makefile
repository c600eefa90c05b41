# Needs Python 3.11 or later, a C and C++ compiler and make; everything else goes into $(VENV).
#   make run     generate every arm of arms.yaml into generated/, then diagnose a simulated recording
#   make check   lint and the fast tests, for while one works
#   make test    lint, then every test
#   make pytest  every test
#   make slow    time every test, and write those that make check leaves out into tests/slow.txt
#   make lint    ruff and mypy
#   make format  let ruff rewrite the layout
#   make bench   beside Pinocchio, MuJoCo, SymForce, SymPy and FIGAROH, and variants: docs/benchmarks.md (needs valgrind)
#   make bench-scale  chains of 2 to 50 joints and trees, into the same page
#   make bench-identification  long logs, beside Pinocchio's regressor in a loop; growth with the samples
#   make bench-generation  CPU time of generation, per arm and over the number of joints
#   make bench-robots  import every robot of example-robot-data, against Pinocchio and MuJoCo: docs/imported-robots.md
#   make bench-fleet  diagnose 200 simulated arms as one job, into build/fleet; CPU time of a diagnosis over its size
#   make docs    the documentation as HTML, with the reference: build/docs/index.html
#   make size    flash, stack and instructions of every function on a Cortex-M4F
#   make run-examples  the examples, and the plots that they write
#   make prove   Frama-C on every function of ariane4 and ur10e (needs frama-c)
#   make fuzz    libFuzzer on five arms, FUZZ_SECONDS each (needs clang)
#   make hidden  diagnose two dozen simulated recordings with hidden effects (a part of make test)
#   make blind   diagnose the full matrix of hidden effects (SEED=n, TRAIN=4 records; hours), write docs/diagnosis.md
#   make gallery  hide every effect of the catalogue in simulated records and draw what it does: docs/gallery.md (ONLY=names)
#   make mutations  defects put into the diagnosis, one after the other: its tests must see each
#   make clean   remove the environment and the caches

PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
# modelgen alone, which is what it takes to run; and with what its tests, pages and measurements need besides.
INSTALLED := $(VENV)/.installed
TESTED := $(VENV)/.installed-test

.PHONY: run check test pytest slow lint format bench bench-scale bench-identification bench-generation bench-robots bench-fleet docs size \
    run-examples prove fuzz hidden blind gallery mutations clean

EXAMPLE := examples/diagnosis

run: $(INSTALLED)
	$(BIN)/modelgen generate
	@echo 'Diagnosing a simulated recording with a hidden cause: $(EXAMPLE)'
	$(BIN)/modelgen diagnose $(EXAMPLE)/arms.yaml --arm digger --train $(EXAMPLE)/train_a.csv \
	    --train $(EXAMPLE)/train_b.csv --test $(EXAMPLE)/test.csv --out build/digger

check: lint
	$(BIN)/python -m pytest -q -n auto --dist loadgroup -m "not slow"

test: lint pytest

pytest: $(TESTED)
	$(BIN)/python -m pytest -n auto --dist loadgroup

# What a process keeps, a model for one, falls on the first test that asks for it: the fast ones that pay when the
# slow ones are left out are found by a second run.
slow: $(TESTED)
	$(BIN)/python -m pytest -q -n auto --dist loadgroup --processor-times build/times.txt
	$(BIN)/python tests/support/slow_tests.py build/times.txt
	$(BIN)/python -m pytest -q -n auto --dist loadgroup --processor-times build/times-fast.txt -m "not slow"
	$(BIN)/python tests/support/slow_tests.py build/times.txt build/times-fast.txt

lint: $(TESTED)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy --strict

format: $(TESTED)
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

bench: $(TESTED)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[bench]'
	$(BIN)/python benchmarks/variants.py --accept
	$(BIN)/python benchmarks/control.py --accept
	$(BIN)/python benchmarks/compare.py --accept

bench-scale: $(TESTED)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[bench]'
	$(BIN)/python benchmarks/scale.py --accept
	$(BIN)/python benchmarks/compare.py --page

bench-identification: $(TESTED)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[bench,logs]'
	$(BIN)/python benchmarks/identification.py
	$(BIN)/python benchmarks/identification.py --scale 1e8

bench-generation: $(TESTED)
	$(BIN)/python benchmarks/generate.py

bench-robots: $(TESTED)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[robots]'
	$(BIN)/python benchmarks/robots.py --accept

bench-fleet: $(TESTED)
	$(BIN)/python benchmarks/fleet.py build/fleet
	$(BIN)/python benchmarks/diagnosis_scale.py

docs: $(TESTED)
	$(BIN)/python docs/build.py

size: $(TESTED)
	$(BIN)/python benchmarks/size.py

run-examples: $(TESTED)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[examples]'
	$(BIN)/python examples/firmware/run.py
	$(BIN)/python examples/watch/run.py
	$(BIN)/python examples/mpc/mpc_run.py
	$(BIN)/python examples/ariane_experiment/twin_run.py
	$(BIN)/python examples/ariane_experiment/twin_coverage.py
	$(BIN)/python examples/gravity_test/gravity_run.py

prove: $(TESTED)
	PYTHONPATH=tests $(BIN)/python -m safety.eva

FUZZ_SECONDS ?= 60

fuzz: $(TESTED)
	PYTHONPATH=tests $(BIN)/python -m safety.fuzz --seconds $(FUZZ_SECONDS)

hidden: $(TESTED)
	$(BIN)/python -m pytest -n auto tests/hidden/test_suite.py

blind: $(TESTED)
	PYTHONPATH=tests $(BIN)/python -m hidden.blind $(if $(SEED),--seed $(SEED)) $(if $(TRAIN),--train $(TRAIN)) \
	    $(if $(ONLY),--only $(ONLY))

gallery: $(TESTED)
	$(BIN)/python -m modelgen effects --pages docs
	PYTHONPATH=tests $(BIN)/python -m hidden.gallery $(if $(ONLY),--only $(ONLY))

mutations: $(TESTED)
	PYTHONPATH=tests $(BIN)/python -m architecture.mutations

clean:
	rm -rf $(VENV) .mypy_cache .pytest_cache .ruff_cache .hypothesis
	find modelgen tests benchmarks -name __pycache__ -type d -prune -exec rm -rf {} +

# An environment that is there is kept, with what it holds besides. The stamps are written last: an installation that
# failed is taken up again by the next make.
define environment
	@test -x $(BIN)/python || $(PYTHON) -c 'import sys; sys.version_info >= (3, 11) or sys.exit("modelgen needs Python 3.11 or later, and $(PYTHON) is " + sys.version.split()[0] + "; try make PYTHON=python3.12")'
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
endef

# pip compiles what it copies, not what it links to: where Python keeps no bytecode by itself, commands start slower.
compiled = @$(BIN)/python -m compileall -q modelgen

$(INSTALLED): pyproject.toml
	$(environment)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable .
	$(compiled)
	@touch $@

$(TESTED): pyproject.toml
	$(environment)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[test]'
	$(compiled)
	@touch $(INSTALLED) $@
