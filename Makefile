# Jolon: one Makefile for everything. `make help` lists what it can do.
MAKEFLAGS += --no-builtin-rules
.SUFFIXES:
.SECONDARY:
.DEFAULT_GOAL := all

# All processors build, unless -j says how many. Goals that do more than build run one after another
# when several are named (`make clean all`), and tests/lint calls make for itself.
BUILDING := all ground tests examples fuzzers crash build/%
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
# $(call say,WORDS) prints one line a step: "[ 37/412] CC world/entity/hull.c"; `make -s` prints none.
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
# compared here. Only then is the variable looked up, because it may ask a compiler. make 4.3 may read
# the newline at the end of the file as a part of the text, so blanks are not compared.
differ    = $(subst x$(1),,x$(2))$(subst x$(2),,x$(1))
rewritten = $(if $(COUNTING),$(if $(call differ,$(strip $(file <$(1))),$(strip $($(2)))),FORCE),FORCE)

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
$(BENCH_STAMP): tests/bench/packages.txt supervisor/install-packages | $(STAMP)
	@supervisor/install-packages $< $@
	@mkdir -p $(@D) && touch $@

GROUND_STAMP := build/.packages-ground
$(GROUND_STAMP): supervisor/ground/packages.txt supervisor/install-packages | $(STAMP)
	@supervisor/install-packages $< $@
	@mkdir -p $(@D) && touch $@

