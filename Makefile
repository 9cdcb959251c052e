# Set-up and main jobs of rigctl on a Debian or Ubuntu with Python 3.11 to 3.13 (with its venv module) and make.
#
#   make run     environment, installation, then the squeal matrix of the paper on the simulated rig
#   make test    environment with the tools for development, then linters, types and all tests
#   make gui     the operator's window
#   make figures the figures of the paper from our model, its numbers beside ours: figures/figures.html
#   make lock    resolve the dependencies again (after a change in pyproject.toml)

# The tests start hundreds of short processes; without bytecode each of them would compile our sources again.
unexport PYTHONDONTWRITEBYTECODE

.DELETE_ON_ERROR:
.PHONY: help run gui translations screenshots figures test system lint types lock clean

VENV := .venv
BIN := $(VENV)/bin
PROGRAM ?= configs/programs/squeal_matrix.toml
RUN_ARGS ?=
WORKERS ?= 2
GUI_ARGS ?=

help:
	@sed -n 's/^#   //p' Makefile

run: $(VENV)/.run
	$(BIN)/rigctl run $(PROGRAM) $(RUN_ARGS)

gui: $(VENV)/.run
	$(BIN)/rigctl gui $(GUI_ARGS)

# Texts of the window: collected from the code, German in rigctl/gui/translations/rigctl_de.ts, then compiled. A running
# window has mapped the compiled file: it is replaced, never written into.
TEXTS := rigctl/gui/translations/rigctl_de
translations: $(VENV)/.dev
	$(BIN)/pyside6-lupdate -silent -no-obsolete -locations none \
		$$(find rigctl/gui -name '*.py' | LC_ALL=C sort) -ts $(TEXTS).ts
	$(BIN)/pyside6-lrelease $(TEXTS).ts -qm $(TEXTS).qm.new && mv $(TEXTS).qm.new $(TEXTS).qm

# Pictures of every page for the documents: a guided tour on a screen in memory.
screenshots: $(VENV)/.dev
	$(BIN)/python tests/gui/tour/make_screenshots.py

figures: $(VENV)/.run
	$(BIN)/rigctl model figures --out figures

# Tests of real wires and real time work by the clock and may be late on a busy machine: what fails is run again, one
# test at a time, and has to pass then.
test: system lint types
	$(BIN)/python -m pytest -n $(WORKERS) --dist worksteal --durations=15 || $(BIN)/python -m pytest --last-failed --last-failed-no-failures none

# Says which Debian packages are missing for some of the tests; in CI installs them.
system:
	@sh .ci/system-packages

lint: $(VENV)/.dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports

types: $(VENV)/.dev
	$(BIN)/basedpyright --level error

# --no-deps: the locks hold every package with its hash; nothing else is taken.
$(VENV)/.run: requirements.lock pyproject.toml | $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --require-hashes -r requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	@touch $@

$(VENV)/.dev: requirements-dev.lock $(VENV)/.run
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --require-hashes -r requirements-dev.lock
	@touch $@

$(VENV):
	@sh .ci/make-venv $(VENV)

lock: $(VENV)/.dev
	$(BIN)/uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-emit-index-url \
		--custom-compile-command "make lock" --group build -o requirements.lock pyproject.toml
	$(BIN)/uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-emit-index-url \
		--custom-compile-command "make lock" --group build --group dev -c requirements.lock -o requirements-dev.lock pyproject.toml

clean:
	rm -rf $(VENV) figures build dist .pytest_cache .hypothesis .ruff_cache
