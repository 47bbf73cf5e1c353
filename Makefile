# libmpm: shared and static library, tests, examples.
#
#   make                 both libraries in $(BUILD)
#   make install         PREFIX=/usr/local, DESTDIR=
#   make check           unit tests, state hashes, interface tests, examples, verify-quick (needs Check and pkg-config: make check-setup)
#   make verify          the method against exact solutions, with a table of gates: docs/verification.md
#   make demo            one example, with nothing but a C compiler
#
# V=1 shows the commands. CFLAGS and LDFLAGS are the user's; OPT and KERNEL_OPT, which come after CFLAGS, set
# the optimisation.

VERSION := 0.1.0
SONAME := libmpm.so.0
SHARED := libmpm.so.$(VERSION)

PREFIX ?= /usr/local
LIBDIR ?= $(PREFIX)/lib
INCLUDEDIR ?= $(PREFIX)/include
DESTDIR ?=
BUILD ?= build
CC ?= cc
CXX ?= g++
CFLAGS ?= -g
CXXFLAGS ?= $(CFLAGS)
OPT ?= -O2
KERNEL_OPT ?= -O3
WERROR ?= -Werror
PKG_CONFIG ?= pkg-config
ifndef V
Q := @
SAY = @echo '  $(1) $@'
endif

WARNINGS := -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wdouble-promotion $(WERROR)
CXX_WARNINGS := -Wall -Wextra -Wpedantic -Wshadow $(WERROR)
COMMON = -std=c11 -MMD -MP -Iinclude -Isrc $(WARNINGS) $(CPPFLAGS) $(CFLAGS)
LIBRARY = $(COMMON) -fPIC -fvisibility=hidden
LIBS := -lm -lpthread

# ---- sources ---------------------------------------------------------------------------------------------
# Kernels are compiled once for each instruction set, with contraction to fused multiply-add; all other files
# once, without it, so that only the kernels' results depend on the instruction set.
KERNEL_PATTERNS := src/transfer/bspline*.c src/transfer/open_bspline*.c src/transfer/gimp.c \
  src/transfer/scatter.c src/transfer/gather.c src/transfer/stiffness.c \
  src/transfer/box.c src/transfer/update.c src/transfer/advance.c src/transfer/survey.c \
  src/transfer/kernels.c src/material/law_*.c src/linalg/dense.c src/linalg/sweep.c