# --- sources ------------------------------------------------------------------------------------
# Each folder's objects without its main go into a library below $(BUILD)/lib, of which the linker
# takes what a program or a test uses.
objects   = $(patsubst %.c,$(OBJ)/%.o,$(1))
sources   = $(wildcard $(addsuffix /*.c,$(1)))
libraries = $(patsubst %,$(BUILD)/lib/%.a,$(1))

WORLD_SRC    := $(call sources,world world/*)
CONFIG_SRC   := $(call sources,config config/*)
IPC_SRC      := $(filter-out $(if $(CRASHPOINTS),,%/crash_point.c),$(call sources,$(addprefix ipc/,process segment frame json)))
SANDBOX_SRC  := $(call sources,ipc/sandbox ipc/stage)
HTTP_SRC     := $(call sources,ipc/http)
TOPICS_SRC   := $(call sources,ipc/topics)
# It stands in for functions of the C library, and so does the sandbox: only in who wants it.
DATAGRAM_SRC := ipc/topics/dds_datagrams.c
MOVER_SRC    := $(call sources,mover mover/* mover/motion/* mover/agent/*)
COLLIDER_SRC := $(call sources,collider collider/*)
RUNS_SRC     := $(call sources,recorder/log recorder/archive recorder/replay)
RENDERER_SRC := $(filter-out renderer/video/%,$(call sources,renderer renderer/* renderer/scene/*))
KEEPER_SRC   := $(call sources,supervisor)
GATEWAY_SRC  := $(call sources,gateway gateway/pdu gateway/earth gateway/udp)
# Programs of their own that stand in a folder of another: what is linked into that one alone.
SUPPORT_SRC  := $(call sources,tests/support)
BENCH_SRC    := $(filter-out tests/bench/peer_%,$(call sources,tests/bench tests/bench/*))
# Only jolon-bench needs the engines that it measures: tests of its parts do not.
ENGINES      := $(patsubst %,$(OBJ)/%.o,$(basename $(wildcard tests/bench/peer_*)))
FUZZ_SRC     := $(call sources,tests/fuzz tests/fuzz/shared)
PLACES       := unit/* unit/*/* unit/*/*/* property/*
UNIT_SRC     := $(filter tests/unit/%,$(wildcard $(addprefix tests/,$(addsuffix /test_*.c,$(PLACES)))))
PROPERTY_SRC := $(wildcard tests/property/*/test_*.c tests/property/*/*/test_*.c)
# Inner loops, compiled a second time where there is a wider vector to choose at run time.
KERNEL_SRC   := $(wildcard renderer/*/kernel_*.c)
KERNELS      := $(if $(filter x86_64%,$(shell $(CC) -dumpmachine 2>/dev/null || uname -m)),$(KERNEL_SRC:%.c=$(OBJ)/%.avx2.o))
STATUS       := $(OBJ)/idl/status.o
# The page that the console serves, compiled in.
PAGE_FILES   := $(sort $(wildcard $(addprefix clients/console/page/*.,html css js svg png ico webmanifest)))
PAGE         := $(OBJ)/clients/console/page_table.o

# library NAME SOURCES MORE-OBJECTS: made again when a file comes or goes, too.
define library
$(BUILD)/lib/$(1).list: OBJECTS := $(call objects,$(filter-out %/main.c,$(2))) $(3)
$(call libraries,$(1)): $(call objects,$(filter-out %/main.c,$(2))) $(3) $(BUILD)/lib/$(1).list
endef
$(BUILD)/lib/%.list: $(if $(COUNTING),,FORCE)
	@mkdir -p $(@D); echo '$(OBJECTS)' | cmp -s - $@ || echo '$(OBJECTS)' > $@
CLIENTS := ctl drive harness console monitor
$(eval $(call library,world,$(WORLD_SRC)))
$(eval $(call library,config,$(CONFIG_SRC)))
$(eval $(call library,ipc,$(IPC_SRC)))
$(eval $(call library,http,$(HTTP_SRC)))
$(eval $(call library,sandbox,$(SANDBOX_SRC)))
$(eval $(call library,topics,$(filter-out $(DATAGRAM_SRC),$(TOPICS_SRC)),$(STATUS)))
$(eval $(call library,datagrams,$(DATAGRAM_SRC)))
$(eval $(call library,mover,$(MOVER_SRC)))
$(eval $(call library,collider,$(COLLIDER_SRC)))
$(eval $(call library,runs,$(RUNS_SRC)))
$(eval $(call library,recorder,$(call sources,recorder)))
$(eval $(call library,renderer,$(RENDERER_SRC),$(KERNELS)))
$(eval $(call library,video,$(call sources,renderer/video)))
$(eval $(call library,gateway,$(GATEWAY_SRC)))
$(eval $(call library,tool,$(call sources,gateway/tool)))
$(eval $(call library,intake,$(call sources,reporter/intake)))
$(eval $(call library,reporter,$(call sources,reporter)))
$(eval $(call library,supervisor,$(KEEPER_SRC)))
$(eval $(call library,physics,$(call sources,supervisor/physics)))
$(eval $(call library,ground,$(call sources,supervisor/ground)))
$(eval $(call library,worldctl,$(call sources,supervisor/worldctl)))
$(foreach client,$(CLIENTS),$(eval $(call library,$(client),$(call sources,clients/$(client)),$(if $(filter console,$(client)),$(PAGE)))))
$(eval $(call library,screens,$(call sources,clients)))
$(eval $(call library,support,$(SUPPORT_SRC)))
$(eval $(call library,fuzz,$(filter-out tests/fuzz/fuzz_%,$(FUZZ_SRC))))
$(eval $(call library,bench,$(BENCH_SRC)))
$(call libraries,%):
	@mkdir -p $(@D); $(call say,AR $@); rm -f $@; $(AR) rcs $@ $(filter %.o,$^)

# What is known of libraries that others have made. Each is asked for once, when it is needed: the
# packages have been installed by then.
pc = $(shell pkg-config --$(1) $(2) 2>/dev/null)
LIBRARY_CFLAGS = $(eval LIBRARY_CFLAGS := $$(call pc,cflags,CycloneDDS libcjson libevdev spnav epoxy egl \
        libdeflate libjpeg freetype2 libavformat libavcodec libavutil libmicrohttpd libpng) -I$$(IDL))$(LIBRARY_CFLAGS)
DDS_LIBS      = $(call pc,libs,CycloneDDS)
# Not egl: libepoxy opens it when there is one, and a machine without it is told so. Nor libav:
# renderer/output/libav.c opens it when there is video to be made. Nor libevdev and libspnav:
# clients/drive/device_library.c opens them when there is a device.
RENDER_LIBS   = $(call pc,libs,epoxy libdeflate libjpeg freetype2)
HTTP_LIBS     = $(call pc,libs,libmicrohttpd)
# libconfig and libseccomp statically, with their allocations led through world/runtime/checked_alloc.c.
CONFIG_LIBS   = -Wl,-Bstatic $(call pc,libs,libconfig) -Wl,-Bdynamic
JSON_LIBS     = $(call pc,libs,libcjson)
CURSES_LIBS   = $(call pc,libs,ncursesw)
ARCHIVE_LIBS  = $(call pc,libs,libzstd)
PCAP_LIBS     = $(call pc,libs,libpcap)
SANDBOX_LIBS  = -Wl,-Bstatic $(call pc,libs,libseccomp) -Wl,-Bdynamic
# The engines that jolon-bench measures us beside; their headers are not held to our warnings.
PEER_CFLAGS   = $(patsubst -I%,-isystem %,$(call pc,cflags,bullet))
PEER_LIBS     = $(call pc,libs,ode) $(filter-out -lBulletSoftBody,$(call pc,libs,bullet)) -lstdc++
# jolon-ground alone needs these, and they are not held to our warnings.
GROUND_CFLAGS = $(patsubst -I%,-isystem %,$(call pc,cflags,gdal) $(call pc,cflags,proj))
GROUND_LIBS   = $(call pc,libs,gdal) $(call pc,libs,proj)
BASE_LIBS     = $(call pc,libs,libxxhash) -lm
# For tests, which use what they happen to test.
TEST_LIBS     = -Wl,--as-needed $(call pc,libs,cmocka libpng) $(RENDER_LIBS) $(HTTP_LIBS) $(DDS_LIBS) $(SANDBOX_LIBS) \
        $(JSON_LIBS) $(ARCHIVE_LIBS) $(PCAP_LIBS) $(CONFIG_LIBS) $(BASE_LIBS)

PROGRAMS := $(addprefix $(BIN)/jolon,-world -mover -collider -renderer -video -intake -reporter -recorder -gateway -dis \
        $(addprefix -,$(CLIENTS)) -keeper) $(BIN)/jolon
# The benchmarks have packages of their own, so only `make bench` and the tests build them.
BENCH    := $(BIN)/jolon-bench
# The maker of ground files has packages of its own, too: `make` builds it where they are installed, `make
# ground` and the tests install them.
GROUND   := $(BIN)/jolon-ground
GROUND_HERE := $(if $(shell pkg-config --exists gdal proj 2>/dev/null && echo yes),$(GROUND))
# Of the build with crash points: what their tests run.
CRASH_PROGRAMS := $(addprefix $(BIN)/jolon,-world -mover -collider -intake -recorder -keeper) $(BIN)/jolon \
        $(BUILD)/tests/crash/test_crash
UNIT_TESTS     := $(UNIT_SRC:%.c=$(BUILD)/%)
PROPERTY_TESTS := $(PROPERTY_SRC:%.c=$(BUILD)/%)
GOLDEN_TESTS   := $(BUILD)/tests/golden/test_golden
# What system tests run beside the programs.
STORM          := $(BUILD)/tests/storm/storm
LISTENER       := $(BUILD)/tests/once/listener
PEER           := $(BUILD)/tests/rtps/peer
LAG            := $(BUILD)/tests/lag/lag
FLOOD          := $(BUILD)/tests/flood/flood
VIDEO_PROBE    := $(BUILD)/tests/video_probe/video_probe

.PHONY: all ground run test tests check examples figures docs game rtps storm crash fuzz fuzzers model bench bench-render acceptance install uninstall format lint clean help
all: $(if $(CRASHPOINTS),$(CRASH_PROGRAMS),$(PROGRAMS) $(GROUND_HERE))
ifeq ($(GROUND_HERE)$(CRASHPOINTS)$(COUNTING),)
all:
	@echo 'jolon-ground, which makes ground files, is left out: GDAL and PROJ are missing; make ground installs them'
endif
ground: $(GROUND)

# --- programs -----------------------------------------------------------------------------------
link = @mkdir -p $(@D); $(call say,LD $@); $(CC) $(LDFLAGS_ALL) -o $@ $(filter %.o,$^) \
        -Wl,--start-group $(filter %.a,$^) -Wl,--end-group $(1)
STEPS := runs mover collider

$(BIN)/jolon-world: $(OBJ)/supervisor/worldctl/main.o $(call libraries,worldctl physics $(STEPS) config ipc world)
	$(call link,$(CONFIG_LIBS) $(JSON_LIBS) $(ARCHIVE_LIBS) $(BASE_LIBS))
$(BIN)/jolon-mover: $(OBJ)/mover/main.o $(call libraries,mover sandbox ipc world)
	$(call link,$(SANDBOX_LIBS) $(BASE_LIBS))
$(BIN)/jolon-collider: $(OBJ)/collider/main.o $(call libraries,collider sandbox ipc world)
	$(call link,$(SANDBOX_LIBS) $(BASE_LIBS))
$(BIN)/jolon-renderer: $(OBJ)/renderer/main.o $(call libraries,renderer http sandbox ipc world)
	$(call link,$(RENDER_LIBS) $(HTTP_LIBS) $(SANDBOX_LIBS) $(BASE_LIBS))
$(BIN)/jolon-video: $(OBJ)/renderer/video/main.o $(call libraries,video renderer $(STEPS) config http ipc world)
	$(call link,$(RENDER_LIBS) $(HTTP_LIBS) $(CONFIG_LIBS) $(JSON_LIBS) $(ARCHIVE_LIBS) $(BASE_LIBS))
$(BIN)/jolon-intake: $(OBJ)/reporter/intake/main.o $(call libraries,intake topics sandbox ipc world)
	$(call link,$(SANDBOX_LIBS) $(BASE_LIBS))
$(BIN)/jolon-reporter: $(OBJ)/reporter/main.o $(call libraries,reporter topics datagrams sandbox ipc world)
	$(call link,$(DDS_LIBS) $(SANDBOX_LIBS) $(BASE_LIBS))
$(BIN)/jolon-recorder: $(OBJ)/recorder/main.o $(call libraries,recorder $(STEPS) sandbox ipc world)
	$(call link,$(ARCHIVE_LIBS) $(JSON_LIBS) $(SANDBOX_LIBS) $(BASE_LIBS))
$(BIN)/jolon-ctl: $(OBJ)/clients/ctl/main.o $(call libraries,ctl topics datagrams ipc world)
	$(call link,$(DDS_LIBS) $(JSON_LIBS) $(BASE_LIBS))
$(BIN)/jolon-drive: $(OBJ)/clients/drive/main.o $(call libraries,drive screens topics datagrams ipc world)
	$(call link,$(DDS_LIBS) $(CURSES_LIBS) $(BASE_LIBS))
$(BIN)/jolon-console: $(OBJ)/clients/console/main.o $(call libraries,console topics http sandbox ipc world)
	$(call link,$(HTTP_LIBS) $(JSON_LIBS) $(SANDBOX_LIBS) $(BASE_LIBS))
$(BIN)/jolon-harness: $(OBJ)/clients/harness/main.o $(call libraries,harness topics datagrams ipc world)
	$(call link,$(DDS_LIBS) $(JSON_LIBS) $(BASE_LIBS))
$(BIN)/jolon-monitor: $(OBJ)/clients/monitor/main.o $(call libraries,monitor screens topics datagrams ipc world)
	$(call link,$(DDS_LIBS) $(CURSES_LIBS) $(JSON_LIBS) $(BASE_LIBS))
$(BIN)/jolon-gateway: $(OBJ)/gateway/main.o $(call libraries,gateway topics sandbox ipc world)
	$(call link,$(SANDBOX_LIBS) $(BASE_LIBS))
$(BIN)/jolon-dis: $(OBJ)/gateway/tool/main.o $(call libraries,tool gateway ipc world)
	$(call link,$(PCAP_LIBS) $(BASE_LIBS))
$(BENCH): $(OBJ)/tests/bench/main.o $(ENGINES) $(call libraries,bench physics renderer $(STEPS) config http ipc world)
	$(call link,$(RENDER_LIBS) $(HTTP_LIBS) $(CONFIG_LIBS) $(JSON_LIBS) $(ARCHIVE_LIBS) $(PEER_LIBS) $(BASE_LIBS))
$(ENGINES): | $(BENCH_STAMP)
$(GROUND): $(OBJ)/supervisor/ground/main.o $(call libraries,ground ipc world)
	$(call link,$(GROUND_LIBS) $(JSON_LIBS) $(ARCHIVE_LIBS) $(BASE_LIBS))
# The writer of ground files uses no library of maps, so its test and the fuzz harness need none. Nor does the maker of cover.
GROUND_WRITER := $(call objects,$(addprefix supervisor/ground/,canvas.c convex_parts.c ground_write.c out_file.c progress.c))
GROUND_COVER := $(call objects,$(addprefix supervisor/ground/,area.c free_ground.c map_cover.c))
$(filter-out $(GROUND_WRITER) $(GROUND_COVER),$(call objects,$(call sources,supervisor/ground))): | $(GROUND_STAMP)
$(call objects,$(call sources,supervisor/ground)): CFLAGS_EXTRA = $(GROUND_CFLAGS)
$(BIN)/jolon-keeper: $(OBJ)/supervisor/main.o $(call libraries,supervisor sandbox ipc world)
	$(call link,$(SANDBOX_LIBS) $(BASE_LIBS))
$(BIN)/jolon: supervisor/jolon
	@mkdir -p $(@D); install -m 755 $< $@

# --- objects ------------------------------------------------------------------------------------
# tests/includes keeps each library's headers to the folders that may use them. Painting is loops over
# rows, which the compiler makes vectors of; none of these options changes a result. Kernels pass
# their vectors within one file only.
$(call objects,$(addprefix renderer/scene/,terrain/terrain_colour.c terrain/terrain_block.c noise/value_noise_rows.c)): \
        CFLAGS_EXTRA = -O3 -fno-math-errno -fno-trapping-math
# A hash is the sum of those of words, which vectors add up.
$(call objects,world/word_hash.c): CFLAGS_EXTRA = -O3
# A heap's frame copies small structures without end, which gcc does by an instruction that begins
# slowly if it is not told otherwise (docs/decisions/032-resting-contacts.md).
UNROLLED = $(if $(and $(findstring gcc,$(CC)),$(filter x86_64-%,$(COMPILER))),-mstringop-strategy=unrolled_loop)
$(call objects,$(call sources,$(addprefix collider/,geometry guard motion narrow_phase parting response resting solver))): \
        CFLAGS_EXTRA = -O3 $(UNROLLED)
$(call objects,$(KERNEL_SRC) tests/unit/renderer/soft/test_soft.c) $(KERNELS): CFLAGS_EXTRA = -Wno-psabi
# What the topics say.
$(call objects,$(TOPICS_SRC) $(call sources,reporter reporter/intake $(addprefix clients/,$(CLIENTS)) tests/* docs/examples) \
        $(UNIT_SRC)): | $(IDL)/status.h

$(OBJ)/%.o: %.c $(BUILD)/flags | $(STAMP)
	@mkdir -p $(@D); $(call say,CC $<)
	@$(CC) $(CFLAGS_ALL) $(LIBRARY_CFLAGS) $(CFLAGS_EXTRA) -MMD -MP -c -o $@ $<

$(OBJ)/%.avx2.o: %.c $(BUILD)/flags | $(STAMP)
	@mkdir -p $(@D); $(call say,CC $< (AVX2))
	@$(CC) $(CFLAGS_ALL) -mavx2 $(LIBRARY_CFLAGS) $(CFLAGS_EXTRA) -MMD -MP -c -o $@ $<

$(OBJ)/%.o: %.cpp $(BUILD)/flags | $(STAMP)
	@mkdir -p $(@D); $(call say,CXX $<)
	@$(CXX) -std=c++17 $(CXXFLAGS_ALL) $(PEER_CFLAGS) -MMD -MP -c -o $@ $<

$(call objects,$(wildcard tests/*/*.c) $(UNIT_SRC) $(PROPERTY_SRC)): | $(TEST_STAMP)

