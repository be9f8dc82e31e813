# From a fresh clone, with Python 3.11 or newer and nothing else: `make figures`, `make test`.

# candidates, the first that is there and new enough is taken; or name one: make PYTHON=... figures
PYTHON ?= python3.11 python3.12 python3.13 python3.14 python3
JOBS ?= 2
SCALE ?= paper
REPORTED ?= figures
SNAKEFILES := Snakefile rules
BIN := .venv/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check install -qq
LOCK := uv pip compile --quiet --generate-hashes --no-emit-index-url --no-header --universal \
    --python-version 3.11 pyproject.toml
EXTRA_TESTS := slow or remedy or browser or slurm

help: ## say what there is to make
	@grep -hE '^[a-z]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z]+):.*## /  make \1\t/' | expand -t 18

figures: setup ## simulate, and draw the four figures of the paper
	$(BIN)/snakemake -j$(JOBS) figures
	@echo
	@echo "Look at  figures/fig1a.png  figures/fig1b.png  figures/fig2a.png  figures/fig2b.png"
	@echo "What the paper claims, and what we find:  results/paper/claims.md"
	@echo "Every number in them:  results/paper/R.csv"
	@echo "Every point, to click on, and one file to share:  make report"

report: setup ## one HTML file with all that REPORTED has (default: figures), and an interactive page
	$(BIN)/snakemake -j$(JOBS) --config scale=$(SCALE) -- $(REPORTED) explore living
	$(BIN)/snakemake --config scale=$(SCALE) --report results/$(SCALE)/report.html -- $(REPORTED)
	@echo
	@echo "Look at  results/$(SCALE)/report.html  results/$(SCALE)/explore.html  results/$(SCALE)/living.html:"
	@echo "each is one file, to be sent as it is. More in the first: make REPORTED='figures extensions' report"

plan: setup ## say what all experiments at SCALE will cost, from pilot runs
	$(BIN)/snakemake -j$(JOBS) --quiet all --config scale=$(SCALE) -- plan
	@cat results/$(SCALE)/plan.md

test: setup ## run the tests, but for those of `make extras`
	$(BIN)/python -m pytest -n $(JOBS) --dist loadfile --no-loadscope-reorder -m "not ($(EXTRA_TESTS))"

extras: .venv/with-browser .venv-slurm/ready ## run what takes minutes more, a browser, or Slurm
	$(BIN)/python -m pytest -n $(JOBS) --dist loadfile -m "$(EXTRA_TESTS)"

docs: .venv/with-docs ## run the tutorial, and build the documentation: docs/_build/html/index.html
	$(BIN)/python -m sphinx --fresh-env --fail-on-warning --keep-going -q docs docs/_build/html

bench: setup ## measure the speed: docs/benchmarks.md
	$(BIN)/python -m benchmarks

lint: setup ## check style and format
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/snakefmt --check $(SNAKEFILES)
	$(BIN)/lint-imports

format: setup ## bring the sources into format
	$(BIN)/ruff check --fix
	$(BIN)/ruff format
	$(BIN)/snakefmt $(SNAKEFILES)

setup: .venv/ready ## install what is needed into .venv

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
	@$(PIP) --require-hashes --requirement requirements.lock
	@$(PIP) --no-deps --no-build-isolation --editable .
	@touch $@

# what only some need: requirements/*.lock
.venv/with-%: requirements/%.lock .venv/ready
	@echo "Installing what \`$*\` needs into .venv, once."
	@$(PIP) --require-hashes --requirement $<
	@touch $@

# apart, since with the plugin installed every snakemake looks for a Slurm first
.venv-slurm/ready: requirements/slurm.lock .venv/ready
	@echo "Installing Snakemake with its Slurm plugin into .venv-slurm, once."
	@$(BIN)/python -m venv --clear .venv-slurm
	@.venv-slurm/bin/python -m pip --disable-pip-version-check install -qq --require-hashes --requirement $<
	@.venv-slurm/bin/python -m pip --disable-pip-version-check install -qq --no-deps --no-build-isolation --editable .
	@touch $@

lock: ## choose and pin the newest versions of all dependencies (needs uv)
	$(LOCK) --upgrade --extra dev --output-file requirements.lock
	$(LOCK) --upgrade --extra docs --constraint requirements.lock --output-file requirements/docs.lock
	$(LOCK) --upgrade --extra browser --constraint requirements.lock --output-file requirements/browser.lock
	$(LOCK) --upgrade --extra slurm --constraint requirements.lock --output-file requirements/slurm.lock

clean: ## remove all results; the environment and the committed figures stay
	rm -rf results logs .snakemake figures/*.pdf docs/_build .pytest_cache .ruff_cache .import_linter_cache .hypothesis \
	    $(filter-out figures/movies/,$(wildcard figures/*/))

.PHONY: help figures report plan test extras docs bench lint format setup lock clean
.DELETE_ON_ERROR:
