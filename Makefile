# The front door. Every target works in a fresh clone; CMakePresets.json holds the builds behind it.

SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
.NOTPARALLEL:
MAKEFLAGS += --no-print-directory

space := $(subst ,, )
JOBS ?= $(shell nproc 2>/dev/null || echo 2)
ifneq ($(shell command -v ccache),)
export CMAKE_CXX_COMPILER_LAUNCHER ?= ccache
endif

# $(call build,PRESET[,TARGET])
build = cmake --preset $(1) > /dev/null && cmake --build --preset $(1) --parallel $(JOBS) $(if $(2),--target $(2))
# One more than cores: some tests wait for a signal or another process.
ctest = ctest --parallel $(shell expr $(JOBS) + 1) --no-tests=error
# Thread sanitizer wants an address space that is not shuffled too far; not every container may ask for that.
unshuffled = $$(setarch -R true 2> /dev/null && echo setarch -R || true)

.PHONY: check-all blender deb tables site page page-test python python-asan wheel notebooks help demo test test-long build bench format tidy docs proofs check asan tsan fuzz install-packages clean

help:  ## this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-17s %s\n", $$1, $$2 }' $(firstword $(MAKEFILE_LIST))

# A fresh clone builds the command alone, without the libraries of tests; where they are configured their objects serve.
demo_preset = $(if $(wildcard build/release/CMakeCache.txt),release,demo)
python_preset = $(if $(wildcard build/release/CMakeCache.txt),release,python)
demo:  ## two surfaces: do they touch? and a picture of them, build/demo.png; after make page a page of them, build/demo.html
	@scripts/install_packages build
	@$(call build,$(demo_preset),snug_command snug_check)
	@scripts/demo build/$(demo_preset)/bin/snug build/demo.png
	@$(if $(wildcard build/web/snug.html),$(MAKE) build/demo.html,\
	  echo "A page to move the parts in: make page, then make demo again")

.PHONY: build/demo.html
build/demo.html:
	@$(MAKE) page > build/page.log 2>&1 || { tail -20 build/page.log >&2; exit 1; }
	@scripts/demo_page build/$(demo_preset)/bin/snug build/web/snug.html $@

test: install-packages build  ## every test, on the release build
	@$(ctest) --preset release
	@echo "Not among them: comparisons with other programs, packages, the page in a browser; make check-all runs these, too"

page:  ## snug in a browser: build/web/snug.html, and the package for JavaScript, build/web/package
	@scripts/install_packages build page
	@$(call build,web)
	@web/build build/web

page-test: page  ## the package against the command, bit by bit, and the page in Chromium
	@$(call build,$(demo_preset),snug_command)
	@SNUG=build/$(demo_preset)/bin/snug web/test build/web

test-long: install-packages build  ## the random tests with many more cases (docs/debugging.md), then every test with address sanitizer
	@SNUG_PLACEMENTS=20000 $(ctest) --preset release
	@SNUG_PARTS=1000 build/release/bin/tests/query_test --gtest_filter='sharp_parts.*'
	@SNUG_PLACEMENTS=150000 build/release/bin/tests/sound_test --gtest_filter='solids.*'
	@SNUG_PLACEMENTS=1000000 build/release/bin/tests/sound_test --gtest_filter='signed_distance.*'
	@$(call build,asan)
	@$(ctest) --test-dir build/asan --output-on-failure

deb:  ## Debian packages of the command, the library and the module for Python: build/deb/packages
	@scripts/install_packages build python deb
	@scripts/build_deb

site:  ## the documentation as a site that needs no server: build/site/index.html; with the live page, the reference for Python and outputs of notebooks after make page, make python, make notebooks
	@scripts/install_packages docs
	@scripts/build_site

python:  ## the Python module: build/release/python, or build/python/python where nothing else is built
	@scripts/install_packages build python
	@$(call build,$(python_preset),snug_python)
	@echo "The module is staged: export PYTHONPATH=$$PWD/build/$(python_preset)/python"

wheel:  ## the same as a wheel: build/wheel
	@scripts/install_packages build python wheel
	@mkdir -p build/wheel && cd python && /usr/bin/python3 -c "import build_backend; print('build/wheel/' + build_backend.build_wheel('../build/wheel'))"