# Again when a file comes or goes, too.
$(OBJ)/clients/console/page.list: $(call rewritten,$(OBJ)/clients/console/page.list,PAGE_FILES)
	@mkdir -p $(@D); echo '$(PAGE_FILES)' | cmp -s - $@ || echo '$(PAGE_FILES)' > $@
$(PAGE): $(PAGE_FILES) $(OBJ)/clients/console/page.list clients/console/embed | $(STAMP)
	@mkdir -p $(@D); $(call say,AS $@)
	@clients/console/embed $(PAGE_FILES) > $(@:.o=.s) && $(CC) -c -o $@ $(@:.o=.s)

# Generated from the IDL; generated code is not held to our warnings.
$(IDL)/status.c $(IDL)/status.h &: ipc/topics/status.idl | $(STAMP)
	@mkdir -p $(IDL); $(call say,IDL $<); idlc -l c -o $(IDL) $<
$(STATUS): $(IDL)/status.c $(IDL)/status.h $(BUILD)/flags
	@mkdir -p $(@D); $(call say,CC $<); $(CC) $(filter-out $(WARN),$(CFLAGS_ALL)) $(LIBRARY_CFLAGS) -c -o $@ $<

# Everything is built again when the compiler or its flags change.
FLAGS = $(CC) $(CFLAGS_ALL) $(LDFLAGS_ALL)
$(BUILD)/flags: $(call rewritten,$(BUILD)/flags,FLAGS) | $(STAMP)
	@mkdir -p $(@D); echo '$(FLAGS)' | cmp -s - $@ || echo '$(FLAGS)' > $@
