# The package for JavaScript, in $(BUILD)/javascript: modules, declarations and two binaries, by clang and wasi-libc.
# Included by bindings/bindings.mk.

.PHONY: javascript live

JAVASCRIPT := $(BUILD)/javascript
JAVASCRIPT_PACKAGE := $(JAVASCRIPT)/libmpm
# Between releases the coming one, as packages of other languages have it: docs/developing.md, 5.
PACKAGE_VERSION = $(or $(shell sed -n 's/^## \(.*\) (unreleased)$$/\1-dev/p' CHANGELOG.md),$(VERSION))
WASM_CLANG ?= clang
WASM_AR ?= $(shell command -v llvm-ar || command -v llvm-ar-14)
# A stack of 1 MiB below all data, so that one which overflows is noticed; names of functions are left out.
WASM_LINK := --target=wasm32-wasi -mexec-model=reactor -O2 -Wl,--export-table,--growable-table,--strip-all \
  -Wl,--stack-first,-z,stack-size=1048576
JAVASCRIPT_FILES := $(patsubst bindings/javascript/%,$(JAVASCRIPT_PACKAGE)/%,$(wildcard bindings/javascript/*.mjs) \
  bindings/javascript/libmpm.d.ts bindings/javascript/README.md) \
  $(addprefix $(JAVASCRIPT_PACKAGE)/,package.json LICENSE libmpm.wasm libmpm.simd.wasm)

#: javascript            the package for node and browsers, in $(BUILD)/javascript/libmpm: needs clang, lld, llvm,
#:                       wasi-libc and libclang-rt-dev-wasm32
javascript: $(JAVASCRIPT_FILES)

$(JAVASCRIPT_PACKAGE)/%: bindings/javascript/%
	@mkdir -p $(@D)
	$(Q)cp $< $@
$(JAVASCRIPT_PACKAGE)/LICENSE: LICENSE
	@mkdir -p $(@D)
	$(Q)cp $< $@
$(JAVASCRIPT_PACKAGE)/package.json: bindings/javascript/package.json.in CHANGELOG.md Makefile
	@mkdir -p $(@D)
	$(Q)sed 's/@VERSION@/$(PACKAGE_VERSION)/' $< > $@

# The library for WebAssembly, by this Makefile with another compiler: kernels by -O2, which is as fast and smaller. The
# binary with vectors has its own kernels, and all else from the other one.
WASM_SOURCES := $(PLAIN) $(KERNELS) $(wildcard src/*/*.h) $(HEADERS) src/kernels.txt Makefile platform.mk
WASM_MAKE = +$(Q)$(MAKE) BUILD=$(@D) CC='$(WASM_CLANG) --target=wasm32-wasi' AR='$(WASM_AR)' CPPFLAGS=-DMPM_NO_FILES LDFLAGS= \
  OPT=-O2 KERNEL_OPT=-O2
WASM_KERNELS := $(KERNELS:%.c=$(JAVASCRIPT)/simd/obj/%.baseline.o)

$(JAVASCRIPT)/scalar/libmpm.a: $(WASM_SOURCES)
	$(WASM_MAKE) CFLAGS= $@
$(JAVASCRIPT)/simd/kernels.made: $(WASM_SOURCES)
	@mkdir -p $(@D)
	$(WASM_MAKE) CFLAGS=-msimd128 $(WASM_KERNELS)
	@touch $@
$(JAVASCRIPT)/simd/libmpm.a: $(JAVASCRIPT)/scalar/libmpm.a $(JAVASCRIPT)/simd/kernels.made
	$(Q)cp $< $@
	$(Q)$(WASM_AR) r $@ $(WASM_KERNELS)

define wasm_rule
$(JAVASCRIPT_PACKAGE)/libmpm$(2).wasm: $(JAVASCRIPT)/$(1)/libmpm.a bindings/javascript/exports.txt bindings/javascript/rules.mk
	@mkdir -p $$(@D)
	$$(call SAY,LINK)
	$$(Q)$(WASM_CLANG) $(WASM_LINK) @bindings/javascript/exports.txt $$< -lm -o $$@
endef
$(eval $(call wasm_rule,scalar,))
$(eval $(call wasm_rule,simd,.simd))

# The page, which any server of files can give: `python3 -m http.server -d $(BUILD)/live`.
LIVE := $(BUILD)/live
LIVE_FILES := $(patsubst docs/live/%,$(LIVE)/%,$(wildcard docs/live/*.mjs docs/live/*.html docs/live/*.css)) \
  $(patsubst $(JAVASCRIPT_PACKAGE)/%,$(LIVE)/libmpm/%,$(JAVASCRIPT_FILES))
#: live                  the page of docs/live with the package, in $(BUILD)/live, for any server of files
live: $(LIVE_FILES)
	@echo "python3 -m http.server -d $(LIVE) shows it at http://localhost:8000"

$(LIVE)/libmpm/%: $(JAVASCRIPT_PACKAGE)/%
	@mkdir -p $(@D)
	$(Q)cp $< $@
$(LIVE)/%: docs/live/%
	@mkdir -p $(@D)
	$(Q)cp $< $@
