# libmpm-umat, the companion that makes a material of a UMAT or a VUMAT: one library, shared and static, that stands on
# the public interface of libmpm alone, and the utility routines of Abaqus, as an archive from which a host's link takes
# what its subroutines call. Where there are no symbol versions or no jumps out of Fortran, there is none of it.
# Included by the Makefile.

UMAT_HEADERS := $(sort $(wildcard umat/include/mpm/*.h umat/include/mpm/*.hpp))
UMAT_OBJECTS := $(patsubst %.c,$(BUILD)/obj/%.o,$(sort $(wildcard umat/src/*.c)))
UTILITY_OBJECTS := $(patsubst %.c,$(BUILD)/obj/%.o,$(sort $(wildcard umat/utilities/*.c)))
UMAT_STATIC := $(BUILD)/libmpm-umat.a
UMAT_UTILITIES := $(BUILD)/libmpm-umat-utilities.a
UMAT_SONAME := libmpm-umat.so.0
UMAT_SHARED := libmpm-umat.so.$(VERSION)
UMAT_LINKS := $(UMAT_SONAME) libmpm-umat.so
UMAT_FLAGS = -shared -Wl,-soname,$(UMAT_SONAME) -Wl,--version-script=umat/src/libmpm-umat.map $(NO_UNDEFINED) -Wl,-z,noexecstack

ifeq ($(SYSTEM),macos)
UMAT_SONAME := libmpm-umat.0.dylib
UMAT_SHARED := libmpm-umat.$(VERSION).dylib
UMAT_LINKS := $(UMAT_SONAME) libmpm-umat.dylib
UMAT_FLAGS = -dynamiclib -install_name @rpath/$(UMAT_SONAME) -compatibility_version 0 -current_version $(VERSION) \
  -Wl,-exported_symbol,'_mpm_umat_*' -Wl,-exported_symbol,'_mpm_vumat_*'
endif

ifneq (,$(filter $(SYSTEM),elf macos))
UMAT_SHARED_LIB := $(BUILD)/$(UMAT_SHARED)
UMAT_ARCHIVES := $(UMAT_STATIC) $(UMAT_UTILITIES)
UMAT_PC := mpm-umat mpm-umat-static
UMAT_INSTALLED_HEADERS := $(UMAT_HEADERS)
endif

$(BUILD)/obj/umat/%.o: umat/%.c Makefile platform.mk umat/umat.mk
	@mkdir -p $(@D)
	$(call SAY,CC)
	$(Q)$(CC) $(LIBRARY) -Iumat/include $(KERNEL_OPT) -ffp-contract=off -c $< -o $@

$(UMAT_STATIC): $(UMAT_OBJECTS)
$(UMAT_UTILITIES): $(UTILITY_OBJECTS)
$(UMAT_STATIC) $(UMAT_UTILITIES):
	@rm -f $@
	$(call SAY,AR)
	$(Q)$(AR) rcs $@ $^

$(BUILD)/$(UMAT_SHARED): $(UMAT_OBJECTS) $(SHARED_LIB) umat/src/libmpm-umat.map umat/umat.mk
	$(call SAY,LINK)
	$(Q)$(CC) $(UMAT_FLAGS) $(CFLAGS) $(LDFLAGS) $(UMAT_OBJECTS) -L$(BUILD) -lmpm $(LIBS) -o $@
	$(Q)for name in $(UMAT_LINKS); do ln -sf $(UMAT_SHARED) $(BUILD)/$$name; done

# ---- the example: a host in C with a UMAT in Fortran -----------------------------------------------------
ifeq ($(origin FC),default)
FC := gfortran
endif
UMAT_EXAMPLE := $(BUILD)/umat/footing
$(BUILD)/umat/%.o: umat/example/%.f90 Makefile umat/umat.mk
	@mkdir -p $(@D)
	$(call SAY,FC)
	$(Q)$(FC) -g -O2 -Wall -Wno-unused-dummy-argument -Werror -c $< -o $@
$(UMAT_EXAMPLE): umat/example/footing.c examples/svg.h $(BUILD)/umat/soil.o $(UMAT_ARCHIVES) $(STATIC_LIB) Makefile umat/umat.mk
	$(call SAY,LINK)
	$(Q)$(CC) $(COMMON) -Iumat/include -Iexamples $(OPT) -MF $@.d $< $(BUILD)/umat/soil.o $(UMAT_ARCHIVES) $(STATIC_LIB) \
	  $(LDFLAGS) -lgfortran $(LIBS) -o $@

-include $(UMAT_OBJECTS:.o=.d) $(UTILITY_OBJECTS:.o=.d) $(UMAT_EXAMPLE).d