.PHONY: FORCE
FORCE:

# --- tests --------------------------------------------------------------------------------------
# Calls of these functions go to __wrap_NAME of a test.
WRAP = -Wl,$(subst $(space),$(comma),$(patsubst %,--wrap=%,$(1)))
# tests/unit/FOLDER/test_NAME.c may use that folder's library beside those that every test may use.
COMMON := support renderer $(STEPS) config topics http ipc world
own_library = $(or $(filter $(CLIENTS) intake physics worldctl sandbox tool,$(word 4,$(subst /, ,$(1)))),$(filter recorder reporter supervisor physics bench,$(word 3,$(subst /, ,$(1)))))
define test_of
$(BUILD)/$(1:%.c=%): $(call libraries,$(call own_library,$(1)))
endef
$(foreach test,$(UNIT_SRC) $(PROPERTY_SRC),$(eval $(call test_of,$(test))))
$(BUILD)/tests/unit/supervisor/%: $(call libraries,sandbox)
$(filter $(BUILD)/tests/unit/gateway/% $(BUILD)/tests/property/gateway/%,$(UNIT_TESTS) $(PROPERTY_TESTS)): $(call libraries,gateway)
$(addprefix $(BUILD)/tests/unit/,ipc/topics/test_dds_datagrams ipc/topics/test_samples ipc/topics/test_command_text ipc/topics/test_event_lines clients/drive/test_vehicle_choice): $(call libraries,datagrams)
$(BUILD)/tests/unit/config/syntax/test_schema: $(OBJ)/docs/keys/key_tables.o
$(addprefix $(BUILD)/tests/unit/,supervisor/ground/test_canvas supervisor/ground/test_convex_parts supervisor/ground/test_ground_write supervisor/ground/test_out_file config/test_ground_objects config/test_ground_source world/terrain/test_posts_write): $(GROUND_WRITER)
$(BUILD)/tests/unit/supervisor/ground/test_map_cover: $(GROUND_COVER)
$(BUILD)/tests/unit/docs/figures/test_palette: $(OBJ)/docs/figures/palette.o
$(BUILD)/tests/crash/test_crash: $(call objects,$(call sources,tests/crash))
$(GOLDEN_TESTS): $(call libraries,bench)
$(BUILD)/tests/property/bench/test_heap_run: $(call libraries,physics)
$(BUILD)/tests/%: $(OBJ)/tests/%.o $(call libraries,$(COMMON))
	$(call link,$(TEST_LIBS))