blender:  ## the extension for Blender, with the wheel inside: build/snug_blender.zip
	@scripts/install_packages build python wheel
	@mkdir -p build/wheel && rm -f build/wheel/*.whl && cd python && /usr/bin/python3 -c "import build_backend; build_backend.build_wheel('../build/wheel')"
	@blender/build build/wheel/*.whl build/snug_blender.zip

notebooks: python  ## executes the notebooks: build/notebooks
	@scripts/install_packages notebooks
	@scripts/run_notebooks "$$PWD/build/$(python_preset)/python" "$$PWD/build/notebooks" $(wildcard build/$(python_preset)/bin/snug)

python-asan: install-packages  ## the tests of the Python module under address and undefined-behaviour sanitizer
	@$(call build,asan,snug_python snug_check)
	@$(ctest) --preset asan -L python

build:  ## the library, the command, the tests: build/release
	@$(call build,release)

bench: peers  ## the measurements of bench/
	@bench/run

.PHONY: peers
peers:  ## builds the measurements and the comparisons with other programs, in build/release
	@scripts/install_packages build test bench python
	@$(call build,bench)

tables: peers  ## docs/tables.md, measured anew: some minutes on a quiet machine
	@scripts/write_tables build/release/bin/snug-research

asan: install-packages  ## the fast tests under address and undefined-behaviour sanitizer; ASAN_ROOMS="io mesh": those of these folders; ASAN_WITHOUT: a pattern of names
	@$(call build,asan,$(or $(ASAN_ROOMS:%=%_test),tests_fast))
	@$(ctest) --preset asan -L fast -R "^($(subst $(space),|,$(or $(strip $(ASAN_ROOMS)),.*)))[.]" \
	  $(if $(ASAN_WITHOUT),-E '$(ASAN_WITHOUT)')

tsan: install-packages  ## the tests of threads under thread sanitizer
	@$(call build,tsan,threads_test)
	@$(unshuffled) $(ctest) --preset tsan -L threads --repeat until-fail:$(or $(TSAN_REPEAT),3)

fuzz: install-packages  ## the readers on made-up files, FUZZ_SECONDS (600) each
	@$(call build,asan,fuzzers)
	@JOBS=$(JOBS) scripts/fuzz

check:  ## every gate that a commit must pass
	@bash .ci/run

check-all:  ## these, and what changes rarely: other programs, packages, the page in Chromium, notebooks, the site, more random cases
	@bash .ci/run all

format:  ## rewrite C++ files in the project's format
	@scripts/check_format --fix

tidy: install-packages  ## clang-tidy over the library
	@cmake --preset dev > /dev/null
	@run-clang-tidy -quiet -j $(JOBS) -p build/dev 'src/snug/.*\.cpp$$'

# Pictures for bright pages and for dark ones.
lights = SNUG=$(CURDIR)/build/release/bin/snug

docs: install-packages  ## plots and tables of docs/convergence.md, pictures of README.md, docs/schemes.md, docs/meshes.md, docs/manufacturing.md, docs/rays.md, docs/gallery.md, docs/nodal_functions.md, docs/figures.md and docs/independence.md; links and citations
	@$(call build,release,snug_command snug_research)
	@scripts/install_packages docs
	@mkdir -p build/docs
	@for name in rates tightness; do build/release/bin/snug-research $$name -o build/docs/$$name.json > /dev/null; done
	@for scheme in catmark doo-sabin midedge; do \
	  build/release/bin/snug-research rates --scheme $$scheme -o build/docs/$$scheme.json > /dev/null; done
	@for scheme in loop catmark; do for place in boundary corner crease dart; do \
	  build/release/bin/snug-research rates --scheme $$scheme --at $$place --levels 36 -o build/docs/$$scheme-$$place.json > /dev/null; done; \
	  build/release/bin/snug-research rates --scheme $$scheme --at semi-sharp -o build/docs/$$scheme-semi-sharp.json > /dev/null; done
	@scripts/plot_experiments.py build/docs docs/convergence.md docs/pictures
	@rm -rf build/lights && mkdir build/lights && ln -s ../../scripts/both_lights build/lights/snug && ln -s ../release/bin/snug-check ../release/bin/snug-research build/lights
	@$(lights) scripts/draw_schemes build/lights/snug docs/pictures
	@$(lights) scripts/draw_meshes build/lights/snug docs/pictures
	@$(lights) scripts/run_page build/lights/snug docs/manufacturing.md docs/pictures
	@[ ! -x build/release/bin/bench_wraps ] || scripts/draw_wraps build/release/bin/snug build/release/bin/bench_wraps docs/pictures  # with CGAL, by make bench
	@$(lights) scripts/draw_nodal build/lights/snug docs/pictures
	@$(lights) scripts/draw_rays build/lights/snug docs/pictures
	@scripts/draw_independence build/release/bin/snug-research docs/pictures
	@$(lights) scripts/draw_dissertation build/lights/snug docs/pictures
	@$(lights) scripts/draw_examples build/release docs/pictures build/lights/snug
	@$(lights) scripts/run_page build/lights/snug docs/gallery.md docs/pictures
	@$(lights) scripts/demo build/lights/snug docs/pictures/demo.png > /dev/null
	@scripts/check_docs.py

proofs:  ## what certificates rest on, checked by Coq: build/proofs
	@scripts/install_packages proofs
	@mkdir -p build/proofs && cp -u proofs/_CoqProject proofs/*.v build/proofs
	@cd build/proofs && coq_makefile -f _CoqProject -o Makefile && $(MAKE)
	@cd build/proofs && coqc -Q . Snug Assumptions.v | diff ../../proofs/assumptions.txt - && echo "proofs: all hold, on the axioms of Coq's reals alone"

install-packages:  ## what building, testing and checking need, where it is missing (scripts/packages.txt has it in sections)
	@scripts/install_packages build test mpi python gates fuzz

clean:  ## remove build/
	@rm -rf build
