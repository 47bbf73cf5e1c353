# libmpm-mpi, the companion that joins the processes of MPI to one problem: a library, shared and static, that stands on the
# public interface of libmpm and on MPI. `make` alone does not make it; `make mpi` does, where MPI is. Included by the Makefile.
#
# MPI is found by pkg-config under the names of MPI_PACKAGES, the first that is there, or else by the compiler MPICC.
# MPI_PACKAGE, or MPI_CFLAGS and MPI_LIBS, say it otherwise. A build folder is for one MPI.

MPI_PACKAGES ?= ompi-c mpich mpi-c
MPI_PACKAGE ?= $(firstword $(foreach name,$(MPI_PACKAGES),$(shell $(PKG_CONFIG) --exists $(name) 2> /dev/null && echo $(name))))
MPICC ?= mpicc
# Headers of MPI are the system's: their warnings are not ours.
MPI_CFLAGS ?= $(patsubst -I%,-isystem %,$(if $(MPI_PACKAGE),$(shell $(PKG_CONFIG) --cflags $(MPI_PACKAGE)),$(filter -I% -D%,$(shell $(MPICC) -show 2> /dev/null))))
MPI_LIBS ?= $(if $(MPI_PACKAGE),$(shell $(PKG_CONFIG) --libs $(MPI_PACKAGE)),$(filter -L% -l% -Wl% -pthread,$(shell $(MPICC) -show 2> /dev/null)))

MPI_HEADERS := $(sort $(wildcard mpi/include/mpm/*.h mpi/include/mpm/*.hpp))
MPI_OBJECTS := $(patsubst %.c,$(BUILD)/obj/%.o,$(sort $(wildcard mpi/src/*.c)))
MPI_STATIC := $(BUILD)/libmpm-mpi.a
MPI_SONAME := libmpm-mpi.so.0
MPI_SHARED := libmpm-mpi.so.$(VERSION)
MPI_LINKS := $(MPI_SONAME) libmpm-mpi.so
MPI_FLAGS = -shared -Wl,-soname,$(MPI_SONAME) -Wl,--version-script=mpi/src/libmpm-mpi.map $(NO_UNDEFINED) -Wl,-z,noexecstack

ifeq ($(SYSTEM),macos)
MPI_SONAME := libmpm-mpi.0.dylib
MPI_SHARED := libmpm-mpi.$(VERSION).dylib
MPI_LINKS := $(MPI_SONAME) libmpm-mpi.dylib
MPI_FLAGS = -dynamiclib -install_name @rpath/$(MPI_SONAME) -compatibility_version 0 -current_version $(VERSION) \
  -Wl,-exported_symbol,'_mpm_mpi_*'
endif

$(BUILD)/obj/mpi/%.o: mpi/%.c Makefile platform.mk mpi/mpi.mk
	@mkdir -p $(@D)
	$(call SAY,CC)
	$(Q)$(CC) $(LIBRARY) -Impi/include $(MPI_CFLAGS) $(OPT) -c $< -o $@

$(MPI_STATIC): $(MPI_OBJECTS)
	@rm -f $@
	$(call SAY,AR)
	$(Q)$(AR) rcs $@ $^

$(BUILD)/$(MPI_SHARED): $(MPI_OBJECTS) $(SHARED_LIB) mpi/src/libmpm-mpi.map mpi/mpi.mk
	$(call SAY,LINK)
	$(Q)$(CC) $(MPI_FLAGS) $(CFLAGS) $(LDFLAGS) $(MPI_OBJECTS) -L$(BUILD) -lmpm $(MPI_LIBS) $(LIBS) -o $@
	$(Q)for name in $(MPI_LINKS); do ln -sf $(MPI_SHARED) $(BUILD)/$$name; done

MPI_EXAMPLES := $(patsubst %.c,$(BUILD)/%,$(wildcard examples/*_mpi.c))
$(BUILD)/examples/%_mpi: examples/%_mpi.c $(MPI_STATIC) $(STATIC_LIB) Makefile mpi/mpi.mk
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CC) $(COMMON) -Impi/include $(MPI_CFLAGS) $(OPT) -MF $@.d $< $(MPI_STATIC) $(STATIC_LIB) $(LDFLAGS) $(MPI_LIBS) $(LIBS) -o $@

.PHONY: mpi mpi-examples check-mpi install-mpi uninstall-mpi

# ---- several machines ------------------------------------------------------------------------------------
#: mpi                   libmpm-mpi, static and shared, in $(BUILD); MPI_PACKAGE=mpich chooses the MPI: docs/distributed.md
mpi: $(MPI_STATIC) $(BUILD)/$(MPI_SHARED)

#: mpi-examples          the programs of examples/ that run on several processes, in $(BUILD)/examples
mpi-examples: $(MPI_EXAMPLES)

#: check-mpi             its tests on 1 to 4 processes of Open MPI and MPICH, and an installation of it. What is missing is
#:                       installed on Debian, and a failure elsewhere, unless SKIP_MISSING=1
check-mpi: all
	@mkdir -p $(BUILD)/tests/scratch
	@env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL $(TEST_ENVIRONMENT) bash mpi/tests/run.sh

# Its header includes that of MPI, which pkg-config finds for the host as it was found here.
MPI_SUBSTITUTE = $(SUBSTITUTE) -e 's|@MPI_REQUIRES@|$(if $(MPI_PACKAGE),$(comma) $(MPI_PACKAGE))|' \
  -e 's|@MPI_CFLAGS@|$(if $(MPI_PACKAGE),,$(patsubst -isystem,-I,$(MPI_CFLAGS)))|' -e 's|@MPI_LIBS@|$(if $(MPI_PACKAGE),,$(MPI_LIBS))|'
comma := ,

#: install-mpi           its header, libraries and files for pkg-config, beside those of `make install`
install-mpi: mpi
	install -d $(call to,INCLUDEDIR,/mpm) $(call to,PKGCONFIGDIR) $(call to,DATADIR)
	install -m 644 bindings/mpi.json $(call to,DATADIR)
	install -m 644 $(MPI_HEADERS) $(call to,INCLUDEDIR,/mpm)
	install -m 644 $(MPI_STATIC) $(call to,LIBDIR)
	install -m 755 $(BUILD)/$(MPI_SHARED) $(call to,LIBDIR)
	for name in $(MPI_LINKS); do ln -sf $(MPI_SHARED) $(call to,LIBDIR)/$$name || exit 1; done
	for name in mpm-mpi mpm-mpi-static; do $(MPI_SUBSTITUTE) pkgconfig/$$name.pc.in > $(call to,PKGCONFIGDIR)/$$name.pc || exit 1; done
	chmod 644 $(call to,PKGCONFIGDIR)/mpm-mpi*.pc

#: uninstall-mpi         takes them away again
uninstall-mpi:
	cd $(call to,INCLUDEDIR) && rm -f $(MPI_HEADERS:mpi/include/%=%)
	cd $(call to,LIBDIR) && rm -f $(notdir $(MPI_STATIC)) $(MPI_SHARED) $(MPI_LINKS) pkgconfig/mpm-mpi.pc pkgconfig/mpm-mpi-static.pc
	rm -f $(call to,DATADIR,/mpi.json)

-include $(MPI_OBJECTS:.o=.d) $(MPI_EXAMPLES:=.d)
