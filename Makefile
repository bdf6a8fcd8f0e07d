# make          the commands dagc and radiosity in build/bin, build/libradiosity.a and .so
# make dagc     dagc and libdagc.a alone, which need a C compiler and libc
# make check    the tests
# make check-again  those that may end otherwise when commands and library were made by another compiler, or with sanitizers
# make stability  examples/stability.md: where methods fail, by how much, and the order in which errors fall
# make check-accuracy  numbers against the truth in their long forms, whole solutions against traced particles among them
# make check-all  all tests, those that have a long form in that form
# make mutations  code broken on purpose, and which suite notices
# make prove    1,000 random graphs: interpreter and compiled function on every path
# make bench-size  seconds that graphs of 100, 1,000 and 10,000 nodes take to compile
# make fuzz     FUZZ_SECONDS (60) of mutated sources through dagc under sanitizers; needs clang's libFuzzer
# make fuzz-scenes  FUZZ_FILES (20000) damaged scene files through the readers and a solve, then FUZZ_SECONDS of them under sanitizers
# make demo     the main job on real scenes, pictures included
# make drawings the graphs of examples/oracles, drawn anew (needs Graphviz)
# make heat     the graph of the default oracle with what it did in room.obj (needs Graphviz)
# make picture-table  build/bin/picture_table, which holds what pictures show against the light at each pixel
# make factor-rays  build/bin/factor_rays, which holds matrices of view factors against rays
# make tables   the tables of README.md and of the pages in examples anew (TABLES="NAME...": some)
# make bench    the studies of examples/studies: releases, accuracy, need, growth, limit, bounds, viewfactors, waves: rows, charts and pages (STUDIES="NAME...": some)
# make bench-threads  what two threads bring, and what they cost beside 8 busy loops
# make bench-waves  what releases take of the same pairs, in blocks and one by one, over the bare Embree time of their rays
# make install  commands, libraries and what their users need, to PREFIX (/usr/local) under DESTDIR; make uninstall
# make install-dagc  the part of it that is dagc's
# make clean    build/ is removed
# SPDX-License-Identifier: MIT

CC       = gcc
OBJCOPY  = objcopy
BUILD    = build
OPT      = -O2 -g
WARN     = -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror
# No contraction of a*b+c: all releases of an oracle must agree to the bit.
# Nobody asks for errno after a root, or for flags: without them loops over roots and choices become vectors, values stay.
CFLAGS   = -std=c11 $(OPT) $(WARN) -ffp-contract=off -fno-math-errno -fno-trapping-math $(PARALLEL) $(SANITIZE)
CPPFLAGS = -D_XOPEN_SOURCE=700 -I$(BUILD)/gen
LDFLAGS  = $(SANITIZE)
# Which headers an object was made of.
DEPEND   = $(if $(findstring tcc,$(CC)),-MD,-MMD -MP)
# Whose headers the compiler finds (runtime/util/embree.h), wherever they are: calls of 4 end in a crash with 3.
EMBREE  := -lembree$(shell printf '\043include <embree4/rtcore.h>\n' | $(CC) $(CPPFLAGS) -E -x c - >/dev/null 2>&1 && echo 4 || echo 3)
# MPI=1: for runs over several processes (mpirun). Two objects ask: what they were made for stands in a file, so that another
# answer makes them anew. PETSC=1: for --solver petsc, of which three more know; Debian's is built on Open MPI.
PETSC      =
PETSC_NAME = $(firstword $(foreach name,PETSc petsc,$(if $(shell pkg-config --exists $(name) && echo yes),$(name))))
ifneq ($(filter-out 0 no,$(PETSC)),)
ifneq ($(PETSC_NAME),)
PETSC_CFLAGS = -DRADIOSITY_PETSC $(patsubst -I%,-isystem %,$(filter -I%,$(shell pkg-config --cflags $(PETSC_NAME))))
PETSC_LIBS = $(shell pkg-config --libs $(PETSC_NAME))
else
$(warning PETSC=1: pkg-config finds no PETSc or petsc yet: package libpetsc-real-dev)
endif
endif
MPI      = $(filter-out 0 no,$(PETSC))
MPI_NAME = $(firstword $(foreach name,ompi mpi mpich,$(if $(shell pkg-config --exists $(name) && echo yes),$(name))))
ifneq ($(filter-out 0 no,$(MPI)),)
MPI_CFLAGS = -DRADIOSITY_MPI $(patsubst -I%,-isystem %,$(shell pkg-config --cflags $(MPI_NAME)))
MPI_LIBS = $(shell pkg-config --libs $(MPI_NAME))
endif
# HDF5=1, or MPI=1 where there is the parallel one: for checkpoints and .xdmf, of which one object of the command knows.
HDF5      = $(if $(MPI_LIBS),yes)
HDF5_NAME = $(firstword $(foreach name,$(if $(MPI_LIBS),hdf5-openmpi hdf5-mpich hdf5-mpi,hdf5-serial hdf5 hdf5-openmpi hdf5-mpich),$(if $(shell pkg-config --exists $(name) && echo yes),$(name))))
ifneq ($(filter-out 0 no,$(HDF5)),)
ifneq ($(HDF5_NAME),)
HDF5_CFLAGS = -DRADIOSITY_HDF5 $(patsubst -I%,-isystem %,$(shell pkg-config --cflags $(HDF5_NAME)))
HDF5_LIBS = $(shell pkg-config --libs $(HDF5_NAME))
else ifeq ($(MPI_LIBS),)
$(warning HDF5=1: pkg-config finds no hdf5-serial, hdf5 or hdf5-openmpi yet: package libhdf5-dev)
endif
endif
# What the library is linked with, and what the command needs besides.
ENGINE_LIBS = $(EMBREE) $(PETSC_LIBS) $(MPI_LIBS) -lpthread -ldl -lm
LIBS     = $(EMBREE) $(HDF5_LIBS) $(PETSC_LIBS) $(MPI_LIBS) -lexpat -ljansson -lpng -lz -lpthread -ldl -lm

# By what name a library is loaded while running: that of the version that is linked, of the headers.
SONAME_OF = $(shell readelf -d "$$($(CC) -print-file-name=lib$(1).so)" | sed -n 's/.*SONAME.*\[\(.*\)\].*/\1/p')

# Walls: what a folder may include it finds in $(WALLS)/FOLDER, links to the folders it may use, and nowhere else.
WALLS     = $(BUILD)/walls
PUBLIC    = catalog.dag discussion.h geometry.h oracle.h radiosity.h standalone.h wave.h
TOOLKIT   = $(PUBLIC) kernel terms tools
wall_util       = util
wall_hierarchy  = $(TOOLKIT) util hierarchy
wall_visibility = $(wall_hierarchy) visibility
wall_oracle     = $(TOOLKIT) util oracle
wall_particles  = $(wall_visibility) particles
wall_engine     = $(wall_particles) oracle engine
ROOMS     = util oracle hierarchy visibility particles engine
# The command sees public headers, what is inline of a pair's geometry, arrays, the clock and the pool of threads; it links
# the library, which hides its pool: the command has one of its own.
wall_solver     = $(TOOLKIT)

objects   = $(patsubst %.c,$(BUILD)/%.o,$(filter-out %/main.c,$(foreach d,$(1),$(wildcard $(d:/=)/*.c))))
# common.dag holds what they share, and no oracle.
ORACLES   = $(filter-out common,$(notdir $(basename $(wildcard examples/oracles/*.dag))))
FLAT      = $(ORACLES:%=$(BUILD)/gen/oracles/%.o)
LIBDAGC   = $(BUILD)/libdagc.a
RUNTIME   = $(call objects,$(ROOMS:%=runtime/%)) $(BUILD)/gen/catalog.o $(FLAT) $(BUILD)/gen/builtin.o
SOLVER    = $(call objects,solver $(wildcard solver/*/)) $(BUILD)/gen/panel_text.o $(call objects,tests/hand)
# What tests of the engine's insides read scenes and name oracles with.
SUPPORT   = $(call objects,$(wildcard tests/support/*/))
TESTS     = $(patsubst tests/%.c,$(BUILD)/tests/%,$(wildcard tests/*/check_*.c))
SCRIPTS   = $(wildcard tests/check_*.sh tests/*/check_*.sh)
# Of what goes into the library, each object is compiled once, for the archive, the shared library, the commands and the tests.
EMBEDDED  = $(patsubst %,$(BUILD)/gen/%_text.o,catalog headers interpreter)
SHARED    = $(call objects,$(wildcard dagc/*/)) $(RUNTIME) $(EMBEDDED)
ARCHIVE   = $(BUILD)/libradiosity.a
COMMAND   = $(SOLVER) $(BUILD)/runtime/util/thread_pool.o $(ARCHIVE)
LIBRARY_VERSION = $(shell sed -n 's/^.define RADIOSITY_VERSION "\(.*\)"/\1/p' runtime/radiosity.h)
SONAME    = libradiosity.so.$(basename $(LIBRARY_VERSION))
OBJECTS   = $(call objects,$(wildcard dagc/*/)) $(RUNTIME) $(SOLVER) $(SUPPORT) $(BUILD)/dagc/command/main.o $(BUILD)/solver/main.o

FUZZ_SECONDS = 60

.PHONY: all check check-again check-accuracy check-all mutations prove bench-size fuzz demo packages bench clean
.DELETE_ON_ERROR:
.SECONDARY:

all: packages
	@$(MAKE) --no-print-directory commands library

# For python/binding.py.
.PHONY: engine-libraries
engine-libraries:
	@echo $(ENGINE_LIBS)

.PHONY: commands library dagc
commands: $(BUILD)/bin/dagc $(BUILD)/bin/radiosity
library: $(ARCHIVE) $(BUILD)/libradiosity.so
dagc: $(BUILD)/bin/dagc $(LIBDAGC)

# What is built by what: catalog.dag -> libdagc -> dagc -> everything that includes discussion.h.
$(BUILD)/bin/dagc: $(BUILD)/dagc/command/main.o $(LIBDAGC)
	@mkdir -p $(@D)
	$(CC) $(SANITIZE) -o $@ $^ -ldl -lm
$(LIBDAGC): $(call objects,$(wildcard dagc/*/)) $(EMBEDDED)
	rm -f $@
	ar rcs $@ $^
$(BUILD)/gen/catalog_text.c: runtime/catalog.dag dagc/emit/embed.sh
	@mkdir -p $(@D)
	sh dagc/emit/embed.sh dagc_standard_catalog $< > $@
HEADERS   = discussion.h geometry.h oracle.h standalone.h wave.h $(patsubst runtime/%,%,$(wildcard runtime/kernel/*.h runtime/terms/*.h runtime/tools/*.h))
$(BUILD)/gen/headers_text.c: $(HEADERS:%=runtime/%) dagc/emit/embed_headers.sh
	@mkdir -p $(@D)
	sh dagc/emit/embed_headers.sh dagc_headers runtime $(HEADERS) > $@
# --prove compiles the interpreter along with what it interprets.
PROVED    = $(addprefix oracle/,interpreter.c arguments.c refiner.c load_graph.h program.h refiner.h tool_table.h in_proof.inc) util/messages.c util/messages.h
PROVING   = dag.h prove/proof.h
$(BUILD)/gen/interpreter_text.c: $(PROVED:%=runtime/%) $(PROVING:%=dagc/%) dagc/emit/embed_headers.sh
	@mkdir -p $(@D)
	sh dagc/emit/embed_headers.sh dagc_interpreter runtime $(PROVED) -- dagc $(PROVING) > $@
$(BUILD)/gen/catalog.h: runtime/catalog.dag $(BUILD)/bin/dagc
	$(BUILD)/bin/dagc --emit=catalog-h -o $@ $<
$(BUILD)/gen/catalog.c: runtime/catalog.dag $(BUILD)/bin/dagc
	$(BUILD)/bin/dagc --emit=catalog-c -o $@ $<
$(BUILD)/gen/oracles/%.c: examples/oracles/%.dag examples/oracles/common.dag $(BUILD)/bin/dagc
	@mkdir -p $(@D)
	$(BUILD)/bin/dagc --release=wave -o $@ --header $(@:.c=.h) $<
$(BUILD)/gen/builtin.c: runtime/oracle/builtin.sh $(wildcard examples/oracles/*.dag) dagc/emit/embed.sh
	@mkdir -p $(@D)
	sh runtime/oracle/builtin.sh $(ORACLES) > $@
PANEL     = $(addprefix solver/panel/,panel.html panel.css page.js parameters.js result.js graph.js)
$(BUILD)/gen/panel_text.c: $(PANEL) dagc/emit/embed.sh
	@mkdir -p $(@D)
	for file in $(PANEL); do sh dagc/emit/embed.sh $$(basename $$file | tr . _) $$file || exit 1; done > $@

# One object in which only radiosity.h's functions are global: a program's own libdagc, or its own `link`, meets none of ours.
$(ARCHIVE): $(RUNTIME) $(LIBDAGC)
	$(LD) -r -d -o $(BUILD)/libradiosity.o $^
	$(OBJCOPY) -w --keep-global-symbol='rad[A-Z]*' $(BUILD)/libradiosity.o
	rm -f $@
	ar rcs $@ $(BUILD)/libradiosity.o
$(BUILD)/libradiosity.so: $(RUNTIME) $(LIBDAGC) runtime/package/exported.map
	$(CC) $(SANITIZE) -shared -Wl,-soname,$(SONAME) -Wl,--version-script,runtime/package/exported.map -o $@ $(RUNTIME) $(LIBDAGC) $(ENGINE_LIBS)

$(BUILD)/bin/radiosity: $(BUILD)/solver/main.o $(COMMAND)
	$(CC) $(LDFLAGS) -o $@ $^ $(LIBS)
BY_API    = $(BUILD)/tests/runtime/check_api
$(BY_API): %: %.o $(ARCHIVE)
	$(CC) $(LDFLAGS) -o $@ $^ $(ENGINE_LIBS) $$(pkg-config --libs check)
# What suites look into. With sanitizers each would be 80 MB, and all of them 8 GB: there they share one library that hides nothing.
INSIDES   = $(if $(SANITIZE),$(BUILD)/tests/insides.so,$(SUPPORT) $(SOLVER) $(RUNTIME) $(LIBDAGC))
$(filter-out $(BY_API),$(TESTS)) $(BUILD)/tests/runtime/width_rooms: %: %.o $(INSIDES)
	$(CC) $(LDFLAGS) -rdynamic -Wl,-rpath,'$$ORIGIN/..' -o $@ $^ $(LIBS) -lassimp $$(pkg-config --libs check)
$(BUILD)/tests/insides.so: $(SUPPORT) $(SOLVER) $(SHARED)
	$(CC) $(LDFLAGS) -shared -Wl,-soname,$(@F) -o $@ $^ $(LIBS) -lassimp

$(BUILD)/tests/runtime/embed_engine: $(BUILD)/tests/runtime/embed_engine.o $(BUILD)/examples/embed/mesh.o $(RUNTIME) $(LIBDAGC)
	$(CC) $(LDFLAGS) -o $@ $^ $(LIBS)

$(foreach room,$(ROOMS),$(eval $(BUILD)/runtime/$(room)/%.o: CPPFLAGS += -I$(WALLS)/$(room)))
$(BUILD)/runtime/oracle/%.o $(BUILD)/runtime/engine/%.o: CPPFLAGS += -Idagc
$(BUILD)/runtime/util/lapack_library.o: CPPFLAGS += -DLAPACK_LIBRARY='"$(call SONAME_OF,lapacke)"'
$(BUILD)/dagc/%.o: CPPFLAGS += -Idagc
# dagc needs a C compiler and nothing else.
DAGC_OBJECTS = $(call objects,$(wildcard dagc/*/)) $(BUILD)/dagc/command/main.o $(BUILD)/gen/catalog_text.o $(BUILD)/gen/headers_text.o
$(DAGC_OBJECTS): PARALLEL =
$(BUILD)/solver/util/assimp_library.o: CPPFLAGS += -DASSIMP_LIBRARY='"$(call SONAME_OF,assimp)"'
$(BUILD)/solver/%.o: CPPFLAGS += -Isolver -I$(WALLS)/solver -Itests/hand
$(BUILD)/tests/%.o: CPPFLAGS += -Itests -Itests/support -Itests/hand -Isolver -Iruntime -Idagc
$(BUILD)/examples/%.o: CPPFLAGS += -Iruntime
$(BUILD)/gen/%.o: CPPFLAGS += -Iruntime -Iruntime/oracle -Idagc

$(WALLS)/made: Makefile
	@rm -rf $(WALLS)
	@$(foreach room,$(ROOMS) solver,mkdir -p $(WALLS)/$(room) && ln -s $(wall_$(room):%=$(CURDIR)/runtime/%) $(WALLS)/$(room) &&) \
	mkdir -p $(WALLS)/solver/util && ln -s $(CURDIR)/runtime/util/array.h $(CURDIR)/runtime/util/clock.h $(CURDIR)/runtime/util/loaded_symbol.h \
		$(CURDIR)/runtime/util/thread_pool.h $(WALLS)/solver/util && touch $@
$(filter $(BUILD)/runtime/%,$(RUNTIME)) $(filter $(BUILD)/solver/%,$(SOLVER)) $(BUILD)/solver/main.o: | $(WALLS)/made
$(SHARED) $(if $(SANITIZE),$(SUPPORT) $(SOLVER)): CFLAGS += -fPIC
$(RUNTIME): CFLAGS += $(if $(SANITIZE),,-fvisibility=hidden)
# Threads are util/thread_pool.h's; of OpenMP the library takes only what says that a loop may be a vector's. Some tests call
# it from threads of OpenMP's.
$(RUNTIME): PARALLEL = -fopenmp-simd
$(TESTS:=.o): PARALLEL = -fopenmp

ASK_MPI   = $(BUILD)/runtime/util/ranks.o $(BUILD)/solver/util/machines.o
$(ASK_MPI): CPPFLAGS += $(MPI_CFLAGS)
$(ASK_MPI): $(BUILD)/mpi
ASK_PETSC = $(patsubst %,$(BUILD)/runtime/engine/petsc_%.o,start sums equation solution)
$(ASK_PETSC): CPPFLAGS += $(MPI_CFLAGS) $(PETSC_CFLAGS)
$(ASK_PETSC): $(BUILD)/petsc
ASK_HDF5  = $(BUILD)/solver/output/hdf5_file.o
$(ASK_HDF5): CPPFLAGS += $(MPI_CFLAGS) $(HDF5_CFLAGS)
$(ASK_HDF5): $(BUILD)/hdf5
.PHONY: FORCE
# A file that says by which flags objects were made, and is as old as these.
made_for  = @mkdir -p $(@D); echo "$(1)" | cmp -s - $@ || echo "$(1)" > $@
$(BUILD)/hdf5: FORCE
	$(call made_for,$(MPI_CFLAGS) $(HDF5_CFLAGS) $(HDF5_LIBS))
$(BUILD)/petsc: FORCE
	$(call made_for,$(PETSC_CFLAGS) $(PETSC_LIBS))
$(BUILD)/mpi: FORCE
	$(call made_for,$(MPI_CFLAGS) $(MPI_LIBS))

$(BUILD)/%.o: %.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) $(CFLAGS) $(DEPEND) -c -o $@ $<
$(BUILD)/gen/%.o: $(BUILD)/gen/%.c
	$(CC) $(CPPFLAGS) $(CFLAGS) $(DEPEND) -c -o $@ $<
