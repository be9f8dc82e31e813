# From a fresh clone, with Python 3.11 or newer and nothing else: `make figures`, `make test`.

# candidates, the first that is there and new enough is taken; or name one: make PYTHON=... figures
PYTHON ?= python3.11 python3.12 python3.13 python3.14 python3
JOBS ?= 2
SCALE ?= paper
REPORTED ?= figures
SNAKEFILES := Snakefile workflow rules src/roughgas/cli/project_files
BIN := .venv/bin
READY = "Ready. Next:  source .venv/bin/activate   and then, for example:  roughgas --help"
SNAKEMAKE = $(BIN)/snakemake -j$(JOBS) --config scale=$(SCALE) --
RESULTS = results/$(SCALE)
AT_SCALE = $(if $(filter-out paper,$(SCALE)), SCALE=$(SCALE))
FIGURES = figures$(if $(filter-out paper,$(SCALE)),/$(SCALE))
# without compiled modules, a fifth of all that is installed: Python writes those that are imported
PIP := -m pip --disable-pip-version-check install --quiet --no-compile
IMPORTED := matplotlib.pyplot, netCDF4, numba, numpy.random, pandas, pytest, snakemake.cli, xarray
# what requirements.lock has: with the same versions elsewhere, it is not repeated in requirements/
LOCKED := $$(sed -nE 's/^([a-z0-9-]+)==.*/--no-emit-package \1/p' requirements.lock)
LOCK := uv pip compile --quiet --generate-hashes --no-emit-index-url --no-header --universal \
    --python-version 3.11 pyproject.toml
EXTRA_TESTS := slow or remedy or browser or readers or slurm
TESTS ?=
FAST := base claims config data results scene statistics theory test_refusals.py

help: ## say what there is to make
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## /  make \1\t/' | expand -t 18

figures: setup ## simulate, and draw the four figures of the paper
	$(SNAKEMAKE) figures
	@echo
	@echo "Look at $(foreach figure,1a 1b 2a 2b, $(FIGURES)/fig$(figure).png)"
	@echo "What the paper claims, and what we find:  $(RESULTS)/claims.md"
	@echo "Every number in them:  $(RESULTS)/R.csv"
	@echo "Every point, to click on, and one file to share:  make$(AT_SCALE) report"

report: setup ## pages for a browser: the report, every point to click on, a gas in motion, and how all was made
	$(SNAKEMAKE) $(REPORTED) explore living $(RESULTS)/report.html
	$(BIN)/snakemake --config scale=$(SCALE) --report $(RESULTS)/workflow.html -- $(REPORTED)
	@echo
	@echo "Look at  $(RESULTS)/report.html  $(RESULTS)/explore.html  $(RESULTS)/living.html:"
	@echo "each is one file, to be sent as it is. All products, and how each was made:  $(RESULTS)/workflow.html"
	@echo "With more in it:  make$(AT_SCALE) REPORTED='figures extensions' report"

test: .venv/with-article ## run the tests, but for those of `make extras`
	$(BIN)/python -m pytest -n $(JOBS) --dist loadfile --no-loadscope-reorder -m "not ($(EXTRA_TESTS) or campaign)" $(TESTS)
	@echo "All tests pass. Those that take minutes more, a browser, or Slurm:  make extras"

test-fast: setup ## run those tests that need neither a kernel nor a workflow, at each save
	$(BIN)/python -m pytest -q -n $(JOBS) -m "not ($(EXTRA_TESTS) or campaign)" $(addprefix tests/,$(FAST))

extras: .venv/with-article .venv/with-browser .venv/with-readers .venv-slurm/ready ## run what takes minutes more, a browser, or Slurm
	$(BIN)/python -m pytest -n $(JOBS) --dist loadfile -m "$(EXTRA_TESTS)" $(TESTS)
	@echo "All of these pass, too."

versions: ## install the wheel for each Python that is here, with the newest and the oldest dependencies, and test it
	@tested=; for python in python3.11 python3.12 python3.13 python3.14; do \
	    $$python -c 'import ensurepip, venv' 2>/dev/null || { echo "$$python is not here"; continue; }; \
	    $$python -m tests.versions newest $$python || exit 1; tested="$$tested $$python"; \
	done; \
	set -- $$tested; $$1 -m tests.versions oldest $$1 && \
	echo "All of these pass with the newest dependencies, and $$1 with the oldest:$$tested"