# Preloaded by system tests; it stands in the way of functions that the headers say much about.
FAILING := $(BUILD)/tests/faults/failing.so
$(FAILING): tests/faults/failing.c $(BUILD)/flags | $(TEST_STAMP)
	@mkdir -p $(@D); $(call say,LD $@)
	@$(CC) -std=c17 $(OPT) -g -D_GNU_SOURCE $(filter-out -Wpedantic,$(WARN)) -fPIC -shared -o $@ $< -ldl

$(STORM): $(call objects,$(call sources,tests/storm)) $(call libraries,runs topics ipc world)
	$(call link,$(JSON_LIBS) $(BASE_LIBS))
$(LISTENER): $(OBJ)/tests/once/listener.o $(call libraries,topics datagrams ipc world)
	$(call link,$(DDS_LIBS) $(BASE_LIBS))
# It has no filter of its own (tests/rtps/sent.c).
$(PEER): $(call objects,$(call sources,tests/rtps)) $(call libraries,topics ipc world)
	$(call link,$(DDS_LIBS) $(BASE_LIBS))
$(FLOOD): $(OBJ)/tests/flood/flood.o $(call libraries,topics ipc world)
	$(call link,$(BASE_LIBS))
$(LAG): $(OBJ)/tests/lag/lag.o $(call libraries,ipc world)
	$(call link,$(BASE_LIBS))