$(filter $(BUILD)/runtime/% $(BUILD)/solver/% $(BUILD)/tests/%,$(OBJECTS) $(TESTS:=.o)) $(FLAT) $(BUILD)/gen/builtin.o $(BUILD)/tests/runtime/embed_engine.o $(BUILD)/tests/runtime/width_rooms.o: $(BUILD)/gen/catalog.h

packages:
	@PACKAGES_MORE="$$PACKAGES_MORE $(if $(filter-out 0 no,$(PETSC)),libpetsc-real-dev) $(if $(filter-out 0 no,$(MPI)),libopenmpi-dev openmpi-bin libhdf5-openmpi-dev,$(if $(filter-out 0 no,$(HDF5)),libhdf5-dev))" sh tests/packages.sh

# Tests are compiled and linked once for a run of seconds: to optimise them costs more than it saves, but for those that
# compute much themselves.
COMPUTING = paths surface_error shaft separable_links viewfactors accuracy oracles flat_groups group_entries profiles \
            exchange_state terms form_factor_levels closed_forms
TRACED    = $(if $(SANITIZE),-g1)
$(TESTS:=.o): override OPT = -O0 $(TRACED)
$(COMPUTING:%=$(BUILD)/tests/runtime/check_%.o): override OPT = -O1 $(TRACED)
$(TESTS): LDFLAGS += -fopenmp $(if $(shell command -v ld.gold),-fuse-ld=gold)
# As many jobs as there are processors, unless the caller says how many.
JOBS      = $(if $(filter -j% --jobserver%,$(MAKEFLAGS)),,-j$(shell nproc))
HELPERS   = $(BUILD)/tests/runtime/embed_engine $(BUILD)/tests/runtime/width_rooms $(BUILD)/bin/cell_error $(BUILD)/bin/by_chance $(BUILD)/bin/cost_of $(BUILD)/bin/embree_bytes
.PHONY: checked
checked: all
	@$(MAKE) $(JOBS) --no-print-directory $(TESTS) $(HELPERS)