KERNELS := $(sort $(wildcard $(KERNEL_PATTERNS)))
PLAIN := $(filter-out $(KERNELS),$(sort $(wildcard src/*/*.c)))
HEADERS := $(sort $(wildcard include/mpm/*.h include/mpm/*.hpp))

ISAS := baseline
ifneq (,$(findstring x86_64,$(shell $(CC) -dumpmachine)))
ISAS += avx2 avx512
endif
ISA_baseline :=
ISA_avx2 := -mavx2 -mfma
ISA_avx512 := -mavx512f -mavx512vl -mavx512dq -mavx2 -mfma -mprefer-vector-width=512
# Of kernels debuggers are told the lines only: to follow all of their variables takes compilers minutes.
KERNEL_FLAGS = $(KERNEL_OPT) -ffp-contract=fast -fno-math-errno -fno-trapping-math -Wno-psabi $(if $(filter -g,$(CFLAGS)),-g1)

OBJECTS := $(PLAIN:%.c=$(BUILD)/obj/%.o) $(foreach isa,$(ISAS),$(KERNELS:%.c=$(BUILD)/obj/%.$(isa).o))
STATIC_LIB := $(BUILD)/libmpm.a
SHARED_LIB := $(BUILD)/$(SHARED)

# Two examples show CHOLMOD and PETSc as the host's solver, where these are installed.
HAS_CHOLMOD := $(shell $(CC) -E -include suitesparse/cholmod.h -x c /dev/null > /dev/null 2>&1 && echo yes)
PETSC_PACKAGES := $(shell $(PKG_CONFIG) --exists PETSc mpi-c 2> /dev/null && echo PETSc mpi-c)
EXAMPLES := $(patsubst examples/%,$(BUILD)/examples/%,$(basename $(sort $(wildcard examples/*.c examples/*.cpp))))
BENCH := $(BUILD)/bench/bench
ifneq ($(HAS_CHOLMOD),yes)
EXAMPLES := $(filter-out %/cholmod_solver,$(EXAMPLES))
endif
ifeq ($(PETSC_PACKAGES),)
EXAMPLES := $(filter-out %/petsc_solver,$(EXAMPLES))
endif
$(BUILD)/examples/cholmod_solver: LIBS += -lcholmod
PETSC_LIBS = $(patsubst -I%,-isystem %,$(shell $(PKG_CONFIG) --cflags-only-I --libs $(PETSC_PACKAGES)))
$(BUILD)/examples/petsc_solver: LIBS += $(PETSC_LIBS)
UNIT_OBJECTS := $(patsubst %.c,$(BUILD)/obj/%.o,$(sort $(wildcard tests/unit/*.c)))
UNIT := $(BUILD)/tests/unit

.PHONY: all install uninstall examples demo bench bench-quick clean format format-check
.PHONY: check check-setup check-unit check-api check-examples check-asan check-tsan mutate
.PHONY: check-hashes update-hashes
.PHONY: check-determinism check-combinations check-instructions update-instructions check-aarch64 check-abi update-abi
.PHONY: docs fuzz-programs fuzz check-fuzz verify verify-quick verify-plots
.DELETE_ON_ERROR:
.SUFFIXES:

all: $(STATIC_LIB) $(SHARED_LIB)

# ---- library ---------------------------------------------------------------------------------------------
$(BUILD)/obj/src/%.o: src/%.c Makefile
	@mkdir -p $(@D)
	$(call SAY,CC)
	$(Q)$(CC) $(LIBRARY) $(OPT) -ffp-contract=off -c $< -o $@

define kernel_rule
$(BUILD)/obj/src/%.$(1).o: src/%.c Makefile
	@mkdir -p $$(@D)
	$$(call SAY,CC)
	$$(Q)$$(CC) $$(LIBRARY) $$(KERNEL_FLAGS) $$(ISA_$(1)) -DMPMI_ISA=$(1) -c $$< -o $$@
endef
$(foreach isa,$(ISAS),$(eval $(call kernel_rule,$(isa))))

$(STATIC_LIB): $(OBJECTS)
	@rm -f $@
	$(call SAY,AR)
	$(Q)$(AR) rcs $@ $(OBJECTS)

NO_UNDEFINED ?= -Wl,-z,defs
$(SHARED_LIB): $(OBJECTS) src/libmpm.map
	$(call SAY,LINK)
	$(Q)$(CC) -shared -Wl,-soname,$(SONAME) -Wl,--version-script=src/libmpm.map $(NO_UNDEFINED) -Wl,-z,noexecstack \
	  $(CFLAGS) $(LDFLAGS) $(OBJECTS) $(LIBS) -o $@
	$(Q)ln -sf $(SHARED) $(BUILD)/$(SONAME)
	$(Q)ln -sf $(SHARED) $(BUILD)/libmpm.so

# ---- installation ----------------------------------------------------------------------------------------
# Where libraries and headers both lie under the prefix, the CMake package finds one from the other, wherever the
# installation is moved to.
CMAKEDIR = $(LIBDIR)/cmake/mpm
inside_prefix = $(patsubst $(PREFIX)/%,%,$(filter $(PREFIX)/%,$(1)))
up_to_prefix = $(subst $(space),/,$(patsubst %,..,$(subst /, ,$(call inside_prefix,$(CMAKEDIR)))))
space := $(subst ,, )
INCLUDEDIR_FROM_CMAKEDIR = $(if $(and $(call inside_prefix,$(LIBDIR)),$(call inside_prefix,$(INCLUDEDIR))),$(\
  )$(up_to_prefix)/$(call inside_prefix,$(INCLUDEDIR)),$(INCLUDEDIR))
POINTER_BYTES = $(shell echo __SIZEOF_POINTER__ | $(CC) $(CFLAGS) -E -P -)
SUBSTITUTE = sed $(foreach name,PREFIX LIBDIR INCLUDEDIR VERSION SHARED SONAME INCLUDEDIR_FROM_CMAKEDIR \
  POINTER_BYTES,-e 's|@$(name)@|$($(name))|')

install: all
	install -d $(DESTDIR)$(INCLUDEDIR)/mpm $(DESTDIR)$(LIBDIR)/pkgconfig $(DESTDIR)$(CMAKEDIR)
	install -m 644 $(HEADERS) $(DESTDIR)$(INCLUDEDIR)/mpm
	install -m 644 $(STATIC_LIB) $(DESTDIR)$(LIBDIR)
	install -m 755 $(SHARED_LIB) $(DESTDIR)$(LIBDIR)
	ln -sf $(SHARED) $(DESTDIR)$(LIBDIR)/$(SONAME)
	ln -sf $(SHARED) $(DESTDIR)$(LIBDIR)/libmpm.so
	$(SUBSTITUTE) pkgconfig/mpm.pc.in > $(DESTDIR)$(LIBDIR)/pkgconfig/mpm.pc
	$(SUBSTITUTE) cmake/mpmConfig.cmake.in > $(DESTDIR)$(CMAKEDIR)/mpmConfig.cmake
	$(SUBSTITUTE) cmake/mpmConfigVersion.cmake.in > $(DESTDIR)$(CMAKEDIR)/mpmConfigVersion.cmake
	chmod 644 $(DESTDIR)$(LIBDIR)/pkgconfig/mpm.pc $(DESTDIR)$(CMAKEDIR)/*.cmake

uninstall:
	rm -f $(HEADERS:include/%=$(DESTDIR)$(INCLUDEDIR)/%)
	rm -f $(addprefix $(DESTDIR)$(LIBDIR)/,libmpm.a $(SHARED) $(SONAME) libmpm.so pkgconfig/mpm.pc)
	rm -f $(addprefix $(DESTDIR)$(CMAKEDIR)/,mpmConfig.cmake mpmConfigVersion.cmake)
	rmdir $(DESTDIR)$(INCLUDEDIR)/mpm $(DESTDIR)$(CMAKEDIR) 2>/dev/null || :

# ---- examples and benchmarks -----------------------------------------------------------------------------
$(BUILD)/examples/%: examples/%.c $(STATIC_LIB) Makefile
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CC) $(COMMON) $(OPT) -MF $@.d -MT $@ $< $(STATIC_LIB) $(LDFLAGS) $(LIBS) -o $@

$(BUILD)/examples/%: examples/%.cpp $(STATIC_LIB) Makefile
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CXX) -std=c++17 -MMD -MP -Iinclude $(CXX_WARNINGS) $(CPPFLAGS) $(CXXFLAGS) $(OPT) -MF $@.d -MT $@ $< \
	  $(STATIC_LIB) $(LDFLAGS) $(LIBS) -o $@

# The benchmark is a host program: it is compiled against an installation and runs the shared library; with the
# solvers of the examples as well, where they are found.
BENCH_HOSTS := $(if $(HAS_CHOLMOD),-DBENCH_CHOLMOD) $(if $(PETSC_PACKAGES),-DBENCH_PETSC)
BENCH_HOST_LIBS = $(if $(HAS_CHOLMOD),-lcholmod) $(if $(PETSC_PACKAGES),$(PETSC_LIBS))
$(BENCH): $(wildcard bench/*.[ch] examples/*.h) $(SHARED_LIB) $(STATIC_LIB) Makefile
	@mkdir -p $(@D)
	$(Q)$(MAKE) -s install PREFIX=$(abspath $(@D))/installed DESTDIR= > /dev/null
	$(call SAY,LINK)
	$(Q)$(CC) -std=c11 $(WARNINGS) $(CFLAGS) -O3 -ffp-contract=fast -fno-math-errno -Wno-psabi $(BENCH_HOSTS) $(wildcard bench/*.c) \
	  -I$(@D)/installed/include -L$(@D)/installed/lib -Wl,--enable-new-dtags,-rpath,$(abspath $(@D))/installed/lib $(LDFLAGS) -lmpm \
	  $(BENCH_HOST_LIBS) -lm -o $@

examples: $(EXAMPLES)

demo: $(BUILD)/examples/two_disks
	@mkdir -p $(BUILD)/demo
	cd $(BUILD)/demo && $(abspath $<)

# All cases on one and two threads, with tables in $(BUILD)/bench; explicit steps in under a minute: bench-quick. With
# AGAINST=PREFIX both run the cases in small by turns with the library installed there and this one, ROUNDS times.
AGAINST ?=
ROUNDS ?= 5
against = python3 bench/against.py $(1) --rounds $(ROUNDS) $(BENCH) $(AGAINST) $(BUILD)/bench/installed
bench: $(BENCH)
ifeq ($(AGAINST),)
	$(BENCH) --csv $(BUILD)/bench/bench.csv
	$(BENCH) --implicit --csv $(BUILD)/bench/implicit.csv
else
	@$(call against)
endif
bench-quick: $(BENCH)
	$(if $(AGAINST),@$(call against,--quick),$(BENCH) --quick)

# ---- tests -----------------------------------------------------------------------------------------------
# Every tests/unit/test_X.c defines Suite *X_suite(void), listed in tests/unit/suites.h. The program is linked to
# the static library, so that it reaches internal functions. CHECK_LIBS are asked for only when needed: a demo or
# an installation does without pkg-config.
CHECK_CFLAGS = $(shell $(PKG_CONFIG) --cflags check)
CHECK_LIBS = $(shell $(PKG_CONFIG) --libs check)
TEST_ENVIRONMENT = CC="$(CC)" CXX="$(CXX)" MAKE="$(MAKE)" PKG_CONFIG="$(PKG_CONFIG)" BUILD="$(abspath $(BUILD))" \
  MPM_SCRATCH="$(abspath $(BUILD))/tests/scratch"

$(BUILD)/obj/tests/%.o: tests/%.c Makefile
	@mkdir -p $(@D)
	$(call SAY,CC)
	$(Q)$(CC) $(COMMON) $(CHECK_CFLAGS) -O1 -c $< -o $@

$(UNIT): $(UNIT_OBJECTS) $(STATIC_LIB)
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) $(UNIT_OBJECTS) $(STATIC_LIB) $(CHECK_LIBS) $(LIBS) -o $@

check: check-unit check-hashes check-api check-examples verify-quick

# Suites run side by side, each in a process and a scratch folder of its own; what one prints stays together.
SUITES ?= $(shell sed -n 's/^SUITE(\(.*\))$$/\1/p' tests/unit/suites.h)
JOBS ?= $(shell nproc)
check-unit: $(UNIT)
	@mkdir -p $(SUITES:%=$(BUILD)/tests/scratch/%)
	@printf '%s\n' $(SUITES) | $(TEST_ENVIRONMENT) xargs -P $(JOBS) -I{} sh -c \
	  'out=$$(CK_RUN_SUITE={} MPM_SCRATCH="$$MPM_SCRATCH/{}" $(UNIT) 2>&1); status=$$?; echo "$$out"; exit $$status'

# Every method that the library offers on 1, 2, 3, 4, 7 threads, by pool and executor, on each instruction set; `check`
# has a sample of it.
check-determinism: $(UNIT)
	@printf '%s\n' 3-D 2-D 1-D hashes | xargs -P $(JOBS) -I{} sh -c \
	  'out=$$(MPM_FULL=1 CK_RUN_SUITE=determinism CK_RUN_CASE={} $(UNIT) 2>&1); status=$$?; echo "{}: $$out"; exit $$status'

# Every combination of options on bodies of 27 blocks and more; `check` has a sample of it.
check-combinations: $(UNIT)
	@printf '%s\n' rules 'first half' 'second half' | xargs -P $(JOBS) -I{} sh -c \
	  'out=$$(MPM_FULL=1 CK_RUN_SUITE=combinations CK_RUN_CASE="{}" $(UNIT) 2>&1); status=$$?; echo "{}: $$out"; exit $$status'

# Instructions per particle-step under callgrind, within 3 % of tests/instructions/expected.txt.
STEPS := $(BUILD)/tests/instructions/steps
$(STEPS): tests/instructions/steps.c $(STATIC_LIB) Makefile
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CC) $(COMMON) $(OPT) -MF $@.d -MT $@ $< $(STATIC_LIB) $(LDFLAGS) $(LIBS) -o $@
check-instructions update-instructions: $(STEPS)
	@$(TEST_ENVIRONMENT) bash tests/instructions/run.sh $(@:-instructions=)

# State hashes of small scenes with every method, law and option, against tests/hashes/expected-*.txt.
HASHES := $(BUILD)/tests/hashes/hashes
$(HASHES): $(wildcard tests/hashes/*.[ch]) $(STATIC_LIB) Makefile
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CC) -std=c11 -Iinclude $(WARNINGS) $(CPPFLAGS) $(CFLAGS) $(OPT) -ffp-contract=off $(filter %.c,$^) $(STATIC_LIB) \
	  $(LDFLAGS) $(LIBS) -o $@
check-hashes update-hashes: $(HASHES)
	@$(TEST_ENVIRONMENT) CFLAGS="$(CFLAGS)" JOBS=$(JOBS) bash tests/hashes/run.sh $(@:-hashes=)

# The binary interface against abi/libmpm-x86_64.abi.xml, by abidiff; update-abi takes what is there as the new baseline.
check-abi update-abi: $(SHARED_LIB)
	@$(TEST_ENVIRONMENT) bash tests/abi/run.sh $(@:-abi=)

# The library and its unit tests for another processor, run by qemu.
check-aarch64:
	@env -u MAKEFLAGS -u MFLAGS $(TEST_ENVIRONMENT) JOBS=$(JOBS) bash tests/aarch64/run.sh

check-api: all
	@mkdir -p $(BUILD)/tests/scratch
	@for script in $(sort $(wildcard tests/api/*.sh)); do \
	  echo "$$script"; env -u MAKEFLAGS -u MFLAGS $(TEST_ENVIRONMENT) bash $$script || exit 1; done

check-examples: examples
	@mkdir -p $(BUILD)/tests/scratch
	@for script in $(sort $(wildcard tests/examples/*.sh)); do \
	  echo "$$script"; $(TEST_ENVIRONMENT) bash $$script || exit 1; done

# With `make -j check-setup check` the tools come before the first file that needs them.
ifneq (,$(filter check-setup,$(MAKECMDGOALS)))
$(UNIT_OBJECTS) $(UNIT) check-unit check-api check-examples: | check-setup
endif

check-setup:
	@if $(PKG_CONFIG) --exists check 2>/dev/null && command -v g++ >/dev/null; then exit 0; fi; \
	sudo=; if [ "$$(id -u)" != 0 ]; then sudo=sudo; fi; \
	$$sudo apt-get update -q && \
	$$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -q check pkg-config g++

# Long runs of the method add nothing under a sanitizer but time, and all runs take longer.
SANITIZED = CK_TIMEOUT_MULTIPLIER=5 CK_EXCLUDE_TAGS=long EXAMPLES="two_disks user_material host_threads staged_coupling cpp_block" $(MAKE) OPT=-O1 KERNEL_OPT=-O1 NO_UNDEFINED= check-unit check-examples
check-asan:
	+ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1 UBSAN_OPTIONS=print_stacktrace=1 $(SANITIZED) \
	  BUILD=$(BUILD)-asan CFLAGS="-g -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=all"

# The fork of each test would hide threads from the sanitizer.
TSAN_SUITES ?= context executor threads rollback restart linalg
check-tsan:
	+CK_FORK=no TSAN_OPTIONS=halt_on_error=1 $(SANITIZED) SUITES="$(TSAN_SUITES)" \
	  BUILD=$(BUILD)-tsan CFLAGS="-g -fno-omit-frame-pointer -fsanitize=thread"

# libFuzzer on saved states, descriptors and small clouds of particles: FUZZ_SECONDS each, from the committed corpora;
# what is new stays in $(FUZZ)/corpus. check-fuzz: the corpora as they are, then a minute in all.
FUZZ = $(BUILD)-fuzz
FUZZ_TARGETS ?= state descriptors clouds
FUZZ_SECONDS ?= 600
FUZZ_FLAGS = -g -fno-omit-frame-pointer -fno-sanitize-recover=all -fsanitize=address,undefined
FUZZ_CC ?= clang
fuzz-programs:
	@$(MAKE) CC=$(FUZZ_CC) BUILD=$(FUZZ) OPT=-O1 KERNEL_OPT="-O1 -Wno-pass-failed" CFLAGS="$(FUZZ_FLAGS) -fsanitize=fuzzer-no-link -fno-sanitize-coverage=trace-cmp" \
	  $(FUZZ_TARGETS:%=$(FUZZ)/fuzz/%)
$(BUILD)/fuzz/%: tests/fuzz/%.c tests/fuzz/fuzz.h $(STATIC_LIB) Makefile
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CC) $(COMMON) -O1 -MF $@.d -MT $@ -fsanitize=fuzzer $< $(STATIC_LIB) $(LDFLAGS) $(LIBS) -o $@

fuzz: fuzz-programs
	@for target in $(FUZZ_TARGETS); do bash tests/fuzz/run.sh $(FUZZ) $$target $(FUZZ_SECONDS) || exit 1; done
check-fuzz: fuzz-programs
	@for target in $(FUZZ_TARGETS); do bash tests/fuzz/run.sh $(FUZZ) $$target 20 || exit 1; done

# Plants known faults one by one in a copy of the sources and expects the unit tests to notice each.
mutate: $(UNIT)
	@env -u MAKEFLAGS -u MFLAGS $(TEST_ENVIRONMENT) bash tests/mutate/run.sh

# ---- verification ----------------------------------------------------------------------------------------
# Every tests/verification/X.c is a host program of the shared library that compares it with exact solutions and prints
# its gates; CSV files, logs and the table of gates go to $(VERIFIED). A file with a header of its name is shared by the
# cases. The long cases start first. CASES="a b" selects.
VERIFIED = $(BUILD)/verification
VERIFY_HEADERS := $(sort $(wildcard tests/verification/*.h))
VERIFY_SHARED := $(VERIFY_HEADERS:.h=.c)
VERIFY_LONG := cube_convergence taylor_bar four_discs transfers water_column
VERIFY_ALL := $(basename $(notdir $(filter-out $(VERIFY_SHARED),$(sort $(wildcard tests/verification/*.c)))))
CASES ?= $(filter $(VERIFY_LONG),$(VERIFY_ALL)) $(filter-out $(VERIFY_LONG),$(VERIFY_ALL))
VERIFY := $(CASES:%=$(VERIFIED)/%)
VERIFY_JOBS ?= 2
$(VERIFIED)/%: tests/verification/%.c $(VERIFY_SHARED) $(VERIFY_HEADERS) $(SHARED_LIB) Makefile
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CC) -std=c11 -Iinclude $(WARNINGS) $(CPPFLAGS) $(CFLAGS) $(OPT) $(filter %.c,$^) -L$(BUILD) \
	  -Wl,-rpath,'$$ORIGIN/..' $(LDFLAGS) -lmpm -lm -o $@

verify: $(VERIFY)
	@bash tests/verification/run.sh $(VERIFIED)/full $(VERIFY_JOBS) $(VERIFY)
verify-quick: $(VERIFY)
	@bash tests/verification/run.sh $(VERIFIED)/quick $(VERIFY_JOBS) --quick $(VERIFY)
# Takes the numbers of the last `make verify` into docs/verification: plots, and the tables of docs/verification.md.
verify-plots:
	cp $(VERIFIED)/full/*.csv docs/verification
	/usr/bin/python3 docs/verification/plot.py

# ---- reference -------------------------------------------------------------------------------------------
# HTML from the headers, into $(BUILD)/docs/html; anything without a comment is an error.
docs:
	@mkdir -p $(BUILD)/docs
	@VERSION=$(VERSION) OUTPUT=$(BUILD)/docs doxygen docs/Doxyfile
	@echo "$(BUILD)/docs/html/index.html"

# ---- upkeep ----------------------------------------------------------------------------------------------
FORMATTED = $(wildcard include/mpm/*.h include/mpm/*.hpp src/*/*.[ch] examples/*.[ch] examples/*.cpp bench/*.[ch] \
  tests/*/*.[ch] tests/*/*.cpp)
format:
	clang-format -i $(FORMATTED)
format-check:
	clang-format --dry-run -Werror $(FORMATTED)

clean:
	rm -rf $(BUILD) $(BUILD)-asan $(BUILD)-tsan $(BUILD)-aarch64 $(FUZZ)

-include $(OBJECTS:.o=.d) $(UNIT_OBJECTS:.o=.d) $(EXAMPLES:=.d) $(STEPS).d $(FUZZ_TARGETS:%=$(BUILD)/fuzz/%.d)