# They are built as their readers build them: the types, DDS and nothing of ours.
EXAMPLES := $(BUILD)/examples/escort
examples: $(EXAMPLES)
$(BUILD)/examples/%: $(OBJ)/docs/examples/%.o $(STATUS)
	$(call link,$(DDS_LIBS) -lm)

$(VIDEO_PROBE): $(OBJ)/tests/video_probe/video_probe.o
	$(call link,$(call pc,libs,libavformat libavcodec libavutil))

check: $(UNIT_TESTS) $(PROPERTY_TESTS)
	@tests/run --build $(BUILD) $(if $(SAN),--sanitizer $(SAN)) unit property

# Crash points are tried unsanitized: a sanitizer has its own handler for faults.
# Builds what `make test` runs. The fuzz harnesses are compiled, but not linked: that takes clang.
tests: $(call objects,$(FUZZ_SRC))
tests: all $(BENCH) $(GROUND) $(UNIT_TESTS) $(PROPERTY_TESTS) $(GOLDEN_TESTS) $(FAILING) $(STORM) $(LISTENER) $(PEER) $(LAG) $(FLOOD) $(VIDEO_PROBE) $(EXAMPLES) $(BUILD)/docs/keys $(if $(SAN),,crash)
test: tests
	@tests/run --build $(BUILD) $(if $(SAN),--sanitizer $(SAN)) unit property golden system $(if $(SAN),,crash)

