# libmpm: the libraries, their installation, the examples and the reference; tests/tests.mk has the tests.
#
# `make help` lists the targets. It prints the lines that begin with "#:", under the headings of the sections.
# CFLAGS and LDFLAGS are the user's; OPT and KERNEL_OPT, which come after CFLAGS, set the optimisation.

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

# All processors are used unless -j says otherwise, on the command line or in the environment's MAKEFLAGS. Several targets
# of which one must wait for another are made in the order in which they are given.
ifeq (0,$(MAKELEVEL))
MAKEFLAGS_GIVEN := $(MAKEFLAGS) $(shell echo "$$MAKEFLAGS")
IN_ORDER := $(filter clean format verify-plots fuzz-corpus,$(MAKECMDGOALS))
ifeq (,$(IN_ORDER)$(filter -j% --jobs%,$(MAKEFLAGS_GIVEN))$(findstring j,$(filter-out -%,$(firstword $(MAKEFLAGS_GIVEN)))))
MAKEFLAGS += -j$(shell nproc 2> /dev/null || echo 1)
endif
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
  src/transfer/box.c src/transfer/update.c src/transfer/move.c src/transfer/sums.c \
  src/transfer/kernels.c src/material/law_*.c src/material/tangent_rows.c src/material/objective_tangent.c src/material/deformation.c src/linalg/dense.c src/linalg/sweep.c
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

.PHONY: all help install uninstall examples demo bench bench-quick docs clean format format-check
.DELETE_ON_ERROR:
.SUFFIXES:

# ---- library ---------------------------------------------------------------------------------------------
#: all                   the static and the shared library, in $(BUILD): what `make` alone does
all: $(STATIC_LIB) $(SHARED_LIB)

#: help                  this list
help:
	@awk '/^# ---- / { gsub(/^# -+ | -+$$/, ""); heading = $$0 } \
	  /^#: / { if (heading) print (lines++ ? "\n" : "") heading; heading = ""; sub(/^#:/, " "); gsub(/[$$][(]BUILD[)]/, "$(BUILD)"); print }' Makefile tests/tests.mk
	@printf '\n%s\n' 'V=1 shows the commands, -jN sets how many run at once, BUILD=folder builds there, CC and CFLAGS are yours.'

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

#: install               headers, libraries, pkg-config and CMake files, under PREFIX (/usr/local), in DESTDIR
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

#: uninstall             takes them away again
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

#: examples              the programs of examples/, in $(BUILD)/examples
examples: $(EXAMPLES)

#: demo                  two elastic disks collide; needs nothing but a C compiler
demo: $(BUILD)/examples/two_disks
	@mkdir -p $(BUILD)/demo
	$< $(BUILD)/demo

#: bench                 speed of all cases on one and two threads; tables in $(BUILD)/bench. With AGAINST=PREFIX the
#:                       cases in small, by turns with the library installed there and this one, ROUNDS (5) times
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
#: bench-quick           explicit steps alone, in under a minute; AGAINST as well
bench-quick: $(BENCH)
	$(if $(AGAINST),@$(call against,--quick),$(BENCH) --quick)

include tests/tests.mk

# ---- reference -------------------------------------------------------------------------------------------
#: docs                  HTML from the headers, in $(BUILD)/docs/html; a declaration without a comment is an error
docs:
	@mkdir -p $(BUILD)/docs
	@VERSION=$(VERSION) OUTPUT=$(BUILD)/docs doxygen docs/Doxyfile
	@echo "$(BUILD)/docs/html/index.html"

# ---- upkeep ----------------------------------------------------------------------------------------------
FORMATTED = $(wildcard include/mpm/*.h include/mpm/*.hpp src/*/*.[ch] examples/*.[ch] examples/*.cpp bench/*.[ch] \
  tests/*/*.[ch] tests/*/*.cpp)
#: format                clang-format on all sources
format:
	clang-format -i $(FORMATTED)
#: format-check          fails where clang-format would change something, or a line is wider than 110 columns
format-check:
	clang-format --dry-run -Werror $(FORMATTED)
	@! grep -nE '.{111}' $(FORMATTED) || { echo 'these lines are longer than 110 columns' >&2; exit 1; }

#: clean                 takes all build folders away
clean:
	rm -rf $(BUILD) $(BUILD)-asan $(BUILD)-tsan $(BUILD)-aarch64 $(FUZZ)

-include $(OBJECTS:.o=.d) $(EXAMPLES:=.d)
