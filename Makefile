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

.PHONY: help demo test bench format tidy asan tsan docs web web-e2e clean deps deps-quality deps-web build

help:  ## print this
	@sed -n 's/^\([a-z0-9-]*\):.*## /  make \1\t/p' $(MAKEFILE_LIST) | expand -t 16

demo: build  ## simulate a drive, localize it, write out/demo
	build/release/bin/nadir demo -o out/demo --overwrite

test: build  ## build and run all tests
	ctest --preset release -j $(JOBS)

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

tidy: deps deps-quality  ## run clang-tidy over the library
	cmake --preset tidy
	tools/tidy.py -j $(JOBS)

asan: deps deps-quality  ## the tests under AddressSanitizer and UndefinedBehaviorSanitizer, slow ones left out
	cmake --preset asan
	cmake --build --preset asan -j $(JOBS)
	ctest --preset asan -j $(JOBS) || tools/rerun_leak_checks.sh asan

tsan: deps  ## the tests that use threads, under ThreadSanitizer
	cmake --preset tsan
	$(NO_ASLR) cmake --build --preset tsan -j $(JOBS)
	$(NO_ASLR) ctest --preset tsan -j $(JOBS)

docs: build  ## write docs/options.md and the figures that the project draws itself
	build/release/bin/nadir config dump --markdown > build/options.md
	cp build/options.md docs/options.md
	build/release/bin/docs_figures docs/images

web: deps-web  ## check, test and build the viewer's page, web/dist
	cd web && npm ci --no-audit --no-fund && npm run check && npm test && npm run build

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
