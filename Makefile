# make demo   build the NASA Rotor 37 blade from fixtures/ into exports/rotor37
# make test   run the tests
# make consumers  run OpenFOAM on our files; as root on Debian it installs openfoam first
# make check  formatting, lint, types, and the import contract
# make bench  measure speed (tests/benchmarks)
# make lock   write requirements.lock anew from a clean environment
# make clean  remove what these made
#
# Every target sets up .venv by itself; PYTHON=... names another interpreter (3.11 or newer).

BIN   := .venv/bin
STAMP := .venv/.stamp
DEMO  := exports/rotor37

find_python = \
	for python in $(or $(PYTHON),python3 python3.13 python3.12 python3.11 python3.14); do \
		"$$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && break; \
		python=; \
	done; \
	test -n "$$python" || { \
		echo 'bladecad needs Python 3.11 or newer, and no such $(or $(PYTHON),python3) was found;' \
			'install one, or name it: make PYTHON=/path/to/python3.11' >&2; \
		exit 1; \
	}

install = $(1)/pip install --quiet 'pip>=25.1' && $(1)/pip install --quiet --editable . --group dev

.PHONY: demo test consumers check bench lock clean

demo: $(STAMP)
	$(BIN)/bladecad build fixtures/rotor37/sections.csv -o $(DEMO) --tolerance 0.012 --name rotor37 --force
	@echo; echo 'The blade is in $(DEMO):'; ls -1 $(DEMO) | sed 's/^/  /'

test: $(STAMP)
	$(BIN)/pytest -n auto --dist loadfile

consumers: $(STAMP)
	@command -v snappyHexMesh >/dev/null || \
		{ apt-get update -qq && apt-get install -y -qq --no-install-recommends openfoam; } || \
		{ echo 'OpenFOAM is needed, on the path; on Debian: apt-get install openfoam' >&2; exit 1; }
	$(BIN)/pytest tests/consumers -m consumers --durations=0

check: $(STAMP)
	$(BIN)/ruff format --check
	$(BIN)/ruff check
	$(BIN)/mypy
	$(BIN)/lint-imports --no-cache

bench: $(STAMP)
	$(BIN)/pytest tests/benchmarks -o python_files='bench_*.py' --benchmark-columns=min,median,rounds

lock:
	@$(find_python); rm -rf build/lock && mkdir -p build && "$$python" -m venv build/lock
	$(call install,build/lock/bin)
	build/lock/bin/pip freeze --exclude-editable > requirements.lock
	rm -rf build/lock

clean:
	rm -rf .venv build *.egg-info .pytest_cache .mypy_cache .ruff_cache .hypothesis .benchmarks $(DEMO)
	find bladecad tests -name __pycache__ -type d -prune -exec rm -rf {} +

$(STAMP): pyproject.toml requirements.lock
	@$(find_python); test -x $(BIN)/python || "$$python" -m venv .venv
	$(call install,$(BIN)) --constraint requirements.lock
	$(BIN)/python -m bladecad.scans.compiled
	@touch $@
