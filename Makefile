# Jolon: one Makefile for everything. `make help` lists what it can do.
MAKEFLAGS += --no-builtin-rules
.SUFFIXES:
.SECONDARY:
.DEFAULT_GOAL := all

# All processors build, unless -j says how many. Goals that do more than build run one after another
# when several are named (`make clean all`), and tests/lint calls make for itself.
BUILDING := all tests examples fuzzers crash build/%
ifeq ($(MAKELEVEL)$(filter lint,$(MAKECMDGOALS))$(if $(filter-out $(BUILDING),$(MAKECMDGOALS)),$(word 2,$(MAKECMDGOALS))),0)
ifeq ($(filter -j% --jobserver%,$(MAKEFLAGS)),)
MAKEFLAGS += -j$(shell nproc)
endif
endif

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
CRASHPOINTS ?=
PREFIX   ?= /usr/local
DESTDIR  ?=

# Sanitized objects have a tree of their own, and so have those with crash points.
comma    := ,
empty    :=
space    := $(empty) $(empty)
BUILD    ?= build$(if $(CRASHPOINTS),/crash)$(if $(SAN),/san-$(subst $(comma),-,$(SAN)))
BIN      := $(BUILD)/bin
OBJ      := $(BUILD)/obj
IDL      := $(BUILD)/idl

WARN := -Wall -Wextra -Wpedantic -Werror -Wshadow -Wconversion -Wsign-conversion -Wcast-qual \
        -Wcast-align -Wstrict-prototypes -Wmissing-prototypes -Wundef -Wvla -Wformat=2 \
        -Wnull-dereference -Wwrite-strings
# gcc 12.1 and 12.2 fuse products and sums when they make vectors, although -ffp-contract=off
# forbids it (GCC bug 107647; gcc 11 does so for complex products on aarch64). Such an instruction
# rounds once instead of twice. So these compilers are not told of the instructions; on aarch64,
# where no option hides them, they make no vectors for a machine that OPT names.
# Both are looked up in a recipe, when the compiler has been installed.
COMPILER = $(eval COMPILER := $(shell $(CC) -dumpmachine; $(CC) -dumpfullversion -dumpversion))$(COMPILER)
NO_FUSING = $(if $(filter 11.% 12.0.% 12.1.% 12.2.%,$(COMPILER)),$(if $(filter x86_64-%,$(COMPILER)),\
        -mno-fma -mno-fma4 -mno-avx512f,$(if $(filter -m%,$(CC) $(OPT)),-fno-tree-vectorize)))
CFLAGS_ALL = -std=c17 $(OPT) -g -fno-common -ffp-contract=off $(NO_FUSING) -fno-strict-overflow -pthread \
        -D_GNU_SOURCE -I. $(WARN)
# For the one file of C++: what both languages know.
CXXFLAGS_ALL = $(filter-out -std=% -Wstrict-prototypes -Wmissing-prototypes,$(CFLAGS_ALL))
LDFLAGS_ALL := -pthread -Wl,--wrap=malloc,--wrap=calloc,--wrap=realloc,--wrap=strdup,--wrap=__strdup
ifneq ($(CRASHPOINTS),)
CFLAGS_ALL  += -DCRASHPOINTS
endif
ifneq ($(SAN),)
CFLAGS_ALL  += -fsanitize=$(SAN) -fno-omit-frame-pointer -fno-sanitize-recover=all
LDFLAGS_ALL += -fsanitize=$(SAN)
endif
# gcc's thread sanitizer knows no fences and says so for each; what is behind them are readers of
# another process, which it could not see anyway.
ifneq ($(findstring thread,$(SAN)),)
CFLAGS_ALL  += -Wno-tsan
endif

# --- how far it is ------------------------------------------------------------------------------
# $(call say,WORDS) prints one line a step: "[ 37/412] CC world/entity.c"; `make -s` prints none.
# When the first step begins, make -n says how many there are.
LETTERS := $(filter-out --%,$(firstword -$(MAKEFLAGS)))
STEP    :=
# The number of steps, and how many digits it has.
STEPS_TO_DO = $(eval STEPS_TO_DO := $(shell MAKEFLAGS= MFLAGS= MAKELEVEL=0 $(MAKE) -n $(if $(findstring B,$(LETTERS)),-B) \
        COUNTING=1 $(MAKEOVERRIDES) $(MAKECMDGOALS) 2>/dev/null | \
        awk '/@ counted/ { n++ } END { print n + 0, length(n + 0) }'))$(STEPS_TO_DO)
ifdef COUNTING
say = echo '@ counted'
else ifneq ($(findstring s,$(LETTERS)),)
say = :
else
say = $(eval STEP += x)printf '[%$(word 2,$(STEPS_TO_DO))d/%d] %s\n' $(words $(STEP)) $(word 1,$(STEPS_TO_DO)) \
        '$(1)$(if $(CRASHPOINTS), (crash points))'
endif

# $(call rewritten,FILE,NAME): what a FILE depends on that is written anew when the variable NAME has
# another value. Its recipe compares the two. Nothing is written while steps are counted, so they are
# compared here. Only then is the variable looked up, because it may ask a compiler.
differ    = $(subst x$(1),,x$(2))$(subst x$(2),,x$(1))
rewritten = $(if $(COUNTING),$(if $(call differ,$(file <$(1)),$($(2))),FORCE),FORCE)

# --- set-up: packages ---------------------------------------------------------------------------
STAMP    := build/.packages
$(STAMP): packages.txt supervisor/install-packages
	@supervisor/install-packages $< $@
	@mkdir -p $(@D) && touch $@
TEST_STAMP := build/.packages-tests
$(TEST_STAMP): tests/packages.txt supervisor/install-packages | $(STAMP)
	@supervisor/install-packages $< $@
	@mkdir -p $(@D) && touch $@
BENCH_STAMP := build/.packages-bench
$(BENCH_STAMP): bench/packages.txt supervisor/install-packages | $(STAMP)
	@supervisor/install-packages $< $@
	@mkdir -p $(@D) && touch $@

# --- sources ------------------------------------------------------------------------------------
WORLD_SRC    := $(wildcard world/*.c)
IPC_SRC      := $(filter-out $(if $(CRASHPOINTS),,ipc/crash.c),$(wildcard ipc/*.c))
ARCHIVE_SRC  := $(wildcard archive/*.c)
SANDBOX_SRC  := $(wildcard sandbox/*.c)
CONFIG_SRC   := $(wildcard config/*.c)
WORLDCTL_SRC := $(wildcard worldctl/*.c)
KEEPER_SRC   := $(wildcard supervisor/*.c)
MOVER_SRC    := $(wildcard mover/*.c)
COLLIDER_SRC := $(wildcard collider/*.c)
REPLAY_SRC   := $(wildcard replay/*.c)
RENDERER_SRC := $(wildcard renderer/*.c renderer/*/*.c)
VIDEO_SRC    := $(wildcard video/*.c)
TOPICS_SRC   := $(wildcard topics/*.c)
CTL_SRC      := $(wildcard ctl/*.c)
DRIVE_SRC    := $(wildcard drive/*.c)
HTTP_SRC     := $(wildcard http/*.c)
CONSOLE_SRC  := $(wildcard console/*.c)
HARNESS_SRC  := $(wildcard harness/*.c)
INTAKE_SRC   := $(wildcard intake/*.c)
REPORTER_SRC := $(wildcard reporter/*.c)
MONITOR_SRC  := $(wildcard monitor/*.c)
RECORDER_SRC := $(wildcard recorder/*.c)
FIGURES_SRC  := $(wildcard figures/*.c)
KEYS_SRC     := $(wildcard docs/keys/*.c)
BENCH_SRC    := $(wildcard bench/*.c)
BENCH_CPP    := $(wildcard bench/*.cpp)
UNIT_SRC     := $(wildcard tests/unit/test_*.c)
PROPERTY_SRC := $(wildcard tests/property/test_*.c)
CRASH_SRC    := $(wildcard tests/crash/*.c)
MAP_STAGE    := tests/support/map_stage.c
SOFT_STAGE   := tests/support/soft_stage.c
CONFINED     := tests/support/confined.c
SUPPORT_SRC  := $(filter-out $(MAP_STAGE) $(SOFT_STAGE) $(CONFINED),$(wildcard tests/support/*.c))
STORM_SRC    := $(wildcard tests/storm/*.c)
LISTENER_SRC := tests/once/listener.c
PEER_SRC     := $(wildcard tests/rtps/*.c)
LAG_SRC      := tests/lag/lag.c
FLOOD_SRC    := tests/flood/flood.c
EXAMPLES_SRC := examples/escort.c
FILM_SRC     := tests/film/film.c
GOLDEN_SRC   := $(wildcard tests/golden/*.c)
FUZZ_SRC     := $(wildcard tests/fuzz/fuzz_*.c)

objects = $(patsubst %.c,$(OBJ)/%.o,$(1))
WORLD    := $(call objects,$(WORLD_SRC))
IPC      := $(call objects,$(IPC_SRC))
ARCHIVE  := $(call objects,$(ARCHIVE_SRC))
SANDBOX  := $(call objects,$(SANDBOX_SRC))
CONFIG   := $(call objects,$(CONFIG_SRC))
SUPPORT  := $(call objects,$(SUPPORT_SRC))
# The steps without their main, for tests and benchmarks.
STEPS    := $(call objects,$(filter-out %/main.c,$(MOVER_SRC) $(COLLIDER_SRC)))
# What reads and writes logs, without the recorder itself.
LOGS     := $(call objects,$(addprefix recorder/,journal.c command_log.c command_record.c event_log.c) \
        worldctl/json.c)
REPLAY   := $(call objects,$(REPLAY_SRC)) $(STEPS)
# The world that a log of commands begins with.
REPLAYED := $(call objects,$(addprefix worldctl/,remake.c load.c resume.c adopt.c arguments.c))
# The keeper without its main: whom it watches, and what it makes of a death.
KEEPER   := $(call objects,$(filter-out %/keeper.c,$(KEEPER_SRC)))
# The map without words, and what its words say and where.
MAP      := $(call objects,$(addprefix renderer/,image/image.c $(addprefix chart/,base.c gauges.c \
        layout.c map.c symbol.c)))
# Inner loops, compiled a second time where there is a wider vector to choose at run time.
KERNEL_SRC := $(wildcard renderer/*/kernel_*.c)
KERNELS  := $(if $(filter x86_64%,$(shell $(CC) -dumpmachine 2>/dev/null || uname -m)),$(KERNEL_SRC:%.c=$(OBJ)/%.avx2.o))
# The scene without the drawing: nothing here knows of graphics.
SCENE    := $(call objects,$(wildcard renderer/scene/*.c) $(addprefix renderer/,image/image.c \
        image/smooth.c image/kernel_smooth.c chart/track.c)) \
        $(filter $(OBJ)/renderer/image/%,$(KERNELS))
# The rasteriser of our own.
SOFT     := $(call objects,$(wildcard renderer/soft/*.c)) $(KERNELS)
# All that makes a picture and puts it out: the renderer without its main and its studio.
PICTURE  := $(call objects,$(wildcard renderer/*/*.c http/*.c)) $(KERNELS)
STATUS   := $(OBJ)/idl/status.o
# What servers of HTTP have in common.
HTTP     := $(call objects,$(HTTP_SRC))
# The live stream without the renderer.
STREAM   := $(call objects,$(addprefix renderer/,image/image.c image/jpeg.c \
        $(addprefix output/,picture.c query.c stream.c stream_asked.c stream_door.c stream_http.c wanted.c)))
# The page that the console serves, compiled in.
PAGE_FILES := $(sort $(wildcard $(addprefix console/page/*.,html css js svg png ico webmanifest)))
PAGE     := $(OBJ)/console/page_files.o
# A link to a world over DDS: what it says, and commands to it.
TOPICS   := $(call objects,$(filter-out %_json.c,$(TOPICS_SRC))) $(STATUS)
# What of it commands a world on this machine: without DDS.
COMMANDS := $(call objects,$(addprefix topics/,caller.c command_socket.c mission.c names.c order.c))
# What of it reads and writes JSON, for those who do.
TOPICS_JSON := $(call objects,$(filter %_json.c,$(TOPICS_SRC)))

pc = $(shell pkg-config --$(1) $(2) 2>/dev/null)
DDS_CFLAGS    = $(call pc,cflags,CycloneDDS) -I$(IDL)
# Devices' libraries are opened by drive/library.c when one is there; this is for their headers.
DEVICE_CFLAGS = $(call pc,cflags,libevdev spnav)
DDS_LIBS      = $(call pc,libs,CycloneDDS)
RENDER_CFLAGS = $(call pc,cflags,epoxy egl libdeflate libjpeg freetype2 libavformat libavcodec libavutil)
# Not egl: libepoxy opens it when there is one, and a machine without it is told so. Nor libav:
# renderer/output/libav.c opens it when there is video to be made.
RENDER_LIBS   = $(call pc,libs,epoxy libdeflate libjpeg libmicrohttpd freetype2)
# libconfig and libseccomp statically, with their allocations led through world/guarded.c.
CONFIG_LIBS   = -Wl,-Bstatic $(call pc,libs,libconfig) -Wl,-Bdynamic $(call pc,libs,assimp) -lstdc++
JSON_CFLAGS   = $(call pc,cflags,libcjson)
JSON_LIBS     = $(call pc,libs,libcjson)
CURSES_LIBS   = $(call pc,libs,ncursesw)
HASH_LIBS     = $(call pc,libs,libxxhash)
ARCHIVE_LIBS  = $(call pc,libs,libzstd)
# The engines that jolon-bench measures us beside; their headers are not held to our warnings.
PEER_CFLAGS   = $(patsubst -I%,-isystem %,$(call pc,cflags,bullet))
PEER_LIBS     = $(call pc,libs,ode) $(filter-out -lBulletSoftBody -lBulletDynamics,$(call pc,libs,bullet))
SANDBOX_LIBS  = -Wl,-Bstatic $(call pc,libs,libseccomp) -Wl,-Bdynamic
TEST_LIBS     = $(call pc,libs,cmocka)
BASE_LIBS     = $(HASH_LIBS) -lm

PROGRAMS := $(BIN)/jolon-world $(BIN)/jolon-mover $(BIN)/jolon-collider $(BIN)/jolon-renderer \
        $(BIN)/jolon-video $(BIN)/jolon-intake $(BIN)/jolon-reporter $(BIN)/jolon-recorder $(BIN)/jolon-ctl $(BIN)/jolon-drive $(BIN)/jolon-harness $(BIN)/jolon-console $(BIN)/jolon-monitor \
        $(BIN)/jolon-keeper $(BIN)/jolon
# The benchmarks have packages of their own, so only `make bench` and the tests build them.
BENCH    := $(BIN)/jolon-bench
# Of the build with crash points: what their tests run.
CRASH_PROGRAMS := $(BIN)/jolon-world $(BIN)/jolon-mover $(BIN)/jolon-collider $(BIN)/jolon-intake $(BIN)/jolon-recorder \
        $(BIN)/jolon-keeper $(BIN)/jolon $(BUILD)/tests/crash/test_crash
UNIT_TESTS     := $(patsubst tests/unit/%.c,$(BUILD)/tests/unit/%,$(UNIT_SRC))
GOLDEN_TESTS   := $(BUILD)/tests/golden/test_golden
PROPERTY_TESTS := $(patsubst tests/property/%.c,$(BUILD)/tests/property/%,$(PROPERTY_SRC))
# What system tests run beside the programs.
STORM          := $(BUILD)/tests/storm/storm
LISTENER       := $(BUILD)/tests/once/listener
PEER           := $(BUILD)/tests/rtps/peer
LAG            := $(BUILD)/tests/lag/lag
FLOOD          := $(BUILD)/tests/flood/flood
FILM           := $(BUILD)/tests/film/film

.PHONY: all run test tests check examples figures docs game rtps storm crash fuzz fuzzers model bench bench-render install uninstall format lint clean help
all: $(if $(CRASHPOINTS),$(CRASH_PROGRAMS),$(PROGRAMS))

# --- programs -----------------------------------------------------------------------------------
link = @mkdir -p $(@D); $(call say,LD $@); $(CC) $(LDFLAGS_ALL) -o $@ $(sort $(filter %.o,$^)) $(1)

$(BIN)/jolon-world: $(call objects,$(WORLDCTL_SRC)) $(REPLAY) $(LOGS) $(ARCHIVE) $(CONFIG) $(IPC) $(WORLD)
	$(call link,$(CONFIG_LIBS) $(JSON_LIBS) $(ARCHIVE_LIBS) $(BASE_LIBS))
$(BIN)/jolon-mover: $(call objects,$(MOVER_SRC)) $(SANDBOX) $(IPC) $(WORLD)
	$(call link,$(SANDBOX_LIBS) $(BASE_LIBS))
$(BIN)/jolon-collider: $(call objects,$(COLLIDER_SRC)) $(SANDBOX) $(IPC) $(WORLD)
	$(call link,$(SANDBOX_LIBS) $(BASE_LIBS))
$(BIN)/jolon-renderer: $(call objects,$(RENDERER_SRC)) $(HTTP) $(KERNELS) $(SANDBOX) $(IPC) $(WORLD)
	$(call link,$(RENDER_LIBS) $(SANDBOX_LIBS) $(BASE_LIBS))
$(BIN)/jolon-video: $(call objects,$(VIDEO_SRC) $(filter-out %/main.c,$(RENDERER_SRC))) $(HTTP) $(KERNELS) $(REPLAYED) $(REPLAY) $(LOGS) $(ARCHIVE) $(CONFIG) $(IPC) $(WORLD)
	$(call link,$(RENDER_LIBS) $(CONFIG_LIBS) $(JSON_LIBS) $(ARCHIVE_LIBS) $(BASE_LIBS))
$(BIN)/jolon-intake: $(call objects,$(INTAKE_SRC)) $(SANDBOX) $(IPC) $(WORLD)
	$(call link,$(SANDBOX_LIBS) $(BASE_LIBS))
$(BIN)/jolon-reporter: $(call objects,$(REPORTER_SRC)) $(TOPICS) $(SANDBOX) $(IPC) $(WORLD)
	$(call link,$(DDS_LIBS) $(SANDBOX_LIBS) $(BASE_LIBS))
$(BIN)/jolon-recorder: $(call objects,$(RECORDER_SRC) worldctl/json.c) $(ARCHIVE) $(SANDBOX) $(IPC) $(WORLD)
	$(call link,$(ARCHIVE_LIBS) $(JSON_LIBS) $(SANDBOX_LIBS) $(BASE_LIBS))
$(BIN)/jolon-ctl: $(call objects,$(CTL_SRC)) $(TOPICS) $(IPC) $(WORLD)
	$(call link,$(DDS_LIBS) $(JSON_LIBS) $(BASE_LIBS))
$(BIN)/jolon-drive: $(call objects,$(DRIVE_SRC)) $(TOPICS) $(IPC) $(WORLD)
	$(call link,$(DDS_LIBS) $(CURSES_LIBS) $(BASE_LIBS))
$(BIN)/jolon-console: $(call objects,$(CONSOLE_SRC)) $(PAGE) $(HTTP) $(COMMANDS) $(OBJ)/topics/order_json.o $(SANDBOX) $(IPC) $(WORLD)
	$(call link,$(call pc,libs,libmicrohttpd) $(JSON_LIBS) $(SANDBOX_LIBS) $(BASE_LIBS))
$(BIN)/jolon-harness: $(call objects,$(HARNESS_SRC)) $(TOPICS) $(TOPICS_JSON) $(IPC) $(WORLD)
	$(call link,$(DDS_LIBS) $(JSON_LIBS) $(BASE_LIBS))
$(BIN)/jolon-monitor: $(call objects,$(MONITOR_SRC)) $(TOPICS) $(TOPICS_JSON) $(IPC) $(WORLD)
	$(call link,$(DDS_LIBS) $(CURSES_LIBS) $(JSON_LIBS) $(BASE_LIBS))
$(BENCH): $(call objects,$(BENCH_SRC)) $(patsubst %.cpp,$(OBJ)/%.o,$(BENCH_CPP)) $(PICTURE) $(REPLAY) $(LOGS) $(CONFIG) $(IPC) $(WORLD)
	$(call link,$(RENDER_LIBS) $(CONFIG_LIBS) $(JSON_LIBS) $(PEER_LIBS) $(BASE_LIBS) -lstdc++)
$(patsubst %,$(OBJ)/%.o,$(basename $(wildcard bench/peer_*))): | $(BENCH_STAMP)
$(BIN)/jolon-keeper: $(call objects,$(KEEPER_SRC)) $(SANDBOX) $(IPC) $(WORLD)
	$(call link,$(SANDBOX_LIBS) $(BASE_LIBS))
$(BIN)/jolon: supervisor/jolon
	@mkdir -p $(@D); install -m 755 $< $@

# --- objects ------------------------------------------------------------------------------------
# Flags reach an object through its folder: only these folders see these libraries.
$(OBJ)/topics/%.o $(OBJ)/ctl/%.o $(OBJ)/harness/%.o $(OBJ)/console/%.o $(OBJ)/intake/%.o $(OBJ)/reporter/%.o $(OBJ)/monitor/%.o $(OBJ)/tests/storm/%.o \
$(OBJ)/tests/once/%.o $(OBJ)/tests/flood/%.o $(OBJ)/tests/rtps/%.o: CFLAGS_EXTRA = $(DDS_CFLAGS) $(JSON_CFLAGS)
$(OBJ)/drive/%.o: CFLAGS_EXTRA = $(DDS_CFLAGS) $(DEVICE_CFLAGS)
$(OBJ)/renderer/%.o: CFLAGS_EXTRA = $(RENDER_CFLAGS)
$(OBJ)/http/%.o: CFLAGS_EXTRA = $(call pc,cflags,libmicrohttpd)
# Painting is loops over rows, which the compiler makes vectors of. None of this changes a result.
$(call objects,$(addprefix renderer/scene/,paint.c country.c grain_rows.c)): CFLAGS_EXTRA = \
        $(RENDER_CFLAGS) -O3 -fno-math-errno -fno-trapping-math
$(OBJ)/video/%.o: CFLAGS_EXTRA = $(RENDER_CFLAGS) $(JSON_CFLAGS)
# Their vectors are passed within one file only.
$(call objects,$(KERNEL_SRC)) $(KERNELS): CFLAGS_EXTRA = $(RENDER_CFLAGS) -Wno-psabi
$(OBJ)/worldctl/%.o $(OBJ)/recorder/%.o $(OBJ)/replay/%.o $(OBJ)/tests/%.o \
$(OBJ)/bench/%.o: CFLAGS_EXTRA = $(JSON_CFLAGS)
$(call objects,$(TOPICS_SRC) $(CTL_SRC) $(DRIVE_SRC) $(HARNESS_SRC) $(CONSOLE_SRC) $(INTAKE_SRC) $(REPORTER_SRC) $(MONITOR_SRC) $(STORM_SRC) $(LISTENER_SRC) $(FLOOD_SRC) $(PEER_SRC)): $(IDL)/status.h

$(OBJ)/%.o: %.c $(BUILD)/flags | $(STAMP)
	@mkdir -p $(@D); $(call say,CC $<)
	@$(CC) $(CFLAGS_ALL) $(CFLAGS_EXTRA) -MMD -MP -c -o $@ $<

$(OBJ)/%.avx2.o: %.c $(BUILD)/flags | $(STAMP)
	@mkdir -p $(@D); $(call say,CC $< (AVX2))
	@$(CC) $(CFLAGS_ALL) -mavx2 $(CFLAGS_EXTRA) -MMD -MP -c -o $@ $<

$(OBJ)/%.o: %.cpp $(BUILD)/flags | $(STAMP)
	@mkdir -p $(@D); $(call say,CXX $<)
	@$(CXX) -std=c++17 $(CXXFLAGS_ALL) $(PEER_CFLAGS) -MMD -MP -c -o $@ $<

TEST_SRC := $(UNIT_SRC) $(PROPERTY_SRC) $(SUPPORT_SRC) $(MAP_STAGE) $(SOFT_STAGE) $(CONFINED) $(CRASH_SRC) $(STORM_SRC) $(LISTENER_SRC) $(PEER_SRC) $(LAG_SRC) $(FLOOD_SRC) $(FILM_SRC) $(GOLDEN_SRC) $(FUZZ_SRC)
$(call objects,$(TEST_SRC)): | $(TEST_STAMP)

# Again when a file comes or goes, too.
$(OBJ)/console/page.list: $(call rewritten,$(OBJ)/console/page.list,PAGE_FILES)
	@mkdir -p $(@D); echo '$(PAGE_FILES)' | cmp -s - $@ || echo '$(PAGE_FILES)' > $@
$(PAGE): $(PAGE_FILES) $(OBJ)/console/page.list console/embed | $(STAMP)
	@mkdir -p $(@D); $(call say,AS $@)
	@console/embed $(PAGE_FILES) > $(@:.o=.s) && $(CC) -c -o $@ $(@:.o=.s)

# Generated from the IDL; generated code is not held to our warnings.
$(IDL)/status.c $(IDL)/status.h &: ipc/status.idl | $(STAMP)
	@mkdir -p $(IDL); $(call say,IDL $<); idlc -l c -o $(IDL) $<
$(STATUS): $(IDL)/status.c $(IDL)/status.h $(BUILD)/flags
	@mkdir -p $(@D); $(call say,CC $<); $(CC) $(filter-out $(WARN),$(CFLAGS_ALL)) $(DDS_CFLAGS) -c -o $@ $<

# Everything is built again when the compiler or its flags change.
FLAGS = $(CC) $(CFLAGS_ALL) $(LDFLAGS_ALL)
$(BUILD)/flags: $(call rewritten,$(BUILD)/flags,FLAGS) | $(STAMP)
	@mkdir -p $(@D); echo '$(FLAGS)' | cmp -s - $@ || echo '$(FLAGS)' > $@
.PHONY: FORCE
FORCE:

# --- tests --------------------------------------------------------------------------------------
$(BUILD)/tests/%: $(OBJ)/tests/%.o $(SUPPORT) $(REPLAY) $(LOGS) $(ARCHIVE) $(CONFIG) $(IPC) $(WORLD)
	$(call link,$(TEST_LIBS) $(CONFIG_LIBS) $(JSON_LIBS) $(ARCHIVE_LIBS) $(BASE_LIBS))

# What the topics say.
$(call objects,$(addprefix tests/unit/test_,admission.c desk.c)): CFLAGS_EXTRA = $(DDS_CFLAGS)
$(call objects,$(addprefix tests/unit/test_,admission.c desk.c)): $(IDL)/status.h
$(BUILD)/tests/unit/test_judge $(BUILD)/tests/unit/test_watch: $(KEEPER) $(SANDBOX)
$(BUILD)/tests/unit/test_judge $(BUILD)/tests/unit/test_watch: TEST_LIBS += $(SANDBOX_LIBS)
$(BUILD)/tests/crash/test_crash: $(call objects,$(CRASH_SRC))
$(BUILD)/tests/property/test_workload: $(call objects,bench/engine_jolon.c bench/workload.c)
$(GOLDEN_TESTS): $(call objects,bench/scene.c bench/world.c) $(PICTURE)
$(GOLDEN_TESTS): TEST_LIBS += $(RENDER_LIBS) $(call pc,libs,libpng)
$(BUILD)/tests/unit/test_output: $(call objects,$(addprefix renderer/,image/image.c output/output.c image/png.c))
$(BUILD)/tests/unit/test_output: TEST_LIBS += $(call pc,libs,libdeflate)
$(BUILD)/tests/unit/test_png: $(call objects,$(addprefix renderer/image/,image.c png.c))
$(BUILD)/tests/unit/test_png: TEST_LIBS += $(call pc,libs,libdeflate libpng)
$(BUILD)/tests/unit/test_outlet: $(call objects,$(addprefix renderer/,image/image.c output/outlet.c output/picture.c))
$(BUILD)/tests/unit/test_stream: $(STREAM) $(HTTP)
$(BUILD)/tests/unit/test_stream: TEST_LIBS += $(call pc,libs,libjpeg libmicrohttpd)
$(BUILD)/tests/unit/test_query: $(OBJ)/renderer/output/query.o
$(BUILD)/tests/unit/test_wanted: $(OBJ)/renderer/output/wanted.o
$(BUILD)/tests/unit/test_video: $(call objects,$(addprefix renderer/,image/image.c image/yuv.c output/video.c output/libav.c))
$(BUILD)/tests/unit/test_yuv: $(call objects,$(addprefix renderer/image/,image.c yuv.c))
$(BUILD)/tests/unit/test_jpeg: $(call objects,$(addprefix renderer/image/,image.c jpeg.c))
$(BUILD)/tests/unit/test_jpeg: TEST_LIBS += $(call pc,libs,libjpeg)
$(BUILD)/tests/unit/test_console_body: $(call objects,$(addprefix console/,body.c answer.c text.c players.c secret.c)) $(COMMANDS) $(OBJ)/topics/order_json.o
$(BUILD)/tests/unit/test_console_parts: $(call objects,$(addprefix console/,answer.c fetch.c \
        pictures.c players.c secret.c text.c)) $(HTTP)
$(BUILD)/tests/unit/test_console_parts: TEST_LIBS += $(call pc,libs,libmicrohttpd)
$(BUILD)/tests/unit/test_connection_limit: $(OBJ)/http/connection_limit.o
SANDBOX_TESTS := $(addprefix $(BUILD)/tests/unit/test_,sandbox sandbox_files sandbox_keeper)
$(SANDBOX_TESTS): $(call objects,$(CONFINED)) $(SANDBOX)
$(SANDBOX_TESTS): TEST_LIBS += $(SANDBOX_LIBS)
$(BUILD)/tests/unit/test_sandbox: TEST_LIBS += $(DDS_LIBS)
$(OBJ)/tests/unit/test_sandbox.o: CFLAGS_EXTRA = $(DDS_CFLAGS)
# Preloaded by system tests; it stands in the way of functions that the headers say much about.
FAILING := $(BUILD)/tests/faults/failing.so
$(FAILING): tests/faults/failing.c $(BUILD)/flags | $(TEST_STAMP)
	@mkdir -p $(@D); $(call say,LD $@)
	@$(CC) -std=c17 $(OPT) -g -D_GNU_SOURCE $(filter-out -Wpedantic,$(WARN)) -fPIC -shared -o $@ $< -ldl

$(addprefix $(BUILD)/tests/unit/test_soft_,bodies plants puffs): $(SOFT) $(SCENE) $(call objects,$(SOFT_STAGE))
# What needs the scene alone.
$(addprefix $(BUILD)/tests/unit/test_,aim blend dents effects gear ground mesh paint scene tiles): $(SCENE)
$(BUILD)/tests/unit/test_map $(BUILD)/tests/unit/test_layout $(BUILD)/tests/unit/test_gauges: $(SCENE) $(MAP) \
        $(call objects,$(MAP_STAGE))
$(BUILD)/tests/unit/test_chart: $(SCENE) $(MAP) $(call objects,$(MAP_STAGE) $(addprefix renderer/,image/text.c \
        $(addprefix chart/,chart.c instruments.c legend.c)))
$(BUILD)/tests/unit/test_palette: $(call objects,figures/palette.c renderer/image/image.c)
$(BUILD)/tests/unit/test_chart: TEST_LIBS += $(call pc,libs,freetype2)
$(BUILD)/tests/unit/test_effects $(BUILD)/tests/unit/test_plants: $(SCENE)
$(BUILD)/tests/unit/test_views: $(OBJ)/renderer/views.o
$(BUILD)/tests/unit/test_governor: $(OBJ)/renderer/governor.o
$(BUILD)/tests/unit/test_stretch: $(call objects,$(addprefix renderer/image/,image.c stretch.c))
$(BUILD)/tests/unit/test_soft: $(SOFT) $(SCENE)
$(call objects,$(addprefix tests/unit/test_,gamepad.c spacemouse.c)): CFLAGS_EXTRA = $(DEVICE_CFLAGS)
$(BUILD)/tests/unit/test_choose: $(TOPICS)
$(BUILD)/tests/unit/test_choose: TEST_LIBS += $(DDS_LIBS)
$(OBJ)/tests/unit/test_choose.o: CFLAGS_EXTRA = $(DDS_CFLAGS)
$(OBJ)/tests/unit/test_choose.o: $(IDL)/status.h
# It walks spans itself.
$(OBJ)/tests/unit/test_soft.o: CFLAGS_EXTRA = -Wno-psabi
$(BUILD)/tests/unit/test_checkpoint: $(OBJ)/recorder/checkpoint.o
$(BUILD)/tests/unit/test_recorder: $(call objects,recorder/brake.c)
$(BUILD)/tests/unit/test_order: $(TOPICS) $(TOPICS_JSON)
$(BUILD)/tests/unit/test_order: TEST_LIBS += $(DDS_LIBS)
$(OBJ)/tests/unit/test_order.o: CFLAGS_EXTRA = $(DDS_CFLAGS) $(JSON_CFLAGS)
$(OBJ)/tests/unit/test_order.o: $(IDL)/status.h
$(BUILD)/tests/unit/test_samples: $(TOPICS)
$(BUILD)/tests/unit/test_samples: TEST_LIBS += $(DDS_LIBS)
$(OBJ)/tests/unit/test_samples.o: CFLAGS_EXTRA = $(DDS_CFLAGS)
$(OBJ)/tests/unit/test_samples.o: $(IDL)/status.h
$(BUILD)/tests/unit/test_rtps_filter: $(OBJ)/topics/rtps_filter.o
$(BUILD)/tests/unit/test_dds_datagrams: $(call objects,topics/dds_datagrams.c topics/rtps_filter.c)
$(BUILD)/tests/unit/test_compare: $(call objects,worldctl/compare.c)
$(BUILD)/tests/unit/test_schema: $(call objects,docs/keys/key_tables.c)

$(STORM): $(call objects,$(STORM_SRC) worldctl/json.c) $(COMMANDS) $(IPC) $(WORLD)
	$(call link,$(JSON_LIBS) $(BASE_LIBS))
$(LISTENER): $(call objects,$(LISTENER_SRC)) $(TOPICS) $(IPC) $(WORLD)
	$(call link,$(DDS_LIBS) $(BASE_LIBS))
# It has no filter of its own.
$(PEER): $(call objects,$(PEER_SRC)) $(filter-out %/dds_datagrams.o %/rtps_filter.o,$(TOPICS)) $(IPC) $(WORLD)
	$(call link,$(DDS_LIBS) $(BASE_LIBS))

$(FLOOD): $(call objects,$(FLOOD_SRC)) $(COMMANDS) $(IPC) $(WORLD)
	$(call link,$(BASE_LIBS))
$(LAG): $(call objects,$(LAG_SRC)) $(IPC) $(WORLD)
	$(call link,$(BASE_LIBS))
# They are built as their readers build them: the types, DDS and nothing of ours.
EXAMPLES := $(BUILD)/examples/escort
examples: $(EXAMPLES)
$(BUILD)/examples/%: $(OBJ)/examples/%.o $(STATUS)
	$(call link,$(DDS_LIBS) -lm)
$(OBJ)/examples/%.o: CFLAGS_EXTRA = $(DDS_CFLAGS)
$(call objects,$(EXAMPLES_SRC)): $(IDL)/status.h

$(FILM): $(call objects,$(FILM_SRC))
	$(call link,$(call pc,libs,libavformat libavcodec libavutil))

check: $(UNIT_TESTS) $(PROPERTY_TESTS)
	@tests/run --build $(BUILD) $(if $(SAN),--sanitizer $(SAN)) unit property

# Crash points are tried unsanitized: a sanitizer has its own handler for faults.
# All that is tried, built: `make test` builds it too, and then runs it.
tests: all $(BENCH) $(UNIT_TESTS) $(PROPERTY_TESTS) $(GOLDEN_TESTS) $(FAILING) $(STORM) $(LISTENER) $(PEER) $(LAG) $(FLOOD) $(FILM) $(EXAMPLES) $(if $(SAN),,crash)
test: tests
	@tests/run --build $(BUILD) $(if $(SAN),--sanitizer $(SAN)) unit property golden system $(if $(SAN),,crash)

crash: | $(STAMP) $(TEST_STAMP)
	@$(if $(COUNTING),:,$(MAKE)) --no-print-directory CRASHPOINTS=1 BUILD=$(BUILD)/crash all

# --- fuzzing ------------------------------------------------------------------------------------
# Harnesses are clang's: tests/fuzz/run calls make again, with a compiler, sanitizers and a build
# tree for them.
FUZZERS := $(patsubst tests/fuzz/%.c,$(BIN)/%,$(FUZZ_SRC))
fuzzers: $(FUZZERS)
$(BIN)/fuzz_%: $(OBJ)/tests/fuzz/fuzz_%.o $(OBJ)/tests/fuzz/support.o $(CONFIG) $(IPC) $(WORLD)
	$(call link,-fsanitize=fuzzer $(FUZZ_LINK) $(CONFIG_LIBS) $(BASE_LIBS))
FUZZ_WRAP = -Wl,$(subst $(space),$(comma),$(patsubst %,--wrap=%,$(1)))
$(BIN)/fuzz_scenario $(BIN)/fuzz_kind: $(OBJ)/tests/fuzz/one_model.o
$(BIN)/fuzz_scenario $(BIN)/fuzz_kind: FUZZ_LINK = $(call FUZZ_WRAP,aiImportFileEx aiReleaseImport)
$(BIN)/fuzz_command: $(call objects,intake/command_check.c $(filter-out %/main.c,$(MOVER_SRC)))
$(BIN)/fuzz_collider: $(STEPS)
$(BIN)/fuzz_ctl $(BIN)/fuzz_log: $(OBJ)/tests/fuzz/ending.o
$(BIN)/fuzz_ctl: $(call objects,ctl/parse.c) $(TOPICS)
$(BIN)/fuzz_ctl: FUZZ_LINK = $(call FUZZ_WRAP,exit) $(DDS_LIBS)
$(BIN)/fuzz_order: $(TOPICS) $(TOPICS_JSON)
$(BIN)/fuzz_order: FUZZ_LINK = $(DDS_LIBS) $(JSON_LIBS)
$(BIN)/fuzz_console $(BIN)/fuzz_stream: $(OBJ)/tests/fuzz/http_client.o $(HTTP)
$(BIN)/fuzz_console: $(call objects,$(filter-out %/main.c %/options.c,$(CONSOLE_SRC))) $(PAGE) $(TOPICS) $(TOPICS_JSON)
$(BIN)/fuzz_console: FUZZ_LINK = $(call pc,libs,libmicrohttpd) $(DDS_LIBS) $(JSON_LIBS)
$(BIN)/fuzz_stream: $(STREAM)
$(BIN)/fuzz_stream: FUZZ_LINK = $(call pc,libs,libmicrohttpd libjpeg)
$(BIN)/fuzz_rtps: $(OBJ)/topics/rtps_filter.o
$(BIN)/fuzz_samples: $(call objects,$(addprefix monitor/,json.c lines.c map.c spark.c table.c)) $(TOPICS) $(TOPICS_JSON)
$(BIN)/fuzz_samples: FUZZ_LINK = $(DDS_LIBS) $(JSON_LIBS)
$(BIN)/fuzz_filter: $(call objects,monitor/table.c) $(TOPICS)
$(BIN)/fuzz_filter: FUZZ_LINK = $(DDS_LIBS)
$(BIN)/fuzz_image: $(ARCHIVE)
$(BIN)/fuzz_image: FUZZ_LINK = $(ARCHIVE_LIBS)
$(BIN)/fuzz_log: $(LOGS) $(REPLAY)
$(BIN)/fuzz_log: FUZZ_LINK = $(call FUZZ_WRAP,exit) $(JSON_LIBS)
$(OBJ)/tests/fuzz/%.o $(OBJ)/tests/unit/test_console_%.o: CFLAGS_EXTRA = $(DDS_CFLAGS) $(JSON_CFLAGS)
$(call objects,$(FUZZ_SRC) $(wildcard tests/unit/test_console_*.c)): $(IDL)/status.h

# SECONDS: of each harness.
fuzz: | $(TEST_STAMP)
	@tests/fuzz/run --seconds $(if $(filter file,$(origin SECONDS)),30,$(SECONDS))
	@$(MAKE) --no-print-directory rtps PACKETS=$$((8000 * $(if $(filter file,$(origin SECONDS)),30,$(SECONDS))))

# --- running ------------------------------------------------------------------------------------
# `make SECONDS=n`: bash has a variable of that name, but a make variable is only ours.
SECONDS  ?= 60
SCENARIO ?=
OUT      ?= out
run: all
	@$(BIN)/jolon run --seconds $(SECONDS) --out $(OUT) $(SCENARIO)

# Kills and stops at random, and an account: tests/storm/README.md. With more of everything:
# make storm KILLS=10000 SCENARIO=hunter-liggett STORMY='--renderer --commands 10000'
KILLS    ?= 1000
SEED     ?=
STORMY   ?=
# make game [SECONDS=300] [SEED=n] [SCENARIO=file]: tests/game/README.md
# With pages in a browser where tests/system/test_console_page.sh has found and made what they need.
PAGE_MODULES := $(wildcard build/tests/browser/node_modules)
GAME_PAGES = $(if $(PAGE_MODULES),--browser $(shell command -v chromium) --modules $(abspath build/tests/browser))
game: all
	@tests/game/game --bin $(BIN) --seconds $(if $(filter file,$(origin SECONDS)),300,$(SECONDS)) \
		$(if $(SEED),--seed $(SEED)) $(GAME_PAGES) $(SCENARIO)

# make rtps [PACKETS=1000000] [SEED=n] [RATE=n]: mutated datagrams against a reporter
rtps: all $(PEER)
	@JOLON_BIN=$(abspath $(BIN)) PACKETS=$(or $(PACKETS),1000000) RATE=$(or $(RATE),8000) \
		$(if $(SEED),SEED=$(SEED)) tests/system/test_rtps.sh

storm: all $(STORM)
	@$(STORM) --kills $(KILLS) $(if $(SEED),--seed $(SEED)) $(if $(SCENARIO),--scenario $(SCENARIO)) $(STORMY)

# One after the other: each has the machine to itself.
bench: bench-render
	@bench/run $(BENCH)
bench-render: all $(BENCH)
	@bench/run-render $(BENCH)

# The frame protocol's model: MODEL=short, usual or full.
MODEL    ?= usual
model: | $(TEST_STAMP)
	@tests/model/run $(MODEL)

# --- installing ---------------------------------------------------------------------------------
SHARE = $(DESTDIR)$(PREFIX)/share/jolon
DOC   = $(DESTDIR)$(PREFIX)/share/doc/jolon
MAN1  = $(DESTDIR)$(PREFIX)/share/man/man1
COMPLETIONS = $(DESTDIR)$(PREFIX)/share/bash-completion/completions
UNITS = $(DESTDIR)$(PREFIX)/lib/systemd/system
# jolon-bench is installed when it has been built.
INSTALLED = $(PROGRAMS) $(wildcard $(BENCH))
PAGES = $(filter-out $(if $(wildcard $(BENCH)),,%/jolon-bench.1),$(wildcard man/*.1))
# In the folders in which they lie here, so that their links hold.
DOCUMENTS = LICENSE $(sort $(wildcard *.md */README.md) $(shell find docs examples -type f \
        '(' -name '*.md' -o -name '*.png' -o -name '*.svg' -o -path '*examples/*' ')'))