docs: .venv/with-docs ## run the tutorial, and build the documentation: docs/_build/html/index.html
	$(BIN)/python -m sphinx --fresh-env --fail-on-warning --keep-going -q docs docs/_build/html
	@echo "Look at  docs/_build/html/index.html"

notebook: .venv/with-notebook ## open the tutorial in a browser, as a notebook
	@echo "Opening docs/tutorial.ipynb; Ctrl-C here ends it."
	$(BIN)/python -m jupyterlab docs/tutorial.ipynb

article: .venv/with-article ## write the article on this reproduction, a PDF
	$(SNAKEMAKE) article
	@echo "Look at  $(RESULTS)/article.pdf"

bench: setup ## measure the speed: docs/benchmarks.md
	$(BIN)/python -m benchmarks
	@echo "Look at  docs/benchmarks.md"

lint: .venv/with-lint ## check style, format, imports, types and words
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/snakefmt --check $(SNAKEFILES)
	$(BIN)/lint-imports
	$(BIN)/mypy
	$(BIN)/python -m tests.words
	@echo "Style, format, imports, types and words are as they should be."

format: .venv/with-lint ## bring the sources into format
	$(BIN)/ruff check --fix
	$(BIN)/ruff format
	$(BIN)/snakefmt $(SNAKEFILES)
	@echo "To see what has changed:  git diff"

setup: .venv/ready ## install what is needed into .venv
	@$(if $(filter setup,$(MAKECMDGOALS)),echo $(READY))

.venv/ready: requirements.lock pyproject.toml
	@for python in $(PYTHON) ""; do \
	    $$python -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || continue; \
	    $$python -c 'import ensurepip, venv' 2>/dev/null && break; \
	    lacking=$$python; \
	done; \
	if [ -z "$$python" ] && [ -n "$$lacking" ]; then \
	    echo "make: error: $$lacking lacks venv: install python3-venv, or set PYTHON" >&2; exit 1; \
	elif [ -z "$$python" ]; then \
	    echo "make: error: no Python 3.11 or newer among: $(PYTHON)" >&2; exit 1; \
	fi; \
	echo "Installing into .venv, once; this takes about a minute."; \
	$$python -m venv --clear .venv
	@$(BIN)/python -m pip uninstall -qq --yes setuptools # unused; newer Pythons do not bring it
	@$(BIN)/python $(PIP) --require-hashes --requirement $<
	@$(BIN)/python $(PIP) --no-deps --no-build-isolation --editable .
	@env -u PYTHONDONTWRITEBYTECODE $(BIN)/python -c "import $(IMPORTED)"
	@touch $@

# what only some need: requirements/*.lock
.venv/with-%: requirements/%.lock .venv/ready
	@echo "Installing what \`$*\` needs into .venv, once."
	@$(BIN)/python $(PIP) --require-hashes --requirement $<
	@touch $@

# apart, since with the plugin installed every snakemake looks for a Slurm first
.venv-slurm/ready: requirements/slurm.lock .venv/ready
	@echo "Installing Snakemake with its plugins for clusters into .venv-slurm, once."
	@$(BIN)/python -m venv --clear .venv-slurm
	@.venv-slurm/bin/python $(PIP) --require-hashes --requirement $<
	@.venv-slurm/bin/python $(PIP) --no-deps --no-build-isolation --editable .
	@touch $@

lock: ## choose and pin the newest versions of all dependencies (needs uv)
	$(LOCK) --upgrade --extra test --output-file requirements.lock
	for extra in article browser docs lint notebook readers; do \
	    $(LOCK) --upgrade --extra $$extra --constraint requirements.lock $(LOCKED) \
	        --output-file requirements/$$extra.lock || exit 1; \
	done
	$(LOCK) --upgrade --extra slurm --output-file requirements/slurm.lock # S3 needs an older python-dateutil
	@echo "To see what has changed:  git diff requirements.lock requirements"

clean: ## remove all results; the environment and the committed figures stay
	rm -rf results logs .snakemake figures/*.pdf docs/_build .pytest_cache .mypy_cache .ruff_cache .import_linter_cache .hypothesis \
	    $(filter-out figures/movies/,$(wildcard figures/*/))
	@echo "All results are gone. To make them again:  make figures"

.PHONY: help article figures report test test-fast extras versions docs notebook bench lint format setup lock clean
.DELETE_ON_ERROR:
