# Every target sets up what it needs; the second time that takes no time.
# Options for the app: make run ARGS="--port 9000 my_paths.csv"

BIN := .venv/bin
ARGS ?=
PYTEST := OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 $(BIN)/python -m pytest
NONE_CHOSEN := [ $$? = 5 ]  # what ARGS choose may all be in the other half
PLAIN := -o addopts="-ra --strict-markers --import-mode=importlib"
LOCK := UV_CUSTOM_COMPILE_COMMAND="make lock" .venv-lock/bin/uv pip compile --quiet --upgrade \
	--generate-hashes --python-version 3.11 --python-platform x86_64-manylinux_2_28
# What is compiled while it is installed has a lock file of its own: a machine without a compiler leaves it out.
COMPILED := movement_primitives
WHEELS := pyproject.toml --group build --extra physics --extra compare --extra study --no-emit-package $(COMPILED)

.PHONY: run test quick check format bench soak fresh wheel lock ready ready-to-test

run: ready  ## open the app
	@OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 exec $(BIN)/gc-teach serve --open $(ARGS)

# A browser draws in software here and wants both cores for itself, so its stories are told one by one;
# pyright uses one core, and so is done beside the other tests.
test: ready-to-test  ## everything but benchmarks and soaks
	$(MAKE) --jobs 2 check quick
	$(PYTEST) -m "not soak and browser" $(ARGS) || $(NONE_CHOSEN)

quick: ready-to-test  ## all tests without a browser
	$(PYTEST) -m "not soak and not browser" -n 2 --dist loadfile --no-loadscope-reorder $(ARGS) || $(NONE_CHOSEN)

check: ready-to-test  ## style and types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/pyright

format: ready-to-test  ## put the style right
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

bench: ready-to-test  ## how long things take
	$(PYTEST) $(PLAIN) --benchmark-only tests/benchmarks $(ARGS)

soak: ready-to-test  ## long and repeated
	$(PYTEST) -m soak $(ARGS)

fresh:  ## `make run` and `make test` of the last commit in a bare Debian; as root
	docker/fresh.sh

wheel: ready-to-test  ## dist/gc_teach-*.whl
	$(BIN)/python -m hatchling build -t wheel -d dist

lock:  ## newest versions that pyproject.toml allows, with hashes
	python3 -m venv .venv-lock
	.venv-lock/bin/pip install --quiet uv
	$(LOCK) $(WHEELS) --output-file requirements.lock
	$(LOCK) $(WHEELS) --extra dev --extra postgres --constraints requirements.lock --output-file requirements-dev.lock
	echo $(COMPILED) | $(LOCK) --no-deps --output-file requirements-compiled.lock -

ready:
	@docker/setup.sh run

ready-to-test:
	@docker/setup.sh test
