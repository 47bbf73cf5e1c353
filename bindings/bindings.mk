# The bindings of other languages, included by the Makefile at the top of the sources, from where all paths start.

.PHONY: api check-bindings bindings-setup measure-bindings check-newcomers

#: api                   bindings/api.json and what bindings of all languages take from it, from the headers, by clang
api:
	@python3 bindings/generate/generate.py

#: check-bindings        whether these are as the headers are, and each language's own tests: docs/bindings.md. A missing
#:                       tool is a failure, unless SKIP_MISSING=1; LANGUAGES="python rust" selects
#: bindings-setup        installs what check-bindings needs, on Debian
BINDINGS_PACKAGES := clang lld llvm wasi-libc libclang-rt-dev-wasm32 gfortran cargo mono-mcs nodejs npm chromium python3-dev \
  python3-venv python3-numpy python3-numba python3-matplotlib
bindings-setup:
	@sudo=; if [ "$$(id -u)" != 0 ]; then sudo=sudo; fi; \
	$$sudo apt-get update -q && \
	$$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $(BINDINGS_PACKAGES)

# A check that lacks its tools ends with status 77.
SKIP_MISSING ?=
LANGUAGES ?= $(sort $(patsubst bindings/%/check.sh,%,$(wildcard bindings/*/check.sh)))
check-bindings: all
	@mkdir -p $(BUILD)/tests/scratch
	@python3 bindings/generate/generate.py --check
	@missing=; for language in $(LANGUAGES); do \
	  echo "bindings/$$language/check.sh"; status=0; \
	  env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL $(TEST_ENVIRONMENT) JOBS=$(JOBS) bash bindings/$$language/check.sh || status=$$?; \
	  case $$status in 0) ;; 77) missing="$$missing $$language" ;; *) exit 1 ;; esac; done; \
	if [ -n "$$missing" ]; then \
	  echo "check-bindings: for want of tools not, or not wholly, checked:$$missing" >&2; \
	  [ "$(SKIP_MISSING)" = 1 ] || { echo 'check-bindings: make bindings-setup installs them on Debian; SKIP_MISSING=1 does without, LANGUAGES selects' >&2; exit 1; }; fi

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
