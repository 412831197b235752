# SPDX-License-Identifier: Apache-2.0
# A thin front to CMake's presets. On a fresh Debian 12 it needs make alone: what is missing is
# installed from tools/apt-packages.txt.

JOBS ?= $(shell nproc)
# Used where it is installed; CMake reads the variable from the environment.
export CMAKE_CXX_COMPILER_LAUNCHER ?= $(shell command -v ccache)
# One cache serves every checkout and build folder.
export CCACHE_BASEDIR ?= $(CURDIR)
export CCACHE_NOHASHDIR ?= 1
# ThreadSanitizer cannot place its shadow memory where the kernel randomises addresses too widely.
NO_ASLR := $(shell setarch -R true 2>/dev/null && echo setarch -R)

# Of `make tidy`: --all looks at every source. Of `make fuzz`: seconds for each target, and which share of the targets.
TIDY ?=
FUZZ_SECONDS ?= 60
FUZZ_PART ?= 1/1
# Of `make nightly`: PARTS=tidy,web and BUDGET=60 (minutes).
PARTS ?=
BUDGET ?=

.PHONY: help demo test program bench format tidy asan asan-all tsan scalar fuzz nightly docs web web-e2e clean deps deps-quality deps-web build

help:  ## print this
	@sed -n 's/^\([a-z0-9-]*\):.*## /  make \1\t/p' $(MAKEFILE_LIST) | expand -t 16

demo: build  ## simulate a drive, localize it, write out/demo
	build/release/bin/nadir demo -o out/demo --overwrite

test: build  ## build and run all tests
	ctest --preset release -j $(JOBS)

program: deps  ## build the program and test it from the outside: whole runs, packaging
	cmake --preset release
	cmake --build --preset program -j $(JOBS)
	ctest --preset program -j $(JOBS)

bench: build  ## measure against peers, write benchmarks/reports/DATE-peers.md; with NADIR_DATA, both mappings too
	benchmarks/peers_report.py $(if $(NADIR_DATA),--data $(NADIR_DATA))
	build/release/bin/matching_bench
	build/release/bin/simulation_bench
ifdef NADIR_DATA
	build/release/bin/ground_mapping_bench $(NADIR_DATA)
	build/release/bin/aerial_mapping_bench $(NADIR_DATA)/brighton_beach/images
endif

format: deps-quality  ## format every C++ file in place
	git ls-files '*.cpp' '*.hpp' '*.cu' '*.cuh' | xargs clang-format -i

tidy: deps deps-quality  ## run clang-tidy over what changed since tools/tidy-base.txt; TIDY=--all: over everything
	cmake --preset tidy
	tools/tidy.py -j $(JOBS) $(TIDY)

asan: deps deps-quality  ## the unit tests under AddressSanitizer and UndefinedBehaviorSanitizer
	cmake --preset asan
	cmake --build --preset asan -j $(JOBS)
	ctest --preset asan -j $(JOBS) || tools/rerun_leak_checks.sh asan

asan-all: deps deps-quality  ## all tests under them, whole runs of the program too: an hour
	cmake --preset asan
	cmake --build build/asan -j $(JOBS)
	ctest --preset asan-all -j $(JOBS) || tools/rerun_leak_checks.sh asan-all

tsan: deps  ## the tests that use threads, under ThreadSanitizer
	cmake --preset tsan
	$(NO_ASLR) cmake --build --preset tsan -j $(JOBS)
	$(NO_ASLR) ctest --preset tsan -j $(JOBS)

scalar: deps  ## the tests of the matching without SIMD
	cmake --preset scalar
	cmake --build --preset scalar -j $(JOBS)
	ctest --preset scalar -j $(JOBS)

fuzz: deps deps-quality  ## fuzz every reader, FUZZ_SECONDS=60 each; FUZZ_PART=1/6: the first sixth of them
	cmake --preset fuzz
	cmake --build --preset fuzz -j $(JOBS)
	tools/fuzz.py --seconds $(FUZZ_SECONDS) --part $(FUZZ_PART) --jobs $(JOBS)

nightly:  ## what .ci/run leaves out, in parts: PARTS=tidy,web, BUDGET=60 minutes; benchmarks/reports/*-nightly.md
	tools/nightly.py $(if $(PARTS),--parts $(PARTS)) $(if $(BUDGET),--budget $(BUDGET))

docs: build  ## write docs/options.md and the figures that the project draws itself
	build/release/bin/nadir config dump --markdown > build/options.md
	cp build/options.md docs/options.md
	build/release/bin/docs_figures docs/images

web: deps-web  ## check, test and build the viewer's page, web/dist
	cd web && npm ci --no-audit --no-fund && npm run check && npm test && npm run build
	tools/web_sources.sh --write

web-e2e: build web  ## the viewer in a headless Chromium, on a small simulated run
	tools/web_e2e.sh

clean:  ## remove what was built and what the demo wrote
	rm -rf build out

build: deps
	cmake --preset release
	cmake --build --preset release -j $(JOBS)

deps:
	@tools/install-deps.sh

deps-quality:
	@tools/install-deps.sh --quality

deps-web:
	@tools/install-deps.sh --web
