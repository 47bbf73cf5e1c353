# The bindings of other languages, included by the Makefile at the top of the sources, from where all paths start.

.PHONY: api check-bindings

#: api                   bindings/api.json and what bindings of all languages take from it, from the headers, by clang
api:
	@python3 bindings/generate/generate.py

#: check-bindings        whether these are as the headers are, and each language's own tests: docs/bindings.md.
#:                       LANGUAGES="python rust" selects
LANGUAGES ?= $(sort $(patsubst bindings/%/check.sh,%,$(wildcard bindings/*/check.sh)))
check-bindings: all
	@mkdir -p $(BUILD)/tests/scratch
	@python3 bindings/generate/generate.py --check
	@for language in $(LANGUAGES); do \
	  echo "bindings/$$language/check.sh"; \
	  env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL $(TEST_ENVIRONMENT) JOBS=$(JOBS) bash bindings/$$language/check.sh || exit 1; done

include bindings/javascript/rules.mk