install: all
	install -d $(DESTDIR)$(PREFIX)/bin $(MAN1) $(COMPLETIONS) $(UNITS)
	install -m 755 -s $(filter-out %/jolon,$(INSTALLED)) $(DESTDIR)$(PREFIX)/bin
	install -m 755 $(BIN)/jolon $(DESTDIR)$(PREFIX)/bin
	install -m 644 $(PAGES) $(MAN1)
	ln -sf jolon-run.1 $(MAN1)/jolon-start.1
	install -m 644 supervisor/jolon.completion $(COMPLETIONS)/jolon
	sed 's|@BIN@|$(PREFIX)/bin|' supervisor/jolon@.service > $(UNITS)/jolon@.service
	rm -rf $(SHARE) $(DOC)
	install -d $(SHARE) $(DOC)
	cp -R config/kinds config/models config/scenarios config/cyclonedds.xml config/dds-security ipc/status.idl $(SHARE)
	@cp --parents $(DOCUMENTS) $(DOC)
	chmod -R u=rwX,go=rX $(SHARE) $(DOC) $(UNITS)/jolon@.service
uninstall:
	rm -f $(addprefix $(DESTDIR)$(PREFIX)/bin/,$(notdir $(PROGRAMS) $(BENCH)))
	rm -f $(addprefix $(MAN1)/,$(notdir $(wildcard man/*.1)) jolon-start.1) $(COMPLETIONS)/jolon $(UNITS)/jolon@.service
	rm -rf $(SHARE) $(DOC)

# --- pictures of the documents ------------------------------------------------------------------
SHEET := $(BUILD)/figures/sheet
$(OBJ)/figures/%.o: CFLAGS_EXTRA = $(call pc,cflags,libpng)
$(call objects,$(FIGURES_SRC)): | $(TEST_STAMP)
$(SHEET): $(call objects,$(FIGURES_SRC) $(addprefix renderer/image/,image.c text.c)) $(IPC) $(WORLD)
	$(call link,$(call pc,libs,libpng freetype2) $(BASE_LIBS))
figures: all $(SHEET)
	@figures/make $(BUILD)

# --- tables of the documents --------------------------------------------------------------------
KEYS := $(BUILD)/docs/keys
$(KEYS): $(call objects,$(KEYS_SRC)) $(CONFIG) $(IPC) $(WORLD)
	$(call link,$(CONFIG_LIBS) $(BASE_LIBS))
docs: $(KEYS)
	@$(KEYS) docs/scenario.md

# --- keeping it tidy ----------------------------------------------------------------------------
C_FILES = $(shell git ls-files '*.c' '*.h')
format:
	@clang-format -i $(C_FILES)
lint:
	@tests/lint
clean:
	rm -rf build
help:
	@echo 'make run [SECONDS=60] [SCENARIO=file]   run the Hunter-Liggett world and look at it'
	@echo 'make test                               every test; SAN=address,undefined sanitized'
	@echo 'make check                              unit and property tests only'
	@echo 'make examples                           programs that drive vehicles, see examples/README.md'
	@echo 'make fuzz [SECONDS=30]                  hostile input, as long for each harness'
	@echo 'make CRASHPOINTS=1                      programs that die at a given store, into build/crash'
	@echo 'make rtps [PACKETS=1000000] [SEED=n]       mutated datagrams against a reporter'
	@echo 'make game [SECONDS=300] [SEED=n]          two players and a program at once, while everything is killed'
	@echo 'make storm [KILLS=1000] [SEED=n]           kill everything at random, count what came of it'
	@echo 'make model [MODEL=short|usual|full]      check the frame protocol with spin'
	@echo 'make bench                              build jolon-bench, measure; results in bench/results/'
	@echo 'make bench-render                       what pictures cost, alone'
	@echo 'make install PREFIX=/usr/local DESTDIR= make uninstall'
	@echo 'make figures                            the pictures of docs/ again (A.1 to A.9 of the thesis)'
	@echo 'make docs                               the tables of keys in docs/scenario.md again'
	@echo 'make format | lint | clean'

-include $(shell find $(OBJ) -name '*.d' 2>/dev/null)
