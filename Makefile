# Jolon: one Makefile for everything. `make help` lists what it can do.
MAKEFLAGS += --no-builtin-rules
.SUFFIXES:
.SECONDARY:
.DEFAULT_GOAL := all

# --- what to build with -------------------------------------------------------------------------
CC       ?= gcc
ifeq ($(origin CC),default)
CC       := gcc
endif
ifeq ($(origin CXX),default)
CXX      := g++
endif
OPT      ?= -O2
SAN      ?=
PREFIX   ?= /usr/local
DESTDIR  ?=

# Sanitized objects have a tree of their own.
comma    := ,
empty    :=
space    := $(empty) $(empty)
BUILD    := build$(if $(SAN),/san-$(subst $(comma),-,$(SAN)))
BIN      := $(BUILD)/bin
OBJ      := $(BUILD)/obj
IDL      := $(BUILD)/idl

WARN := -Wall -Wextra -Wpedantic -Werror -Wshadow -Wconversion -Wsign-conversion -Wcast-qual \
        -Wcast-align -Wstrict-prototypes -Wmissing-prototypes -Wundef -Wvla -Wformat=2 \
        -Wnull-dereference -Wwrite-strings
CFLAGS_ALL := -std=c17 $(OPT) -g -fno-common -ffp-contract=off -fno-strict-overflow -pthread \
        -D_GNU_SOURCE -I. $(WARN)
# For the one file of C++: what both languages know.
CXXFLAGS_ALL = $(filter-out -std=% -Wstrict-prototypes -Wmissing-prototypes,$(CFLAGS_ALL))
LDFLAGS_ALL := -pthread
ifneq ($(SAN),)
CFLAGS_ALL  += -fsanitize=$(SAN) -fno-omit-frame-pointer -fno-sanitize-recover=all
LDFLAGS_ALL += -fsanitize=$(SAN)
endif
# gcc's thread sanitizer knows no fences and says so for each; what is behind them are readers of
# another process, which it could not see anyway.
ifneq ($(findstring thread,$(SAN)),)
CFLAGS_ALL  += -Wno-tsan
endif

# --- set-up: packages ---------------------------------------------------------------------------
PACKAGES := $(shell sed -e 's/\#.*//' packages.txt)
STAMP    := build/.packages
$(STAMP): packages.txt supervisor/install-packages
	@supervisor/install-packages packages.txt
	@mkdir -p $(@D) && touch $@

# --- sources ------------------------------------------------------------------------------------
WORLD_SRC    := $(wildcard world/*.c)
IPC_SRC      := $(wildcard ipc/*.c)
CONFIG_SRC   := $(wildcard config/*.c)
WORLDCTL_SRC := $(wildcard worldctl/*.c)
MOVER_SRC    := $(wildcard mover/*.c)
COLLIDER_SRC := $(wildcard collider/*.c)
RENDERER_SRC := $(wildcard renderer/*.c)
REPORTER_SRC := $(wildcard reporter/*.c)
MONITOR_SRC  := $(wildcard monitor/*.c)
BENCH_SRC    := $(wildcard bench/*.c)
BENCH_CPP    := $(wildcard bench/*.cpp)
UNIT_SRC     := $(wildcard tests/unit/test_*.c)
PROPERTY_SRC := $(wildcard tests/property/test_*.c)
SUPPORT_SRC  := $(wildcard tests/support/*.c)

objects = $(patsubst %.c,$(OBJ)/%.o,$(1))
WORLD    := $(call objects,$(WORLD_SRC))
IPC      := $(call objects,$(IPC_SRC))
CONFIG   := $(call objects,$(CONFIG_SRC))
SUPPORT  := $(call objects,$(SUPPORT_SRC))
# The steps without their main, for tests and benchmarks.
STEPS    := $(call objects,$(filter-out %/main.c,$(MOVER_SRC) $(COLLIDER_SRC)))
# The scene without the drawing: nothing here knows of graphics.
SCENE    := $(call objects,$(addprefix renderer/,camera.c effects.c follow.c foliage.c ground.c image.c \
        map.c mesh.c paint.c scene.c scene_plants.c scene_puffs.c scenery.c smooth.c statistics.c \
        texture.c track.c))
STATUS   := $(OBJ)/idl/status.o

pc = $(shell pkg-config --$(1) $(2) 2>/dev/null)
DDS_CFLAGS    = $(call pc,cflags,CycloneDDS) -I$(IDL)
DDS_LIBS      = $(call pc,libs,CycloneDDS)
RENDER_CFLAGS = $(call pc,cflags,epoxy egl libpng freetype2)
# Not egl: libepoxy opens it when there is one, and a machine without it is told so.
RENDER_LIBS   = $(call pc,libs,epoxy libpng freetype2)
CONFIG_LIBS   = $(call pc,libs,libconfig assimp)
JSON_CFLAGS   = $(call pc,cflags,libcjson)
JSON_LIBS     = $(call pc,libs,libcjson)
CURSES_LIBS   = $(call pc,libs,ncursesw)
HASH_LIBS     = $(call pc,libs,libxxhash)
# The engines that jolon-bench measures us beside; their headers are not held to our warnings.
PEER_CFLAGS   = $(patsubst -I%,-isystem %,$(call pc,cflags,bullet))
PEER_LIBS     = $(call pc,libs,ode) $(filter-out -lBulletSoftBody -lBulletDynamics,$(call pc,libs,bullet))
TEST_LIBS     = $(call pc,libs,cmocka)
BASE_LIBS     = $(HASH_LIBS) -lm

PROGRAMS := $(BIN)/jolon-world $(BIN)/jolon-mover $(BIN)/jolon-collider $(BIN)/jolon-renderer \
        $(BIN)/jolon-reporter $(BIN)/jolon-ctl $(BIN)/jolon-monitor $(BIN)/jolon-bench $(BIN)/jolon
UNIT_TESTS     := $(patsubst tests/unit/%.c,$(BUILD)/tests/unit/%,$(UNIT_SRC))
PROPERTY_TESTS := $(patsubst tests/property/%.c,$(BUILD)/tests/property/%,$(PROPERTY_SRC))

.PHONY: all run test check bench install uninstall format lint clean help
all: $(PROGRAMS)

# --- programs -----------------------------------------------------------------------------------
link = @mkdir -p $(@D); echo "  LD $@"; $(CC) $(LDFLAGS_ALL) -o $@ $(filter %.o,$^) $(1)

$(BIN)/jolon-world: $(call objects,$(WORLDCTL_SRC)) $(CONFIG) $(IPC) $(WORLD)
	$(call link,$(CONFIG_LIBS) $(JSON_LIBS) $(BASE_LIBS))
$(BIN)/jolon-mover: $(call objects,$(MOVER_SRC)) $(IPC) $(WORLD)
	$(call link,$(BASE_LIBS))
$(BIN)/jolon-collider: $(call objects,$(COLLIDER_SRC)) $(IPC) $(WORLD)
	$(call link,$(BASE_LIBS))
$(BIN)/jolon-renderer: $(call objects,$(RENDERER_SRC)) $(IPC) $(WORLD)
	$(call link,$(RENDER_LIBS) $(BASE_LIBS))
$(BIN)/jolon-reporter: $(call objects,$(filter-out reporter/ctl%.c,$(REPORTER_SRC))) $(STATUS) $(IPC) $(WORLD)
	$(call link,$(DDS_LIBS) $(BASE_LIBS))
$(BIN)/jolon-ctl: $(call objects,$(filter reporter/ctl%.c reporter/dds%.c,$(REPORTER_SRC))) $(STATUS) $(IPC) $(WORLD)
	$(call link,$(DDS_LIBS) $(JSON_LIBS) $(BASE_LIBS))
$(BIN)/jolon-monitor: $(call objects,$(MONITOR_SRC) $(filter reporter/dds%.c,$(REPORTER_SRC))) $(STATUS) $(IPC) $(WORLD)
	$(call link,$(DDS_LIBS) $(CURSES_LIBS) $(JSON_LIBS) $(BASE_LIBS))
$(BIN)/jolon-bench: $(call objects,$(BENCH_SRC)) $(patsubst %.cpp,$(OBJ)/%.o,$(BENCH_CPP)) $(STEPS) $(CONFIG) $(IPC) $(WORLD)
	$(call link,$(CONFIG_LIBS) $(JSON_LIBS) $(PEER_LIBS) $(BASE_LIBS) -lstdc++)
$(BIN)/jolon: supervisor/jolon
	@mkdir -p $(@D); install -m 755 $< $@

# --- objects ------------------------------------------------------------------------------------
# Flags reach an object through its folder: only these folders see these libraries.
$(OBJ)/reporter/%.o $(OBJ)/monitor/%.o: CFLAGS_EXTRA = $(DDS_CFLAGS) $(JSON_CFLAGS)
$(OBJ)/renderer/%.o: CFLAGS_EXTRA = $(RENDER_CFLAGS)
$(OBJ)/worldctl/%.o $(OBJ)/bench/%.o: CFLAGS_EXTRA = $(JSON_CFLAGS)
$(call objects,$(REPORTER_SRC) $(MONITOR_SRC)): $(IDL)/status.h

$(OBJ)/%.o: %.c $(BUILD)/flags | $(STAMP)
	@mkdir -p $(@D); echo "  CC $<"
	@$(CC) $(CFLAGS_ALL) $(CFLAGS_EXTRA) -MMD -MP -c -o $@ $<

$(OBJ)/%.o: %.cpp $(BUILD)/flags | $(STAMP)
	@mkdir -p $(@D); echo "  CXX $<"
	@$(CXX) -std=c++17 $(CXXFLAGS_ALL) $(PEER_CFLAGS) -MMD -MP -c -o $@ $<

# Generated from the IDL; generated code is not held to our warnings.
$(IDL)/status.c $(IDL)/status.h &: ipc/status.idl | $(STAMP)
	@mkdir -p $(IDL); echo "  IDL $<"; idlc -l c -o $(IDL) $<
$(STATUS): $(IDL)/status.c $(IDL)/status.h $(BUILD)/flags
	@mkdir -p $(@D); $(CC) $(filter-out $(WARN),$(CFLAGS_ALL)) $(DDS_CFLAGS) -c -o $@ $<

# Everything is built again when the compiler or its flags change.
$(BUILD)/flags: FORCE
	@mkdir -p $(@D); echo '$(CC) $(CFLAGS_ALL) $(LDFLAGS_ALL)' | cmp -s - $@ || \
		echo '$(CC) $(CFLAGS_ALL) $(LDFLAGS_ALL)' > $@
.PHONY: FORCE
FORCE:

# --- tests --------------------------------------------------------------------------------------
$(BUILD)/tests/%: $(OBJ)/tests/%.o $(SUPPORT) $(STEPS) $(CONFIG) $(IPC) $(WORLD)
	$(call link,$(TEST_LIBS) $(CONFIG_LIBS) $(BASE_LIBS))

$(BUILD)/tests/unit/test_scene: $(SCENE)

check: $(UNIT_TESTS) $(PROPERTY_TESTS)
	@tests/run --build $(BUILD) unit property

test: all $(UNIT_TESTS) $(PROPERTY_TESTS)
	@tests/run --build $(BUILD) $(if $(SAN),--sanitizer $(SAN)) unit property system

# --- running ------------------------------------------------------------------------------------
# `make SECONDS=n`: bash has a variable of that name, but a make variable is only ours.
SECONDS  ?= 60
SCENARIO ?=
OUT      ?= out
run: all
	@$(BIN)/jolon run --seconds $(SECONDS) --out $(OUT) $(SCENARIO)

bench: all
	@bench/run $(BIN)/jolon-bench

# --- installing ---------------------------------------------------------------------------------
SHARE = $(DESTDIR)$(PREFIX)/share/jolon
install: all
	install -d $(DESTDIR)$(PREFIX)/bin $(SHARE)
	install -m 755 $(PROGRAMS) $(DESTDIR)$(PREFIX)/bin
	cp -R config/kinds config/models config/scenarios config/cyclonedds.xml $(SHARE)
	install -d $(DESTDIR)$(PREFIX)/lib/systemd/system
	sed 's|@BIN@|$(PREFIX)/bin|' supervisor/jolon@.service \
		> $(DESTDIR)$(PREFIX)/lib/systemd/system/jolon@.service
uninstall:
	rm -f $(addprefix $(DESTDIR)$(PREFIX)/bin/,$(notdir $(PROGRAMS)))
	rm -f $(DESTDIR)$(PREFIX)/lib/systemd/system/jolon@.service
	rm -rf $(SHARE)

# --- keeping it tidy ----------------------------------------------------------------------------
C_FILES = $(shell git ls-files '*.c' '*.h')
format:
	clang-format -i $(C_FILES)
lint:
	@tests/lint
clean:
	rm -rf build
help:
	@echo 'make run [SECONDS=60] [SCENARIO=file]   run the Hunter-Liggett world and look at it'
	@echo 'make test                               every test; SAN=address,undefined sanitized'
	@echo 'make check                              unit and property tests only'
	@echo 'make bench                              measure; results in bench/results/'
	@echo 'make install PREFIX=/usr/local DESTDIR= make uninstall'
	@echo 'make format | lint | clean'

-include $(shell find $(OBJ) -name '*.d' 2>/dev/null)
