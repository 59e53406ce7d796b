# `make demo` runs the main job on the embedded field; `make test` passes the tests. Both install what the machine lacks first.
# `make thesis SCALE=ci|full` runs the thesis' experiments and holds its claims against them; killed, it goes on where it was.
.PHONY: demo thesis test bench lint doc build install

FURROW := target/release/furrow

install:
	@scripts/install.sh

build: install
	@echo "== building furrow (a first build takes some minutes)"
	cargo build --release --locked

demo: build
	@scripts/demo.sh $(FURROW)

SCALE ?= ci
thesis: build
	@SCALE=$(SCALE) scripts/thesis.sh $(FURROW)

# What the tests and the browsers they start leave behind, a gigabyte, goes with them. `make test TESTS='--test promises -- road'` runs some.
test: build
	@echo "== running the tests; parts that need data this machine lacks say SKIPPED"
	@scratch=$$(mktemp -d) && trap 'rm -rf "$$scratch"' EXIT && trap 'exit 130' INT TERM && \
	TMPDIR=$$scratch cargo test --release --locked --workspace $(TESTS)

bench: build
	@echo "== measuring against the peers; writes target/bench.json"
	cargo bench --profile release --locked --bench peers --bench field

lint: install
	@echo "== formatting, lints, documentation, licences"
	cargo fmt --all --check
	cargo clippy --release --locked --workspace --all-targets -- -D warnings
	RUSTDOCFLAGS="-D warnings" cargo doc --release --locked --workspace --no-deps
	@scripts/deny.sh

doc: install
	RUSTDOCFLAGS="-D warnings" cargo doc --release --locked --workspace --no-deps --open
