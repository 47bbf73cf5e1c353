# libmpm-petsc, the companion that solves the linear systems of implicit steps with PETSc: a library, shared and static, that
# stands on the public interface of libmpm and on PETSc with its MPI. `make` alone does not make it; `make petsc` does, where
# pkg-config finds PETSc 3.17 or later and MPI, under the names of PETSC_PACKAGES. Included by the Makefile.

PETSC_LIBS = $(shell $(PKG_CONFIG) --libs $(PETSC_PACKAGES))
# Headers of PETSc are the system's: their warnings are not ours.
PETSC_CFLAGS = -Ipetsc/include $(patsubst -I%,-isystem %,$(shell $(PKG_CONFIG) --cflags-only-I $(PETSC_PACKAGES)))
PETSC_HEADERS := $(sort $(wildcard petsc/include/mpm/*.h petsc/include/mpm/*.hpp))
PETSC_OBJECTS := $(patsubst %.c,$(BUILD)/obj/%.o,$(sort $(wildcard petsc/src/*.c)))
PETSC_STATIC := $(BUILD)/libmpm-petsc.a
PETSC_SONAME := libmpm-petsc.so.0
PETSC_SHARED := libmpm-petsc.so.$(VERSION)
PETSC_LINKS := $(PETSC_SONAME) libmpm-petsc.so
PETSC_FLAGS = -shared -Wl,-soname,$(PETSC_SONAME) -Wl,--version-script=petsc/src/libmpm-petsc.map $(NO_UNDEFINED) -Wl,-z,noexecstack

ifeq ($(SYSTEM),macos)
PETSC_SONAME := libmpm-petsc.0.dylib
PETSC_SHARED := libmpm-petsc.$(VERSION).dylib
PETSC_LINKS := $(PETSC_SONAME) libmpm-petsc.dylib
PETSC_FLAGS = -dynamiclib -install_name @rpath/$(PETSC_SONAME) -compatibility_version 0 -current_version $(VERSION) \
  -Wl,-exported_symbol,'_mpm_petsc_*'
endif

$(BUILD)/obj/petsc/%.o: petsc/%.c Makefile platform.mk petsc/petsc.mk
	@mkdir -p $(@D)
	$(call SAY,CC)
	$(Q)$(CC) $(LIBRARY) $(PETSC_CFLAGS) $(OPT) -c $< -o $@

$(PETSC_STATIC): $(PETSC_OBJECTS)
	@rm -f $@
	$(call SAY,AR)
	$(Q)$(AR) rcs $@ $^

$(BUILD)/$(PETSC_SHARED): $(PETSC_OBJECTS) $(SHARED_LIB) petsc/src/libmpm-petsc.map petsc/petsc.mk
	$(call SAY,LINK)
	$(Q)$(CC) $(PETSC_FLAGS) $(CFLAGS) $(LDFLAGS) $(PETSC_OBJECTS) -L$(BUILD) -lmpm $(PETSC_LIBS) $(LIBS) -o $@
	$(Q)for name in $(PETSC_LINKS); do ln -sf $(PETSC_SHARED) $(BUILD)/$$name; done

$(BUILD)/examples/petsc_solver: examples/petsc_solver.c $(PETSC_STATIC) $(STATIC_LIB) Makefile petsc/petsc.mk
	@mkdir -p $(@D)
	$(call SAY,LINK)
	$(Q)$(CC) $(COMMON) $(PETSC_CFLAGS) $(OPT) -MF $@.d $< $(PETSC_STATIC) $(STATIC_LIB) $(LDFLAGS) $(PETSC_LIBS) $(LIBS) -o $@

.PHONY: petsc check-petsc install-petsc uninstall-petsc

# ---- PETSc -----------------------------------------------------------------------------------------------
#: petsc                 libmpm-petsc, static and shared, in $(BUILD), where PETSc is: docs/distributed.md
petsc: $(PETSC_STATIC) $(BUILD)/$(PETSC_SHARED)

#: check-petsc           its tests on 1 to 4 processes, an installation of it, and the example; some minutes
check-petsc: all
	@mkdir -p $(BUILD)/tests/scratch
	@env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL $(TEST_ENVIRONMENT) bash petsc/tests/run.sh

# Its header includes that of MPI, which pkg-config finds for the host as it was found here.
PETSC_SUBSTITUTE = $(SUBSTITUTE) -e 's|@PETSC_REQUIRES@|$(addprefix $(comma) ,$(filter-out PETSc,$(PETSC_PACKAGES)))|'

#: install-petsc         its header, libraries and files for pkg-config, beside those of `make install`
install-petsc: petsc
	install -d $(call to,INCLUDEDIR,/mpm) $(call to,PKGCONFIGDIR) $(call to,DATADIR)
	install -m 644 bindings/petsc.json $(call to,DATADIR)
	install -m 644 $(PETSC_HEADERS) $(call to,INCLUDEDIR,/mpm)
	install -m 644 $(PETSC_STATIC) $(call to,LIBDIR)
	install -m 755 $(BUILD)/$(PETSC_SHARED) $(call to,LIBDIR)
	for name in $(PETSC_LINKS); do ln -sf $(PETSC_SHARED) $(call to,LIBDIR)/$$name || exit 1; done
	for name in mpm-petsc mpm-petsc-static; do $(PETSC_SUBSTITUTE) pkgconfig/$$name.pc.in > $(call to,PKGCONFIGDIR)/$$name.pc || exit 1; done
	chmod 644 $(call to,PKGCONFIGDIR)/mpm-petsc*.pc

#: uninstall-petsc       takes them away again
uninstall-petsc:
	cd $(call to,INCLUDEDIR) && rm -f $(PETSC_HEADERS:petsc/include/%=%)
	cd $(call to,LIBDIR) && rm -f $(notdir $(PETSC_STATIC)) $(PETSC_SHARED) $(PETSC_LINKS) pkgconfig/mpm-petsc.pc pkgconfig/mpm-petsc-static.pc
	rm -f $(call to,DATADIR,/petsc.json)

-include $(PETSC_OBJECTS:.o=.d)