check: checked
	@bash tests/run.sh $(BUILD) $(TESTS) $(SCRIPTS)

# What another compiler may change are bits; what sanitizers look on at is all but what says of itself that once is enough.
BITS      = language plain_math releases waves
ONCE      = $(shell grep -l '^ \* Once is enough: ' $(wildcard tests/*/check_*.c)) $(shell grep -l '^. Once is enough: ' $(SCRIPTS))
AGAIN     = $(if $(SANITIZE),$(filter-out $(ONCE:tests/%.c=$(BUILD)/tests/%),$(TESTS) $(SCRIPTS)),$(filter $(BITS:%=\%/check_%),$(TESTS)))
check-again: all
	@$(MAKE) $(JOBS) --no-print-directory $(if $(SANITIZE),,$(TESTS:=.o)) $(filter $(TESTS),$(AGAIN)) $(HELPERS)
	@bash tests/run.sh $(BUILD) $(AGAIN)

# Suites that hold numbers against the truth, in their long forms, which they have when THOROUGH is set; but group_entries,
# whose sixty rooms take as long as all these.
ACCURACY  = accuracy bracket clusters linear measured_error oracles projection scale separable_links solve \
            stability study_greedy surface_error terms viewfactors
check-accuracy: checked
	@THOROUGH=1 bash tests/run.sh $(BUILD) $(filter $(ACCURACY:%=\%/check_%),$(TESTS))
check-all: checked
	@THOROUGH=1 bash tests/run.sh $(BUILD) $(TESTS) $(SCRIPTS)

# Code broken on purpose: does a suite near it fail?
mutations:
	@bash tests/mutations.sh

prove: commands
	@sh tests/dagc/prove.sh $(BUILD)/bin/dagc 1000
bench-size: commands
	@sh tests/dagc/bench_size.sh $(BUILD)/bin/dagc

# Everything once more, in a folder of its own: each object tells libFuzzer which branches it takes.
FUZZ      = $(BUILD)/fuzz
FUZZCC    = clang
fuzz:
	@echo 'int LLVMFuzzerTestOneInput(void); int LLVMFuzzerTestOneInput(void) { return 0; }' | \
	    $(FUZZCC) -x c -fsanitize=fuzzer,address -o /dev/null - || { \
	    echo "make fuzz needs clang with libFuzzer: apt-get install clang libclang-rt-dev (or libclang-rt-NN-dev, NN as in clang --version)" >&2; exit 1; }
	@$(MAKE) --no-print-directory BUILD=$(FUZZ) CC=$(FUZZCC) OPT="-O1 -g" \
	    SANITIZE="-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined" $(FUZZ)/fuzz_dagc
	@sh tests/dagc/fuzz.sh $(FUZZ) $(FUZZ_SECONDS)
$(BUILD)/fuzz_%: $(BUILD)/tests/dagc/fuzz_%.o $(LIBDAGC)
	$(CC) $(LDFLAGS) -fsanitize=fuzzer -Wl,--wrap=fopen -o $@ $^ -lm

# First as the commands are, so that memory is measured; then everything once more, in a folder of its own, and other files.
FUZZ_FILES = 20000
DAMAGED    = $(BUILD)/damaged
.PHONY: fuzz-scenes
fuzz-scenes: commands
	@$(MAKE) --no-print-directory $(BUILD)/tests/solver/check_damaged
	@mkdir -p $(DAMAGED)
	FUZZ_FILES=$(FUZZ_FILES) FUZZ_SECONDS=0 FUZZ_FOUND=$(DAMAGED)/found $(BUILD)/tests/solver/check_damaged
	@$(MAKE) --no-print-directory BUILD=$(DAMAGED) OPT="-O1 -g" \
	    SANITIZE="-fsanitize=address,undefined -fno-sanitize-recover=undefined" $(DAMAGED)/tests/solver/check_damaged
	ASAN_OPTIONS=allocator_may_return_null=1 FUZZ_SEED=2 FUZZ_SECONDS=$(FUZZ_SECONDS) FUZZ_FOUND=$(DAMAGED)/found $(DAMAGED)/tests/solver/check_damaged

demo: all
	@sh examples/demo.sh $(BUILD)

# A study is tests/studies/NAME.sh; what has been run stays in BUILD/studies. BUDGET: processor seconds for each scene.
STUDIES   = releases accuracy need growth limit bounds viewfactors waves
bench: commands $(BUILD)/bin/cell_error $(BUILD)/bin/by_chance $(BUILD)/bin/cost_of $(BUILD)/bin/embree_bytes $(BUILD)/bin/wave_times
	@set -e; for study in $(STUDIES); do \
	    [ -f tests/studies/$$study.sh ] || { echo "make bench: error: there is no study $$study; there are: $(filter-out lib accuracy_page check_studies,$(notdir $(basename $(wildcard tests/studies/*.sh))))" >&2; exit 1; }; \
	    BUILD=$(BUILD) bash tests/studies/$$study.sh; \
	done

# Seconds alone and beside busy loops; SCENES="..." for other scenes.
.PHONY: bench-threads
bench-threads: commands
	@bash tests/bench_threads.sh $(BUILD)/bin/radiosity $(SCENES)

# What releases take of the same pairs, block by block, and the bare Embree time of their rays; ORACLE="..." SCENES="..." for others.
.PHONY: bench-waves
bench-waves: commands $(BUILD)/bin/wave_times
	@for oracle in $(or $(ORACLE),bf bf_guarded power); do \
	    echo "$$oracle"; $(BUILD)/bin/wave_times $$oracle $(or $(SCENES),$(addprefix examples/scenes/,cornell.obj room.obj maze_8.obj td.obj)) || exit 1; \
	done
$(BUILD)/bin/wave_times: $(BUILD)/tests/studies/wave_times.o $(SUPPORT) $(SOLVER) $(RUNTIME) $(LIBDAGC)
	@mkdir -p $(@D)
	$(CC) $(LDFLAGS) -rdynamic -o $@ $^ $(LIBS)

# The drawings of the oracles, without Graphviz's comments and tooltips. Not of tester, which asks the
# same of eight sizes of pairs.
.PHONY: drawings
drawings: commands
	@mkdir -p examples/oracles/drawings
	for name in $(filter-out tester,$(ORACLES)); do \
	    $(BUILD)/bin/dagc --emit=svg -Wno-all -o $(BUILD)/$$name.svg examples/oracles/$$name.dag && \
	    sed -e '/^<!--.*-->$$/d' -e '/^<!--/,/-->$$/d' -e '/^<title>/d' $(BUILD)/$$name.svg > examples/oracles/drawings/$$name.svg || exit 1; \
	done

# The page of cases on which methods fail; about half a minute.
.PHONY: stability
stability: commands
	$(BUILD)/bin/radiosity study stability -q -o examples/stability.md

.PHONY: heat
heat: commands
	$(BUILD)/bin/radiosity solve examples/scenes/room.obj -q --no-errors --statistics $(BUILD)/power_room.json
	$(BUILD)/bin/radiosity draw power --statistics $(BUILD)/power_room.json -o examples/oracles/drawings/power_room.svg

clean:
	rm -rf $(BUILD)

include install.mk
-include $(OBJECTS:.o=.d) $(TESTS:=.d) $(wildcard $(BUILD)/tests/*/*.d)

# Rows of view factors against rays, in a room of 6,528 faces or any other number.
.PHONY: factor-rays
factor-rays: $(BUILD)/bin/factor_rays
$(BUILD)/bin/factor_rays: $(BUILD)/tests/runtime/factor_rays.o
	@mkdir -p $(@D)
	$(CC) $(LDFLAGS) -o $@ $^ -lm

# How far solutions are from the truth, on cells and on faces, and the tables that tell of it (tests/tables/make.sh).
$(BUILD)/bin/cell_error: $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/tables/*.c)) $(COMMAND)
	@mkdir -p $(@D)
	$(CC) $(LDFLAGS) -o $@ $^ $(LIBS)
$(BUILD)/bin/by_chance: $(BUILD)/tests/studies/by_chance.o $(COMMAND)
	@mkdir -p $(@D)
	$(CC) $(LDFLAGS) -o $@ $^ $(LIBS)
$(BUILD)/bin/cost_of: $(BUILD)/tests/studies/cost_of.o
	@mkdir -p $(@D)
	$(CC) $(LDFLAGS) -o $@ $^
$(BUILD)/bin/embree_bytes: $(BUILD)/tests/studies/embree_bytes.o
	@mkdir -p $(@D)
	$(CC) $(LDFLAGS) -o $@ $^ $(EMBREE)
.PHONY: tables
tables: commands $(BUILD)/bin/cell_error $(BUILD)/bin/factor_rays $(BUILD)/bin/cost_of
	@sh tests/tables/make.sh $(BUILD) $(TABLES)

# A row of a table: how far pictures are from what each pixel gathers.
.PHONY: picture-table
picture-table: $(BUILD)/bin/picture_table
$(BUILD)/bin/picture_table: $(BUILD)/tests/solver/picture_table.o $(SOLVER) $(RUNTIME) $(LIBDAGC)
	@mkdir -p $(@D)
	$(CC) $(LDFLAGS) -o $@ $^ $(LIBS)

