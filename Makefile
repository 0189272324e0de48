# make          sets up .venv, generates the joint library, prints the operation counts
# make check    sets up .venv and runs every check
# make help     lists the targets

# The interpreter that .venv is made with.
PYTHON ?= python3

BIN := .venv/bin
STAMP := .venv/.stamp
LOCK := .ci/requirements.lock

# The benchmarks have their own environment, so that no other code generator comes near the checks.
BENCH_BIN := .venv-bench/bin
BENCH_STAMP := .venv-bench/.stamp
BENCH_LOCK := .ci/requirements-bench.lock

export PIP_DISABLE_PIP_VERSION_CHECK := 1
unexport PYTHONHOME PYTHONPATH

.DEFAULT_GOAL := all
.DELETE_ON_ERROR:
.NOTPARALLEL:
.SUFFIXES:
.PHONY: all setup generate flops schema check lint types imports test current bench-batch bench-chains bench-engine bench-flags bench-forms bench-peers bench-platform bench-scenes figures-accuracy figures-chain search lock clean help

all: generate flops ## set up, generate the joint library, print the operation counts (default)

setup: $(STAMP) ## set up .venv from the lock

generate: $(STAMP) ## regenerate generated/
	$(BIN)/jointgen generate

flops: $(STAMP) ## print the comparison of operation counts
	$(BIN)/jointgen flops

schema: $(STAMP) ## write the JSON schemas of scene, chain and platform files anew
	$(BIN)/python -c 'from codegen.spec.scene_file.schema import schema_text; print(schema_text(), end="")' \
		> codegen/spec/scene.schema.json
	$(BIN)/python -c 'from codegen.spec.chain_file import schema_text; print(schema_text(), end="")' \
		> codegen/spec/chain.schema.json
	$(BIN)/python -c 'from codegen.spec.platform_file.schema import schema_text; print(schema_text(), end="")' \
		> codegen/spec/platform.schema.json

check: lint types imports test ## run every check, stop at the first that fails

lint: $(STAMP) ## ruff: rules and format
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(STAMP) ## mypy, strict
	$(BIN)/mypy

imports: $(STAMP) ## import-linter: imports point one way
	$(BIN)/lint-imports

test: $(STAMP) ## pytest on two cores; make test ARGS='-k lower'
	$(BIN)/pytest -n 2 $(ARGS)

current: $(STAMP) ## fail if generated/ is not what would be generated now
	$(BIN)/jointgen generate --check

search: $(STAMP) ## search long for the cheapest routines, put what is found on record; then make generate
	$(BIN)/python -m benchmarks.search $(ARGS)

bench-batch: $(STAMP) ## time the batch routines, write benchmarks/batch/results.md and .json
	$(BIN)/python -m benchmarks.batch $(ARGS)

bench-engine: $(BENCH_STAMP) ## run the in-line engine, also in other programs; benchmarks/engine/results.md and charts
	$(BENCH_BIN)/python -m benchmarks.engine $(ARGS)

bench-flags: $(STAMP) ## time the routines under compiler flags, with and without --fma
	$(BIN)/python -m benchmarks.flags.measure

bench-forms: $(STAMP) ## scenes by conventional, parametric and relative coordinates; make bench-forms ARGS='--scene four_bar'
	$(BIN)/python -m benchmarks.forms $(ARGS)

bench-chains: $(BENCH_STAMP) ## the routines of chains beside a recursion that reads a table
	$(BENCH_BIN)/python -m benchmarks.chain_speed $(ARGS)

bench-peers: $(BENCH_STAMP) ## lay our routines beside other code generators; make bench-peers ARGS='--joints ball'
	$(BENCH_BIN)/python -m benchmarks.peers $(ARGS)

bench-platform: $(STAMP) ## velocity indices beside numpy, Eigen and CasADi's C; make bench-platform ARGS='--rounds 20'
	$(BIN)/python -m benchmarks.platforms $(ARGS)

bench-scenes: $(STAMP) ## straight-line code against loops for 1 to 1000 mechanisms; make bench-scenes ARGS='--sets 20'
	$(BIN)/python -m benchmarks.scenes $(ARGS)

figures-accuracy: $(STAMP) ## measure the trade of accuracy and speed, draw the figures of docs/accuracy.md
	$(BIN)/python -m benchmarks.accuracy $(ARGS)

figures-chain: $(STAMP) ## run the simulations of S2 and draw them into docs/
	$(BIN)/python -m benchmarks.chains $(ARGS)

lock: $(STAMP) ## pin the dependencies anew; make lock ARGS=--upgrade takes the newest
	$(BIN)/pip-compile --quiet --generate-hashes --allow-unsafe --strip-extras --no-header --no-emit-options \
		--extra dask --extra measure --extra import --extra simulate --extra dev $(ARGS) --output-file $(LOCK) pyproject.toml .ci/requirements.in
	$(BIN)/pip-compile --quiet --generate-hashes --allow-unsafe --strip-extras --no-header --no-emit-options \
		--extra measure --extra simulate --extra bench --constraint $(LOCK) $(ARGS) --output-file $(BENCH_LOCK) pyproject.toml .ci/requirements.in
	@for lock in $(LOCK) $(BENCH_LOCK); do \
		printf '%s\n' '# Pinned by "make lock" for Python 3.11 on Linux x86_64. Do not edit.' | cat - $$lock > $$lock.new; \
		mv $$lock.new $$lock; \
	done

clean: ## remove .venv, caches and build products; generated/ stays
	rm -rf .venv .venv-bench build dist *.egg-info .hypothesis .import_linter_cache .mypy_cache .pytest_cache .ruff_cache
	find . -name .git -prune -o -name __pycache__ -type d -prune -exec rm -rf {} +

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-12s %s\n", $$1, $$2 }' Makefile

# A usable .venv is brought up to date; a missing, broken or too old one is made anew.
USABLE = import pip, sys; sys.exit(sys.version_info < (3, 11))

$(STAMP): $(LOCK) pyproject.toml
	@if ! $(BIN)/python -c '$(USABLE)' 2>/dev/null; then \
		command -v $(PYTHON) >/dev/null || \
			{ echo 'error: $(PYTHON) is not installed; remedy: apt-get install python3 python3-venv' >&2; exit 1; }; \
		$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
			{ echo "error: $(PYTHON) is $$($(PYTHON) --version 2>&1), jointgen needs 3.11 or newer;" \
				'remedy: install one and name it, make PYTHON=python3.11' >&2; exit 1; }; \
		$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || \
			{ echo 'error: $(PYTHON) cannot make virtual environments; remedy: apt-get install python3-venv' >&2; exit 1; }; \
		echo 'Making .venv with' "$$($(PYTHON) --version)"; \
		$(PYTHON) -m venv --clear .venv; \
	fi
	$(BIN)/python -m pip install -q --require-hashes -r $(LOCK)
	$(BIN)/python -m pip install -qq --no-deps --no-build-isolation -e .
	@touch $@

# A peer that cannot be installed is left out by the benchmark; everything else must be there.
$(BENCH_STAMP): $(BENCH_LOCK) $(STAMP)
	@if ! $(BENCH_BIN)/python -c '$(USABLE)' 2>/dev/null; then $(BIN)/python -m venv --clear .venv-bench; fi
	$(BIN)/python benchmarks/install.py $(BENCH_BIN)/python $(BENCH_LOCK)
	$(BENCH_BIN)/python -m pip install -qq --no-deps --no-build-isolation -e .
	@touch $@