crash: | $(STAMP) $(TEST_STAMP)
	@$(if $(COUNTING),:,$(MAKE)) --no-print-directory CRASHPOINTS=1 BUILD=$(BUILD)/crash all

# --- fuzzing ------------------------------------------------------------------------------------
# Harnesses are clang's: tests/fuzz/run calls make again, with a compiler, sanitizers and a build
# tree for them.
FUZZERS := $(patsubst tests/fuzz/%.c,$(BIN)/%,$(filter tests/fuzz/fuzz_%,$(FUZZ_SRC)))
fuzzers: $(FUZZERS)
$(BIN)/fuzz_ctl $(BIN)/fuzz_log: FUZZ_LINK = $(call WRAP,exit)
$(BIN)/fuzz_ctl: $(call libraries,ctl)
$(BIN)/fuzz_command: $(call libraries,intake)
$(BIN)/fuzz_console: $(call libraries,console)
$(BIN)/fuzz_ground: $(GROUND_WRITER)
$(BIN)/fuzz_pdu $(BIN)/fuzz_gateway: $(call libraries,gateway)
$(BIN)/fuzz_samples $(BIN)/fuzz_filter: $(call libraries,monitor)
$(addprefix $(BIN)/fuzz_,command_text samples filter): $(call libraries,datagrams)
$(BIN)/fuzz_%: $(OBJ)/tests/fuzz/fuzz_%.o $(call libraries,fuzz $(filter-out support,$(COMMON)))
	$(call link,-fsanitize=fuzzer $(FUZZ_LINK) $(TEST_LIBS))

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

# Kills and stops processes at random and checks the consequences: tests/storm/README.md. A longer storm:
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

# What tests compare with real figures: quantity, real, ours.
ACCEPTANCE := unit/mover/motion/test_chassis property/mover/test_obstacles unit/mover/motion/test_ground_vehicle \
        unit/mover/motion/test_airframe unit/mover/motion/ground/test_landing property/mover/test_aircraft_acceptance \
        unit/mover/motion/test_ship property/mover/test_gun_table unit/mover/motion/test_missile \
        property/physics/test_blows unit/mover/agent/test_fire_control
acceptance: $(ACCEPTANCE:%=$(BUILD)/tests/%)
	@tests/acceptance $(BUILD) $^

