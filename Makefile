# libmpm: the libraries, their installation, the examples and the reference; tests/tests.mk has the tests.
#
# `make help` lists the targets. It prints the lines that begin with "#:", under the headings of the sections.
# CFLAGS and LDFLAGS are the user's; OPT and KERNEL_OPT, which come after CFLAGS, set the optimisation. Warnings are errors
# with WERROR=-Werror.

VERSION := 0.1.0
.DEFAULT_GOAL := all

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
WERROR ?=
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
# A file of dependencies holds for $(BUILD) however it is written: relative here, absolute in a script of the tests.
NEEDS = -MMD -MP -MT '$$(BUILD)$(patsubst $(BUILD)%,%,$@)'
COMMON = -std=c11 $(NEEDS) -Iinclude -Isrc $(WARNINGS) $(CPPFLAGS) $(CFLAGS)
LIBRARY = $(COMMON) $(OBJECT_FLAGS)
include platform.mk

# ---- sources ---------------------------------------------------------------------------------------------
# Kernels are compiled once for each instruction set, all other files once, without contraction to fused multiply-add, so
# that only the kernels' results depend on the instruction set. src/kernels.txt says which they are.
kernel_entry = $(shell sed -n 's/^$(1) //p' src/kernels.txt)
KERNELS := $(sort $(wildcard $(addprefix src/,$(call kernel_entry,kernel))))
PLAIN := $(filter-out $(KERNELS),$(sort $(wildcard src/*/*.c)))
HEADERS := $(sort $(wildcard include/mpm/*.h include/mpm/*.hpp))

$(foreach isa,$(ISAS),$(eval ISA_$(isa) := $(call kernel_entry,set $(isa) [a-z0-9_]*)))
# Of kernels debuggers are told the lines only: to follow all of their variables takes compilers minutes.
KERNEL_COMMON := $(call kernel_entry,flags)
KERNEL_FLAGS = $(KERNEL_OPT) $(KERNEL_COMMON) $(if $(filter -g,$(CFLAGS)),-g1)

OBJECTS := $(PLAIN:%.c=$(BUILD)/obj/%.o) $(foreach isa,$(ISAS),$(KERNELS:%.c=$(BUILD)/obj/%.$(isa).o))
STATIC_LIB := $(BUILD)/libmpm.a

# Two examples show CHOLMOD and PETSc as the host's solver, where these are installed; the second by libmpm-petsc.
HAS_CHOLMOD := $(shell $(CC) -E -include suitesparse/cholmod.h -x c /dev/null > /dev/null 2>&1 && echo yes)
PETSC_PACKAGES ?= $(shell $(PKG_CONFIG) --exists 'PETSc >= 3.17' mpi-c 2> /dev/null && echo PETSc mpi-c)
EXAMPLES := $(patsubst examples/%,$(BUILD)/examples/%,$(basename $(filter-out %_mpi.c,$(sort $(wildcard examples/*.c examples/*.cpp)))))
BENCH := $(BUILD)/bench/bench
ifneq ($(HAS_CHOLMOD),yes)
EXAMPLES := $(filter-out %/cholmod_solver,$(EXAMPLES))
endif
ifeq ($(PETSC_PACKAGES),)
EXAMPLES := $(filter-out %/petsc_solver,$(EXAMPLES))
endif
$(BUILD)/examples/cholmod_solver: LIBS += -lcholmod

.PHONY: all help install uninstall amalgamation examples demo bench bench-quick docs clean format format-check
.DELETE_ON_ERROR:
.SUFFIXES:

# ---- library ---------------------------------------------------------------------------------------------
include umat/umat.mk

#: all                   the libraries, static and shared, in $(BUILD): what `make` alone does
all: $(STATIC_LIB) $(SHARED_LIB) $(UMAT_ARCHIVES) $(UMAT_SHARED_LIB)

#: help                  this list
help:
	@awk '/^# ---- / { gsub(/^# -+ | -+$$/, ""); heading = $$0 } \
	  /^#: / { if (heading) print (lines++ ? "\n" : "") heading; heading = ""; sub(/^#:/, " "); gsub(/[$$][(]BUILD[)]/, "$(BUILD)"); print }' Makefile tests/tests.mk bindings/bindings.mk bindings/javascript/rules.mk packaging/packaging.mk mpi/mpi.mk petsc/petsc.mk
	@printf '\n%s\n' 'V=1 shows the commands, -jN sets how many run at once, BUILD=folder builds there, CC and CFLAGS are yours.'

$(BUILD)/obj/src/%.o: src/%.c Makefile platform.mk src/kernels.txt
	@mkdir -p $(@D)
	$(call SAY,CC)
	$(Q)$(CC) $(LIBRARY) $(OPT) -ffp-contract=off -c $< -o $@

define kernel_rule
$(BUILD)/obj/src/%.$(1).o: src/%.c Makefile platform.mk src/kernels.txt
	@mkdir -p $$(@D)
	$$(call SAY,CC)
	$$(Q)$$(CC) $$(LIBRARY) $$(KERNEL_FLAGS) $$(ISA_$(1)) -DMPMI_ISA=$(1) -c $$< -o $$@
endef
$(foreach isa,$(ISAS),$(eval $(call kernel_rule,$(isa))))

$(STATIC_LIB): $(OBJECTS)
	@rm -f $@
	$(call SAY,AR)
	$(Q)$(AR) rcs $@ $(OBJECTS)

$(SHARED_LIB): $(OBJECTS) src/libmpm.map platform.mk
	$(call SAY,LINK)
	$(Q)$(CC) $(SHARED_FLAGS) $(CFLAGS) $(LDFLAGS) $(OBJECTS) $(LIBS) -o $@
	$(Q)for name in $(SHARED_LINKS); do ln -sf $(SHARED) $(BUILD)/$$name; done

# Two files in the place of the library, for hosts that build it with their own sources.
AMALGAMATION := $(BUILD)/amalgamation
#: amalgamation          the whole library as mpm.c and mpm.h, in $(BUILD)/amalgamation
amalgamation: $(AMALGAMATION)/mpm.c
$(AMALGAMATION)/mpm.c: tools/amalgamate.py $(wildcard src/*/*.[ch]) $(HEADERS) Makefile
	$(call SAY,WRITE)
	$(Q)python3 tools/amalgamate.py --version $(VERSION) $(@D)

# ---- installation ----------------------------------------------------------------------------------------
# Where libraries and headers both lie under the prefix, the packages for CMake and pkg-config find one from the other,
# wherever the installation is moved to. Only under /usr, from where nobody moves it, pkg-config has to recognise the
# system's folders. The functions of make take a path with spaces for several: `whole` hides them, `spaced` shows them.
CMAKEDIR = $(LIBDIR)/cmake/mpm
PKGCONFIGDIR = $(LIBDIR)/pkgconfig
BINDIR ?= $(PREFIX)/bin
DATADIR ?= $(PREFIX)/share/libmpm
space := $(subst ,, )
whole = $(subst $(space),|,$(1))
spaced = $(subst |,$(space),$(1))
escaped = $(subst $(space),\\ ,$(call spaced,$(1)))
inside_prefix = $(patsubst $(call whole,$(PREFIX))/%,%,$(filter $(call whole,$(PREFIX))/%,$(call whole,$(1))))
up_to_prefix = $(subst $(space),/,$(patsubst %,..,$(subst /, ,$(call inside_prefix,$(1)))))
is_movable = $(and $(call inside_prefix,$(LIBDIR)),$(call inside_prefix,$(INCLUDEDIR)))
from_cmakedir = $(if $(and $(is_movable),$(call inside_prefix,$(1))),$(call up_to_prefix,$(CMAKEDIR))/$(call spaced,$(call inside_prefix,$(1))),$(1))
INCLUDEDIR_FROM_CMAKEDIR = $(call from_cmakedir,$(INCLUDEDIR))
BINDIR_FROM_CMAKEDIR = $(call from_cmakedir,$(BINDIR))
PC_PREFIX = $(if $(and $(is_movable),$(filter-out /usr,$(call whole,$(PREFIX)))),$${pcfiledir}/$(call up_to_prefix,$(PKGCONFIGDIR)),$(call escaped,$(PREFIX)))
PC_LIBDIR = $(call escaped,$(if $(is_movable),$${prefix}/$(call inside_prefix,$(LIBDIR)),$(LIBDIR)))
PC_INCLUDEDIR = $(call escaped,$(if $(is_movable),$${prefix}/$(call inside_prefix,$(INCLUDEDIR)),$(INCLUDEDIR)))
POINTER_BYTES = $(shell echo __SIZEOF_POINTER__ | $(CC) $(CFLAGS) -E -P -)
SUBSTITUTE = sed $(foreach name,PC_PREFIX PC_LIBDIR PC_INCLUDEDIR VERSION SHARED SONAME IMPORT_LIB INCLUDEDIR_FROM_CMAKEDIR \
  BINDIR_FROM_CMAKEDIR POINTER_BYTES LIBS UMAT_SHARED UMAT_SONAME,-e 's|@$(name)@|$($(name))|')
# Where files are installed, for the shell.
to = "$(DESTDIR)$($(1))$(2)"

#: install               headers, libraries, pkg-config and CMake files, api.json, under PREFIX (/usr/local), in DESTDIR
install: all
	install -d $(call to,INCLUDEDIR,/mpm) $(call to,PKGCONFIGDIR) $(call to,CMAKEDIR)
	install -m 644 $(HEADERS) $(UMAT_INSTALLED_HEADERS) $(call to,INCLUDEDIR,/mpm)
	install -m 644 $(STATIC_LIB) $(UMAT_ARCHIVES) $(IMPORT_LIB:%=$(BUILD)/%) $(call to,LIBDIR)
ifneq (,$(IMPORT_LIB))
	install -d $(call to,BINDIR)
	install -m 755 $(SHARED_LIB) $(call to,BINDIR)
else ifneq (,$(SHARED))
	install -m 755 $(SHARED_LIB) $(call to,LIBDIR)
	for name in $(SHARED_LINKS); do ln -sf $(SHARED) $(call to,LIBDIR)/$$name || exit 1; done
endif
ifneq (,$(UMAT_SHARED_LIB))
	install -m 755 $(UMAT_SHARED_LIB) $(call to,LIBDIR)
	for name in $(UMAT_LINKS); do ln -sf $(UMAT_SHARED) $(call to,LIBDIR)/$$name || exit 1; done
endif
	for name in mpm mpm-static $(UMAT_PC); do $(SUBSTITUTE) pkgconfig/$$name.pc.in > $(call to,PKGCONFIGDIR)/$$name.pc || exit 1; done
	$(SUBSTITUTE) cmake/mpmConfig.cmake.in > $(call to,CMAKEDIR)/mpmConfig.cmake
	$(SUBSTITUTE) cmake/mpmConfigVersion.cmake.in > $(call to,CMAKEDIR)/mpmConfigVersion.cmake
	chmod 644 $(call to,PKGCONFIGDIR)/mpm*.pc $(call to,CMAKEDIR)/*.cmake
	install -d $(call to,DATADIR)
	install -m 644 bindings/api.json $(if $(UMAT_INSTALLED_HEADERS),bindings/umat.json) $(call to,DATADIR)

#: uninstall             takes them away again
uninstall:
	cd $(call to,INCLUDEDIR) && rm -f $(HEADERS:include/%=%) $(UMAT_INSTALLED_HEADERS:umat/include/%=%)
	cd $(call to,LIBDIR) && rm -f libmpm.a $(SHARED) $(SHARED_LINKS) $(IMPORT_LIB) $(notdir $(UMAT_ARCHIVES)) \
	  $(if $(UMAT_SHARED_LIB),$(UMAT_SHARED) $(UMAT_LINKS)) $(addprefix pkgconfig/,$(addsuffix .pc,mpm mpm-static $(UMAT_PC)))
	rm -f $(if $(IMPORT_LIB),$(call to,BINDIR,/$(SHARED))) $(call to,CMAKEDIR)/mpmConfig.cmake $(call to,CMAKEDIR)/mpmConfigVersion.cmake
	rm -f $(call to,DATADIR,/api.json) $(call to,DATADIR,/umat.json)
	rmdir $(call to,INCLUDEDIR,/mpm) $(call to,CMAKEDIR) $(call to,DATADIR) 2>/dev/null || :

# ---- examples and benchmarks -----------------------------------------------------------------------------
$(BUILD)/examples/%: examples/%.c $(STATIC_LIB) Makefile
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CC) $(COMMON) $(OPT) -MF $@.d $< $(STATIC_LIB) $(LDFLAGS) $(LIBS) -o $@

$(BUILD)/examples/%: examples/%.cpp $(STATIC_LIB) Makefile
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CXX) -std=c++17 $(NEEDS) -Iinclude $(CXX_WARNINGS) $(CPPFLAGS) $(CXXFLAGS) $(OPT) -MF $@.d $< \
	  $(STATIC_LIB) $(LDFLAGS) $(LIBS) -o $@

# The benchmark is a host program: it is compiled against an installation and runs the shared library; with the
# solvers of the examples as well, where they are found.
BENCH_HOSTS := $(if $(HAS_CHOLMOD),-DBENCH_CHOLMOD) $(if $(PETSC_PACKAGES),-DBENCH_PETSC)
BENCH_HOST_LIBS = $(if $(HAS_CHOLMOD),-lcholmod) $(if $(PETSC_PACKAGES),$(PETSC_CFLAGS) $(BUILD)/libmpm-petsc.a $(PETSC_LIBS))
$(BENCH): $(wildcard bench/*.[ch] examples/*.h) $(SHARED_LIB) $(STATIC_LIB) $(if $(PETSC_PACKAGES),$(BUILD)/libmpm-petsc.a) Makefile
	@mkdir -p $(@D)
	$(Q)$(MAKE) -s install PREFIX=$(abspath $(@D))/installed DESTDIR= > /dev/null
	$(call SAY,LINK)
	$(Q)$(CC) -std=c11 $(WARNINGS) $(CFLAGS) -O3 -ffp-contract=fast -fno-math-errno -Wno-psabi $(BENCH_HOSTS) $(wildcard bench/*.c) \
	  -I$(@D)/installed/include -L$(@D)/installed/lib -Wl,--enable-new-dtags,-rpath,$(abspath $(@D))/installed/lib $(LDFLAGS) -lmpm \
	  $(BENCH_HOST_LIBS) -lmpm -lm -o $@

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
include bindings/bindings.mk
include packaging/packaging.mk
include mpi/mpi.mk
include petsc/petsc.mk

# ---- reference -------------------------------------------------------------------------------------------
#: docs                  HTML from the headers, in $(BUILD)/docs/html; a declaration without a comment is an error
docs:
	@mkdir -p $(BUILD)/docs
	@VERSION=$(VERSION) OUTPUT=$(BUILD)/docs doxygen docs/Doxyfile
	@echo "$(BUILD)/docs/html/index.html"

# ---- upkeep ----------------------------------------------------------------------------------------------
FORMATTED = $(wildcard include/mpm/*.h include/mpm/*.hpp umat/include/mpm/*.h umat/include/mpm/*.hpp umat/*/*.[ch] mpi/include/mpm/*.h mpi/include/mpm/*.hpp mpi/*/*.[ch] petsc/include/mpm/*.h petsc/include/mpm/*.hpp petsc/*/*.[ch] src/*/*.[ch] examples/*.[ch] examples/*.cpp bench/*.[ch] \
  tests/*/*.[ch] tests/*/*.cpp bindings/*.c bindings/*/*.c bindings/*/*/*.c)
#: format                clang-format on all sources
format:
	clang-format -i $(FORMATTED)
#: format-check          fails where clang-format would change something, or a line is wider than 110 columns
format-check:
	clang-format --dry-run -Werror $(FORMATTED)
	@! grep -nE '.{111}' $(FORMATTED) || { echo 'these lines are longer than 110 columns' >&2; exit 1; }

#: clean                 takes all build folders away
clean:
	rm -rf $(addprefix $(BUILD),/ -asan -tsan -aarch64 -windows -wasm -builds -portable) $(FUZZ)

-include $(OBJECTS:.o=.d) $(EXAMPLES:=.d)
