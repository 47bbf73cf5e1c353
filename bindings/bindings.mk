# The bindings of other languages, included by the Makefile at the top of the sources, from where all paths start.

.PHONY: api check-bindings bindings-setup measure-bindings check-newcomers

#: api                   bindings/api.json and what bindings of all languages take from it, from the headers, by clang
api:
	@python3 bindings/generate/generate.py

#: check-bindings        whether these are as the headers are, and each language's own tests: docs/bindings.md. Missing tools
#:                       are installed on Debian, and a failure elsewhere, unless SKIP_MISSING=1; LANGUAGES="python rust" selects
#: bindings-setup        installs what check-bindings needs, on Debian
BINDINGS_PACKAGES := clang lld llvm wasi-libc libclang-rt-dev-wasm32 gfortran cargo mono-mcs chromium python3-dev \
  python3-venv python3-numpy python3-numba python3-matplotlib
# another distribution of Node.js than Debian's brings its own npm, and refuses Debian's
bindings-setup:
	@sudo=; if [ "$$(id -u)" != 0 ]; then sudo=sudo; fi; node=; command -v npm > /dev/null || node='nodejs npm'; \
	$$sudo apt-get update -q && \
	$$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $(BINDINGS_PACKAGES) $$node

SKIP_MISSING ?=
LANGUAGES ?= $(sort $(patsubst bindings/%/check.sh,%,$(wildcard bindings/*/check.sh)))
check-bindings: all
	@mkdir -p $(BUILD)/tests/scratch
	@python3 bindings/generate/generate.py --check
	@env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL $(TEST_ENVIRONMENT) JOBS=$(JOBS) SKIP_MISSING=$(SKIP_MISSING) bash bindings/check.sh $(LANGUAGES)

#: measure-bindings      what calls and callbacks cost in each language: docs/bindings.md; COSTS="c rust" selects
COSTS ?= c fortran rust csharp javascript python
measure-bindings: all
	@mkdir -p $(BUILD)/tests/scratch
	@env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL $(TEST_ENVIRONMENT) bash bindings/costs/run.sh $(COSTS)

#: check-newcomers       what the README of each language tells to type, in a root with nothing but Debian's base, as root by
#:                       debootstrap, some minutes for each; NEWCOMERS="python rust" selects
NEWCOMERS ?= csharp fortran javascript python rust
check-newcomers:
	@env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL bash bindings/newcomer.sh $(abspath $(BUILD))/newcomers $(NEWCOMERS)

include bindings/javascript/rules.mk
