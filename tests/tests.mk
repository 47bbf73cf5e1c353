# The tests of libmpm, included by the Makefile at the top of the sources, from where all paths start.

.PHONY: check check-setup check-warnings check-structure measure-structure check-unit check-api check-examples check-asan check-tsan
.PHONY: check-builds check-windows check-wasm check-valgrind
.PHONY: check-amalgamation check-cmake check-umat mutate-slack
.PHONY: mutate mutate-check check-hashes update-hashes check-parts check-parts-quick check-parts-faults check-parts-verify
.PHONY: measure-parts
.PHONY: check-determinism check-combinations check-instructions update-instructions check-aarch64 check-portable check-abi update-abi
.PHONY: fuzz-programs fuzz fuzz-corpus check-fuzz verify verify-quick verify-plots

# ---- tests -----------------------------------------------------------------------------------------------
# Every tests/unit/test_X.c defines Suite *X_suite(void), listed in tests/unit/suites.h. The program is linked to
# the static library, so that it reaches internal functions. CHECK_LIBS are asked for only when needed: a demo or
# an installation does without pkg-config.
UNIT_OBJECTS := $(patsubst %.c,$(BUILD)/obj/%.o,$(sort $(wildcard tests/unit/*.c)))
UNIT := $(BUILD)/tests/unit
TEST_OPT ?= -O1
CHECK_CFLAGS = $(shell $(PKG_CONFIG) --cflags check)
CHECK_LIBS = $(shell $(PKG_CONFIG) --libs check)
TEST_ENVIRONMENT = CC="$(CC)" CXX="$(CXX)" MAKE="$(MAKE)" PKG_CONFIG="$(PKG_CONFIG)" BUILD="$(abspath $(BUILD))" \
  MPM_SCRATCH="$(abspath $(BUILD))/tests/scratch"

$(BUILD)/obj/tests/%.o: tests/%.c Makefile tests/tests.mk
	@mkdir -p $(@D)
	$(call SAY,CC)
	$(Q)$(CC) $(COMMON) $(CHECK_CFLAGS) $(TEST_OPT) -c $< -o $@

$(UNIT): $(UNIT_OBJECTS) $(STATIC_LIB)
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) $(UNIT_OBJECTS) $(STATIC_LIB) $(CHECK_LIBS) $(LIBS) -o $@

#: check-warnings        the unit tests by a compiler that makes no code of them: what another one warns of
check-warnings:
	@printf '%s\n' $(sort $(wildcard tests/unit/*.c)) | xargs -P $(JOBS) -n 8 $(CC) -std=c11 -Iinclude -Isrc $(WARNINGS) $(CPPFLAGS) $(CHECK_CFLAGS) -fsyntax-only

#: check                 what a change must pass: the checks of structure, units, hashes, interface, examples, faults, and
#:                       verify-quick
check: check-structure check-unit check-hashes check-parts-quick check-api check-examples mutate-check verify-quick

# First the check must notice what is planted in a small tree of its own.
STRUCTURE = python3 tests/structure/check.py --objects $(BUILD)/obj/src
#: check-structure       which files of src/ need which others: no circles, no arrow from a lower folder to a higher one
check-structure: $(STATIC_LIB)
	@mkdir -p $(BUILD)/tests/scratch
	@$(TEST_ENVIRONMENT) python3 tests/structure/planted.py $(BUILD)/tests/scratch
	@$(STRUCTURE)
#: measure-structure     the same with figures: arrows between folders, the longest chain of includes, lines
measure-structure: $(STATIC_LIB)
	@$(STRUCTURE) --measure

# Suites run side by side, the long ones first, each in a process and a scratch folder of its own; what one prints stays together. Limits of
# time are for what hangs: machines are slower than that on which they were set, and busy.
#: check-unit            the unit tests, by Check; SUITES="a b:c" selects suites, and of b the case c
ALL_SUITES = $(shell sed -n 's/^SUITE(\(.*\))$$/\1/p' tests/unit/suites.h)
LONG_SUITES = shared_contact shared_solvers implicit determinism exact impact allocation schemes walls contact
SUITES ?= $(LONG_SUITES) $(filter-out $(LONG_SUITES),$(ALL_SUITES))
JOBS ?= $(shell nproc)
check-unit: $(UNIT)
	@mkdir -p $(SUITES:%=$(BUILD)/tests/scratch/%)
	@export CK_TIMEOUT_MULTIPLIER=$${CK_TIMEOUT_MULTIPLIER:-4}; \
	printf '%s\n' $(SUITES) | $(TEST_ENVIRONMENT) xargs -P $(JOBS) -I{} sh -c \
	  'suite={}; case $$suite in *:*) export CK_RUN_CASE=$${suite#*:} ;; esac; \
   out=$$(CK_RUN_SUITE=$${suite%:*} MPM_SCRATCH="$$MPM_SCRATCH/{}" $(UNIT) 2>&1); status=$$?; echo "$$out"; \
   case $$out in *"Checks: 0,"*) echo "check-unit: there is no suite or case $$suite" >&2; status=1 ;; esac; \
   exit $$status'

# Every method that the library offers on 1, 2, 3, 4, 7 threads, by pool and executor in turn, on the best instruction
# set, and on one and seven threads on the others; `check` has a sample of it.
#: check-determinism     the same bits from every method, on 1 to 7 threads; nearly the same on each instruction set
check-determinism: $(UNIT)
	@printf '%s\n' 3-D 2-D 1-D hashes | xargs -P $(JOBS) -I{} sh -c \
	  'out=$$(MPM_FULL=1 CK_RUN_SUITE=determinism CK_RUN_CASE={} $(UNIT) 2>&1); status=$$?; echo "{}: $$out"; exit $$status'

# `check` has a sample of it.
#: check-combinations    every combination of options, on bodies of 27 blocks and more
check-combinations: $(UNIT)
	@printf '%s\n' rules 'first half' 'second half' | xargs -P $(JOBS) -I{} sh -c \
	  'out=$$(MPM_FULL=1 CK_RUN_SUITE=combinations CK_RUN_CASE="{}" $(UNIT) 2>&1); status=$$?; echo "{}: $$out"; exit $$status'

#: check-instructions    instructions of a particle-step under callgrind, within 1 % of tests/instructions/expected.txt
#: update-instructions   takes what is counted as what is expected
STEPS := $(BUILD)/tests/instructions/steps
$(STEPS): tests/instructions/steps.c $(STATIC_LIB) Makefile tests/tests.mk
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CC) $(COMMON) $(OPT) -MF $@.d $< $(STATIC_LIB) $(LDFLAGS) $(LIBS) -o $@
check-instructions update-instructions: $(STEPS)
	@$(TEST_ENVIRONMENT) bash tests/instructions/run.sh $(@:-instructions=)

# The scenes are a host program, without contraction.
HASHES := $(BUILD)/tests/hashes/hashes
$(HASHES): $(wildcard tests/hashes/*.[ch]) $(STATIC_LIB) Makefile
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CC) -std=c11 -Iinclude $(WARNINGS) $(CPPFLAGS) $(CFLAGS) $(OPT) -ffp-contract=off $(filter %.c,$^) $(STATIC_LIB) \
	  $(LDFLAGS) $(LIBS) -o $@
#: check-hashes          state hashes of small scenes with every method, law and option, against tests/hashes/expected-*.txt
#: update-hashes         takes the hashes that are there as the expected ones
check-hashes update-hashes: $(HASHES)
	@$(TEST_ENVIRONMENT) CFLAGS="$(CFLAGS)" JOBS=$(JOBS) bash tests/hashes/run.sh $(@:-hashes=)

PARTS := $(BUILD)/tests/parts/parts
$(PARTS): tests/parts/main.c tests/unit/parts.c $(filter-out tests/hashes/main.c,$(wildcard tests/hashes/*.[ch])) $(STATIC_LIB) Makefile
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CC) -std=c11 -Iinclude -Itests/hashes -Itests/unit $(WARNINGS) $(CPPFLAGS) $(CFLAGS) $(OPT) -ffp-contract=off $(filter %.c,$^) \
	  $(STATIC_LIB) $(LDFLAGS) $(LIBS) -o $@
VOLUMES := $(BUILD)/tests/parts/volumes
$(VOLUMES): tests/parts/volumes.c tests/unit/parts.c $(STATIC_LIB) Makefile
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CC) -std=c11 -Iinclude -Itests/unit $(WARNINGS) $(CPPFLAGS) $(CFLAGS) $(OPT) $(filter %.c,$^) $(STATIC_LIB) $(LDFLAGS) $(LIBS) -o $@
#: measure-parts         what 27 parts of 110 592 particles send each other in a step; SIDE=3 CELLS=48 for 884 736
SIDE ?= 3
CELLS ?= 24
measure-parts: $(VOLUMES)
	$(VOLUMES) $(SIDE) $(CELLS)
#: check-parts           the same scenes on 2, 3 and 5 parts: the bits of one part in states, reports, reactions and nodes
#: check-parts-quick     every fourth of them on 3 parts, and some of check-parts-verify
check-parts: $(PARTS)
	@bash tests/parts/run.sh $(PARTS) $(BUILD)/tests/parts/found $(JOBS) 1 2 3 5
PARTED_QUICK := $(addprefix $(BUILD)/tests/parts/cases/,boundary_density cantilever contact_corner couette hydrostatic pulse ring_cylinder two_disks)
ifneq ($(SYSTEM),elf)
PARTED_QUICK := # other linkers have no --wrap
endif
check-parts-quick: $(PARTS) $(PARTED_QUICK)
	@bash tests/parts/run.sh $(PARTS) $(BUILD)/tests/parts/found $(JOBS) 4 3
	@[ -z "$(PARTED_QUICK)" ] || bash tests/parts/cases.sh $(BUILD)/tests/parts/told $(JOBS) 3 $(PARTED_QUICK)

# The suites have a sample of it in `check`; those that take longest start first.
#: check-parts-faults    calls of the transport and allocations fail one by one, on each of three parts
FAULT_SUITES := shared_contact shared shared_options shared_solvers shared_host_solver shared_states
check-parts-faults: $(UNIT)
	@mkdir -p $(FAULT_SUITES:%=$(BUILD)/tests/scratch/%)
	@printf '%s\n' $(FAULT_SUITES) | $(TEST_ENVIRONMENT) xargs -P $(JOBS) -I{} sh -c \
	  'out=$$(MPM_FULL=1 CK_INCLUDE_TAGS=faults CK_RUN_SUITE={} MPM_SCRATCH="$$MPM_SCRATCH/{}" $(UNIT) 2>&1); status=$$?; \
   echo "$$out"; case $$out in *"Checks: 0,"*) status=1 ;; esac; exit $$status'

#: check-portable        the same bits on every platform whose compiler and emulator are there: a table. SCENES=all, gate;
#:                       PLATFORMS="gcc s390x"
check-portable:
	@env -u MAKEFLAGS -u MFLAGS $(TEST_ENVIRONMENT) JOBS=$(JOBS) bash tests/portable/run.sh

#: check-abi             the binary interface against abi/libmpm-x86_64.abi.xml, by abidiff
#: update-abi            takes the interface that is there as the baseline
check-abi update-abi: $(SHARED_LIB)
	@$(TEST_ENVIRONMENT) bash tests/abi/run.sh $(@:-abi=)

#: check-aarch64         the library and its unit tests for another processor, run by qemu
check-aarch64:
	@env -u MAKEFLAGS -u MFLAGS $(TEST_ENVIRONMENT) JOBS=$(JOBS) bash tests/aarch64/run.sh

# A host program for systems on which the unit tests do not run; here it says what their bits must be.
SMOKE := $(BUILD)/tests/platform/smoke
$(SMOKE): tests/platform/smoke.c $(STATIC_LIB) Makefile tests/tests.mk
	@mkdir -p $(@D) $(BUILD)/tests/scratch
	$(call SAY,LINK)
	$(Q)$(CC) $(COMMON) $(OPT) -MF $@.d $< $(STATIC_LIB) $(LDFLAGS) $(LIBS) -o $@
#: check-builds          other compilers, optimisations and C libraries, those that are installed; BUILDS="gcc-11 musl" selects
#: check-windows         the library for Windows by mingw-w64, run by wine
#: check-wasm            the library for WebAssembly by Emscripten and wasi-libc, run by node; SYSTEMS="wasi" selects
check-builds check-windows check-wasm: $(SMOKE) $(SHARED_LIB)
	@env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL $(TEST_ENVIRONMENT) JOBS=$(JOBS) bash tests/platform/$(@:check-%=%).sh

#: check-api             the installation, the headers, the exported symbols, the programs of the documents: tests/api
check-api: all
	@mkdir -p $(BUILD)/tests/scratch
	@for script in $(sort $(wildcard tests/api/*.sh)); do \
	  echo "$$script"; env -u MAKEFLAGS -u MFLAGS $(TEST_ENVIRONMENT) bash $$script || exit 1; done

#: check-amalgamation    mpm.c and mpm.h without a warning, with the README's program, the unit tests and the library's bits
#:                       (AMALGAMATION_TESTS=quick: without the last two)
AMALGAMATION_TESTS ?= full
check-amalgamation: amalgamation $(if $(filter full,$(AMALGAMATION_TESTS)),$(HASHES))
	@mkdir -p $(BUILD)/tests/scratch
	@env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL $(TEST_ENVIRONMENT) JOBS=$(JOBS) bash tests/amalgamation/run.sh $(AMALGAMATION_TESTS)

#: check-cmake           CMakeLists.txt: an installation, a folder of a host's sources, FetchContent
check-cmake: all
	@mkdir -p $(BUILD)/tests/scratch
	@env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL $(TEST_ENVIRONMENT) JOBS=$(JOBS) bash tests/api/cmake.sh full

#: check-umat            libmpm-umat: Fortran subroutines beside the laws built in, under the address sanitizer too, the
#:                       installation, the example; needs gfortran
check-umat: all
	@mkdir -p $(BUILD)/tests/scratch
	@env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL $(TEST_ENVIRONMENT) bash tests/umat/run.sh

#: check-examples        every example, with the numbers that it prints; EXAMPLES_RUN="two_disks dam_break" selects
EXAMPLES_RUN ?=
check-examples: $(if $(EXAMPLES_RUN),$(EXAMPLES_RUN:%=$(BUILD)/examples/%),examples)
	@mkdir -p $(BUILD)/tests/scratch
	@$(TEST_ENVIRONMENT) EXAMPLES_RUN="$(EXAMPLES_RUN)" sh tests/examples/run.sh

# With `make -j check-setup check` the tools come before the first file that needs them.
ifneq (,$(filter check-setup,$(MAKECMDGOALS)))
$(UNIT_OBJECTS) $(UNIT) check-unit check-api check-umat check-examples mutate-check: | check-setup
endif

#: check-setup           installs what `check` needs, on Debian: Check, pkg-config, a C++ compiler, Python
check-setup:
	@if $(PKG_CONFIG) --exists check 2>/dev/null && command -v g++ >/dev/null && command -v python3 >/dev/null; then exit 0; fi; \
	sudo=; if [ "$$(id -u)" != 0 ]; then sudo=sudo; fi; \
	$$sudo apt-get update -q && \
	$$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -q check pkg-config g++ python3

# Long runs of the method add nothing under a sanitizer but time, and all runs take longer.
SANITIZED = CK_TIMEOUT_MULTIPLIER=5 CK_EXCLUDE_TAGS="long clock wide" EXAMPLES_RUN="$(SANITIZED_EXAMPLES)" $(MAKE) OPT=-O1 KERNEL_OPT="$(SANITIZED_KERNEL_OPT)" TEST_OPT=-O0 NO_UNDEFINED= check-unit check-examples
# Kernels are one large function for each basis: they compile faster without checks in line and with registers given out
# function by function. Checks of each address that is computed take half of the time; what is read there is checked.
SANITIZED_KERNEL_OPT = -O1
ADDRESSES_UNCHECKED = -fno-sanitize=pointer-overflow
check-asan: SANITIZED_KERNEL_OPT = -O1 $(ADDRESSES_UNCHECKED) $(if $(findstring clang,$(CC)),-mllvm -asan-instrumentation-with-call-threshold=0,-fira-region=one --param asan-instrumentation-with-call-threshold=0)
# Without a fork for each test leaks are looked for once in each suite: with it that takes longer than the tests.
#: check-asan            check-unit and check-examples under the address and the undefined-behaviour sanitizer
check-asan: SANITIZED_EXAMPLES = user_material staged_coupling cpp_block
check-asan:
	+CK_FORK=no ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1 UBSAN_OPTIONS=print_stacktrace=1 $(SANITIZED) \
	  BUILD=$(BUILD)-asan CPPFLAGS="$(CPPFLAGS) -DMPM_DEBUG" \
	  CFLAGS="-g1 -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=all"

# For checks of what is the same with every instruction set: threads, and what files and descriptors say.
ONE_SET = ISAS=baseline CPPFLAGS="$(CPPFLAGS) -DMPM_BASELINE_ONLY"
# The fork of each test would hide threads from the sanitizer.
TSAN_SUITES ?= context executor threads parts rollback restart linalg shared:threads
#: check-tsan            the suites with threads under the thread sanitizer
check-tsan: SANITIZED_EXAMPLES = host_threads
check-tsan:
	+CK_FORK=no TSAN_OPTIONS=halt_on_error=1 $(SANITIZED) SUITES="$(TSAN_SUITES)" $(ONE_SET) \
	  BUILD=$(BUILD)-tsan CFLAGS="-g1 -fno-omit-frame-pointer -fsanitize=thread"

# Valgrind has no traps of the processor, knows nothing of slack, and takes twenty times as long.
VALGRIND_SUITES ?= context fields host:callbacks host:reentry host:texts
#: check-valgrind        calls from callbacks, errors and fields under valgrind; VALGRIND_SUITES="io" selects
check-valgrind: $(UNIT)
	@mkdir -p $(BUILD)/tests/scratch
	@for suite in $(VALGRIND_SUITES); do \
	  case $$suite in *:*) name=$${suite#*:};; *) name=;; esac; \
	  MPM_SCRATCH=$(abspath $(BUILD))/tests/scratch CK_TIMEOUT_MULTIPLIER=40 CK_FORK=no CK_EXCLUDE_TAGS=long CK_RUN_SUITE=$${suite%%:*} $${name:+env CK_RUN_CASE=$$name} \
	    valgrind -q --error-exitcode=1 --leak-check=full $(UNIT) || exit 1; \
	done

# libFuzzer on saved states, packed particles, descriptors, small clouds of particles and problems in parts; what is new stays in $(FUZZ)/fuzz/corpus.
FUZZ = $(BUILD)-fuzz
FUZZ_TARGETS ?= clouds parts state packed descriptors meshes
FUZZ_SECONDS ?= 600
FUZZ_FLAGS = -g1 -fno-omit-frame-pointer -fno-sanitize-recover=all -fsanitize=address,undefined
FUZZ_CC ?= clang
#: fuzz-programs         the fuzz targets, by clang, in $(BUILD)-fuzz
fuzz-programs:
	@$(MAKE) CC=$(FUZZ_CC) BUILD=$(FUZZ) $(ONE_SET) OPT=-O1 KERNEL_OPT="-O1 $(ADDRESSES_UNCHECKED)" CFLAGS="$(FUZZ_FLAGS) -fsanitize=fuzzer-no-link -fno-sanitize-coverage=trace-cmp" \
	  $(FUZZ_TARGETS:%=$(FUZZ)/fuzz/%)
$(BUILD)/fuzz/%: tests/fuzz/%.c $(wildcard tests/fuzz/*.h) $(STATIC_LIB) Makefile tests/tests.mk
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CC) $(COMMON) -O1 -MF $@.d -fsanitize=fuzzer $< $(STATIC_LIB) $(LDFLAGS) $(LIBS) -o $@

#: fuzz                  FUZZ_SECONDS (600) for each of FUZZ_TARGETS, from the committed corpora
fuzz: fuzz-programs
	@printf '%s\n' $(FUZZ_TARGETS) | xargs -P $(JOBS) -I{} bash tests/fuzz/run.sh $(FUZZ) {} $(FUZZ_SECONDS)
#: check-fuzz            the committed corpora, and new inputs of those that take less than ten seconds
check-fuzz: FUZZ_SECONDS = 10
check-fuzz: fuzz-programs
	@printf '%s\n' $(FUZZ_TARGETS) | xargs -P $(JOBS) -I{} bash tests/fuzz/run.sh $(FUZZ) {} $(FUZZ_SECONDS)
#: fuzz-corpus           packs the corpora again, with what was found that covers more
fuzz-corpus: fuzz-programs
	@for target in $(FUZZ_TARGETS); do bash tests/fuzz/pack.sh $(FUZZ) $$target || exit 1; done

#: mutate                plants known faults one at a time in copies of the sources: the tests must notice each.
#:                       FAULTS="src/io 1/8": of those of src/io every eighth
mutate:
	@env -u MAKEFLAGS -u MFLAGS $(TEST_ENVIRONMENT) JOBS=$(JOBS) bash tests/mutate/run.sh $(FAULTS)
#: mutate-check          whether each of these faults still has its place in the sources; compiles nothing
mutate-check:
	@python3 tests/mutate/plant.py check
	@MUTATE_FAULTS=tests/mutate/slack.txt python3 tests/mutate/plant.py check
#: mutate-slack          the same with faults that only the address sanitizer sees: reads and writes in slack
mutate-slack:
	@env -u MAKEFLAGS -u MFLAGS $(TEST_ENVIRONMENT) bash tests/mutate/slack.sh

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
VERIFY_OBJECTS := $(VERIFY_SHARED:%.c=$(BUILD)/obj/%.o)
CASE_OBJECTS := $(CASES:%=$(BUILD)/obj/tests/verification/%.o)
.SECONDARY: $(VERIFY_OBJECTS) $(CASE_OBJECTS)
$(BUILD)/obj/tests/verification/%.o: tests/verification/%.c Makefile tests/tests.mk
	@mkdir -p $(@D)
	$(call SAY,CC)
	$(Q)$(CC) -std=c11 $(NEEDS) -Iinclude $(WARNINGS) $(CPPFLAGS) $(CFLAGS) $(OPT) -c $< -o $@
$(VERIFIED)/%: $(BUILD)/obj/tests/verification/%.o $(VERIFY_OBJECTS) $(SHARED_LIB)
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CC) $(CFLAGS) $(filter %.o,$^) -L$(BUILD) -Wl,-rpath,'$$ORIGIN/..' $(LDFLAGS) -lmpm -lm -o $@

#: verify                the method against exact solutions, with a table of gates: docs/verification.md
verify: $(VERIFY)
	@bash tests/verification/run.sh $(VERIFIED)/full $(VERIFY_JOBS) $(VERIFY)
#: verify-quick          the same in small
verify-quick: $(VERIFY)
	@bash tests/verification/run.sh $(VERIFIED)/quick $(VERIFY_JOBS) --quick $(VERIFY)
# The same programs on parts: their calls of the library go through tests/parts/whole.c.
PARTED_OBJECTS := $(VERIFY_OBJECTS) $(addprefix $(BUILD)/obj/tests/parts/,whole.o table.o processes.o)
CASE_CALLS := $(shell sed -n 's/^REAL.[^,]*, \([a-z_]*\),.*/\1/p' tests/parts/whole.c) timespec_get main
CASE_PROGRAMS := $(CASES:%=$(BUILD)/tests/parts/cases/%)
.SECONDARY: $(PARTED_OBJECTS)
$(BUILD)/tests/parts/cases/%: $(BUILD)/obj/tests/verification/%.o $(PARTED_OBJECTS) $(STATIC_LIB)
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) $(CASE_CALLS:%=-Wl,--wrap=%) $(filter %.o,$^) $(STATIC_LIB) $(LIBS) -o $@
#: check-parts-verify    the cases in small on 2, 3 and 5 parts: the hashes, results and files of one part
check-parts-verify: $(CASE_PROGRAMS)
	@bash tests/parts/cases.sh $(BUILD)/tests/parts/told $(JOBS) "2 3 5" $^
#: verify-plots          the numbers of the last `make verify` into docs/verification: plots, and tables of its page
verify-plots:
	/usr/bin/python3 docs/verification/plot.py --from $(VERIFIED)/full

-include $(UNIT_OBJECTS:.o=.d) $(CASE_OBJECTS:.o=.d) $(PARTED_OBJECTS:.o=.d) $(STEPS).d $(FUZZ_TARGETS:%=$(BUILD)/fuzz/%.d)
