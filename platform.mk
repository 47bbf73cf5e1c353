# What the Makefile does in another way by system, which the compiler names: how a shared library is called, linked and
# exported, and which instruction sets have kernels. Included by the Makefile.

TARGET := $(shell $(CC) -dumpmachine)
SYSTEM := $(if $(findstring mingw,$(TARGET)),windows,$(if $(findstring darwin,$(TARGET)),macos,$(if $(findstring wasm,$(TARGET)),wasm,elf)))

LIBS := -lm -lpthread
# Clang tells which loops it could not vectorise; with little optimisation it is none.
OBJECT_FLAGS := -fPIC -fvisibility=hidden -Wno-pass-failed
# With this flag a float is one also where the processor's conventions would compute with doubles, as on s390.
ifeq (1,$(shell echo __FLT_EVAL_METHOD__ | $(CC) $(CFLAGS) -std=c11 -E -P -))
OBJECT_FLAGS += -fexcess-precision=fast
endif

# The sets of src/kernels.txt that are for this processor.
ISAS := $(shell awk -v target=$(TARGET) '/^set / && ($$3 == "any" || index(target, $$3)) { print $$2 }' src/kernels.txt)

# SHARED is the file, SHARED_LINKS other names of it, SHARED_FLAGS how it is linked.
SONAME := libmpm.so.0
SHARED := libmpm.so.$(VERSION)
SHARED_LINKS := $(SONAME) libmpm.so
NO_UNDEFINED ?= -Wl,-z,defs
SHARED_FLAGS = -shared -Wl,-soname,$(SONAME) -Wl,--version-script=src/libmpm.map $(NO_UNDEFINED) -Wl,-z,noexecstack
IMPORT_LIB :=

# Programs look for the library where @rpath says. Nobody has run this so far.
ifeq ($(SYSTEM),macos)
SONAME := libmpm.0.dylib
SHARED := libmpm.$(VERSION).dylib
SHARED_LINKS := $(SONAME) libmpm.dylib
SHARED_FLAGS = -dynamiclib -install_name @rpath/$(SONAME) -compatibility_version 0 -current_version $(VERSION) \
  -Wl,-exported_symbol,'_mpm_*'
endif

# Programs are linked to the import library. Stacks are aligned to 16 bytes there, which the compiler forgets for wider
# registers: the assembler mends that, where it can.
ifeq ($(SYSTEM),windows)
LIBS := -lm
# The C library's isfinite is a macro with a branch for floats.
OBJECT_FLAGS := -DMPM_BUILD -D__USE_MINGW_ANSI_STDIO=1 -Wno-float-conversion
SONAME := libmpm-0.dll
SHARED := $(SONAME)
SHARED_LINKS :=
IMPORT_LIB := libmpm.dll.a
SHARED_FLAGS = -shared -static-libgcc -Wl,--out-implib,$(BUILD)/$(IMPORT_LIB)
UNALIGNED := -Wa,-muse-unaligned-vector-move
ifeq (yes,$(shell $(CC) $(UNALIGNED) -c -x c /dev/null -o /dev/null 2> /dev/null && echo yes))
OBJECT_FLAGS += $(UNALIGNED)
else
ISAS := baseline
OBJECT_FLAGS += -DMPM_BASELINE_ONLY
endif
endif

# One static library, without threads.
ifeq ($(SYSTEM),wasm)
LIBS := -lm
OBJECT_FLAGS := -DMPM_NO_THREADS -Wno-pass-failed
SHARED :=
SHARED_LINKS :=
endif

SHARED_LIB := $(SHARED:%=$(BUILD)/%)
