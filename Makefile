# make demo      the main job on the simulated field: record, ingest, run an experiment, write a report
# make test      all tests; make test TESTS='--test promises -- kill_9' runs some
# make install   build, and install the command with completions and manual pages below PREFIX
# make packages  the Debian packages that building and the tests need, by apt; the others call it themselves
# make thesis    the thesis' experiments, SCALE=ci or full, and its claims held against them
# make bench     speed beside the published figures of other programs
# make lint      formatting, clippy, rustdoc, licences, widths of comments
# make doc       the crates' documentation, in a browser
.PHONY: demo thesis test bench lint doc build install packages build-packages

FURROW := target/release/furrow

packages:
	@scripts/packages.sh all

build-packages:
	@scripts/packages.sh build

build: build-packages
	@echo "== building furrow (a first build takes some minutes)"
	cargo build --release --locked

install: build-packages
	@PREFIX="$(PREFIX)" scripts/install.sh

demo: build
	@scripts/demo.sh $(FURROW)

SCALE ?= ci
thesis: build
	@SCALE=$(SCALE) scripts/thesis.sh $(FURROW)

# The tests and the browsers that they start leave a gigabyte of temporary files: it is removed with their folder.
test: packages build
	@echo "== running the tests; parts that need data this machine lacks say SKIPPED"
	@scratch=$$(mktemp -d) && trap 'rm -rf "$$scratch"' EXIT && trap 'exit 130' INT TERM && \
	TMPDIR=$$scratch cargo test --release --locked --workspace $(TESTS)

bench: build
	@echo "== measuring against the peers; writes target/bench.json"
	cargo bench --profile release --locked --bench peers --bench field

lint: build-packages
	@echo "== formatting, lints, documentation, licences, widths of comments"
	cargo fmt --all --check
	cargo clippy --release --locked --workspace --all-targets -- -D warnings
	RUSTDOCFLAGS="-D warnings" cargo doc --release --locked --workspace --no-deps
	@scripts/deny.sh
	@scripts/comments.sh

doc: build-packages
	RUSTDOCFLAGS="-D warnings" cargo doc --release --locked --workspace --no-deps --open