# The physics of an hour of the default world; make judge [FRAMES=216000] [SCENARIO=file]
FRAMES   ?= 216000
judge: all
	@tests/physics-hour $(abspath $(BIN)) $(or $(SCENARIO),hunter-liggett) $(FRAMES)

# One after the other: each has the machine to itself.
bench: bench-render
	@tests/bench/run $(BENCH)
bench-render: all $(BENCH)
	@tests/bench/run-render $(BENCH)

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
# jolon-bench and jolon-ground are installed when they have been built.
INSTALLED = $(PROGRAMS) $(wildcard $(BENCH) $(GROUND))
PAGES = $(filter-out $(if $(wildcard $(BENCH)),,%/jolon-bench.1) $(if $(wildcard $(GROUND)),,%/jolon-ground.1),$(wildcard docs/man/*.1))
# In the folders in which they lie here, so that their links hold.
DOCUMENTS = LICENSE $(sort $(wildcard *.md */README.md) $(shell find docs -type f \
        '(' -name '*.md' -o -name '*.png' -o -name '*.svg' -o -path 'docs/examples/*' ')'))
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
	cp -R config/kinds config/models config/scenarios config/dis config/ground config/grounds config/cyclonedds.xml config/dds-security ipc/topics/status.idl $(SHARE)
	@cp --parents $(DOCUMENTS) $(DOC)
	chmod -R u=rwX,go=rX $(SHARE) $(DOC) $(UNITS)/jolon@.service
uninstall:
	rm -f $(addprefix $(DESTDIR)$(PREFIX)/bin/,$(notdir $(PROGRAMS) $(BENCH) $(GROUND)))
	rm -f $(addprefix $(MAN1)/,$(notdir $(wildcard docs/man/*.1)) jolon-start.1) $(COMPLETIONS)/jolon $(UNITS)/jolon@.service
	rm -rf $(SHARE) $(DOC)

# --- pictures of the documents ------------------------------------------------------------------
SHEET := $(BUILD)/figures/sheet
$(call objects,$(wildcard docs/figures/*.c)): | $(TEST_STAMP)
$(SHEET): $(call objects,$(wildcard docs/figures/*.c)) $(call libraries,renderer ipc world)
	$(call link,$(call pc,libs,libpng) $(RENDER_LIBS) $(BASE_LIBS))
figures: all $(SHEET)
	@docs/figures/make $(BUILD)

# --- tables of the documents --------------------------------------------------------------------
KEYS := $(BUILD)/docs/keys
$(KEYS): $(call objects,$(call sources,docs/keys)) $(call libraries,config ipc world)
	$(call link,-Wl$(comma)-u$(comma)__wrap_malloc $(CONFIG_LIBS) $(BASE_LIBS)) # libconfig comes after the archives
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
	@echo 'make examples                           programs that drive vehicles, see docs/examples/README.md'
	@echo 'make fuzz [SECONDS=30]                  hostile input, as long for each harness'
	@echo 'make CRASHPOINTS=1                      programs that die at a given store, into build/crash'
	@echo 'make rtps [PACKETS=1000000] [SEED=n]       mutated datagrams against a reporter'
	@echo 'make game [SECONDS=300] [SEED=n]          two players and a program at once, while everything is killed'
	@echo 'make storm [KILLS=1000] [SEED=n]           kill processes at random and check the consequences'
	@echo 'make acceptance                         print what is compared with real vehicles: quantity, real, ours'
	@echo 'make judge [FRAMES=216000]               judge the physics of an hour of the default world'
	@echo 'make model [MODEL=short|usual|full]      check the frame protocol with spin'
	@echo 'make bench                              build jolon-bench, measure; results in tests/bench/results/'
	@echo 'make bench-render                       what pictures cost, alone'
	@echo 'make ground                             build jolon-ground, which makes ground files; installs GDAL'
	@echo 'make install PREFIX=/usr/local DESTDIR= make uninstall'
	@echo 'make figures                            the pictures of docs/ again (A.1 to A.9 of the thesis)'
	@echo 'make docs                               the tables of keys in docs/scenario.md again'
	@echo 'make format | lint | clean'

-include $(shell find $(OBJ) -name '*.d' 2>/dev/null)
