# install.mk - make install, make uninstall. PREFIX is where things will stand when they are used, DESTDIR
# a folder to put all of it into instead (what makers of packages need). No name of a folder gets into a file
# but PREFIX into dagc.pc and radiosity.pc; the CMake package and the Make fragment find their folder themselves.
# SPDX-License-Identifier: MIT

PREFIX  = /usr/local
DESTDIR =
INSTALL = install
TO      = $(DESTDIR)$(PREFIX)
VERSION = $(shell sed -n 's/^.define DAGC_VERSION "\(.*\)"/\1/p' dagc/dag.h)


# dagc's part and radiosity's. Headers stand in one folder: radiosity.h includes those that refiners are compiled with.
# The interpreter of graphs, for programs of other domains: sources, as it is compiled with their runtime (dagc-runtime(5)).
INTERPRETER = $(addprefix oracle/,interpreter.c arguments.c refiner.c load_graph.c node_counting.c program.h refiner.h load_graph.h tool_table.h node_counting.h node_counts.h) \
            $(addprefix util/,messages.c messages.h)
GRAPHS    = $(wildcard examples/oracles/*.dag)
OF_DAGC   = bin/dagc lib/libdagc.a lib/pkgconfig/dagc.pc \
            $(addprefix lib/cmake/dagc/,dagcConfig.cmake dagcConfigVersion.cmake) \
            $(addprefix include/dagc/,dag.h catalog.h tool_table.h node_counts.h $(HEADERS)) $(addprefix share/dagc/,catalog.dag dagc.mk $(GRAPHS:examples/%=%)) \
            $(addprefix share/dagc/interpreter/,$(INTERPRETER)) \
            share/man/man1/dagc.1 share/man/man5/dagc-language.5 share/man/man5/dagc-runtime.5
OF_RADIOSITY = bin/radiosity include/dagc/radiosity.h lib/pkgconfig/radiosity.pc \
            $(addprefix lib/,libradiosity.a libradiosity.so.$(LIBRARY_VERSION) $(SONAME) libradiosity.so) \
            $(addprefix lib/cmake/radiosity/,radiosityConfig.cmake radiosityConfigVersion.cmake) share/man/man1/radiosity.1
# The folders that are ours alone, the inner ones first.
FOLDERS   = lib/cmake/dagc lib/cmake/radiosity include/dagc/tools include/dagc/terms include/dagc/kernel include/dagc share/dagc/oracles share/dagc/interpreter/oracle share/dagc/interpreter/util share/dagc/interpreter share/dagc
folders   = $(INSTALL) -d $(addprefix $(TO)/,$(sort $(dir $(1))))

.PHONY: install install-dagc install-radiosity uninstall
install: install-dagc install-radiosity
install-dagc: dagc $(BUILD)/gen/catalog.h $(addprefix $(BUILD)/install/,dagc.pc dagcConfigVersion.cmake dagc.1 dagc-language.5 dagc-runtime.5)
	$(call folders,$(OF_DAGC))
	$(INSTALL) -m 755 $(BUILD)/bin/dagc $(TO)/bin
	$(INSTALL) -m 644 $(LIBDAGC) $(TO)/lib
	$(INSTALL) -m 644 $(BUILD)/install/dagc.pc $(TO)/lib/pkgconfig
	$(INSTALL) -m 644 dagc/package/dagcConfig.cmake $(BUILD)/install/dagcConfigVersion.cmake $(TO)/lib/cmake/dagc
	$(INSTALL) -m 644 dagc/dag.h $(BUILD)/gen/catalog.h runtime/oracle/tool_table.h runtime/oracle/node_counts.h $(addprefix runtime/,$(filter-out tools/% terms/% kernel/%,$(HEADERS))) $(TO)/include/dagc
	$(INSTALL) -m 644 $(addprefix runtime/,$(filter tools/%,$(HEADERS))) $(TO)/include/dagc/tools
	$(INSTALL) -m 644 $(addprefix runtime/,$(filter terms/%,$(HEADERS))) $(TO)/include/dagc/terms
	$(INSTALL) -m 644 $(addprefix runtime/,$(filter kernel/%,$(HEADERS))) $(TO)/include/dagc/kernel
	$(INSTALL) -m 644 runtime/catalog.dag dagc/package/dagc.mk $(TO)/share/dagc
	$(INSTALL) -m 644 $(GRAPHS) $(TO)/share/dagc/oracles
	$(INSTALL) -m 644 $(addprefix runtime/,$(filter oracle/%,$(INTERPRETER))) $(TO)/share/dagc/interpreter/oracle
	$(INSTALL) -m 644 $(addprefix runtime/,$(filter util/%,$(INTERPRETER))) $(TO)/share/dagc/interpreter/util
	$(INSTALL) -m 644 $(BUILD)/install/dagc.1 $(TO)/share/man/man1
	$(INSTALL) -m 644 $(BUILD)/install/dagc-language.5 $(BUILD)/install/dagc-runtime.5 $(TO)/share/man/man5
install-radiosity: install-dagc commands library $(addprefix $(BUILD)/install/,radiosity.pc radiosityConfig.cmake radiosityConfigVersion.cmake radiosity.1)
	$(call folders,$(OF_RADIOSITY))
	$(INSTALL) -m 755 $(BUILD)/bin/radiosity $(TO)/bin
	$(INSTALL) -m 644 $(ARCHIVE) $(TO)/lib
	$(INSTALL) -m 755 $(BUILD)/libradiosity.so $(TO)/lib/libradiosity.so.$(LIBRARY_VERSION)
	ln -sf libradiosity.so.$(LIBRARY_VERSION) $(TO)/lib/$(SONAME)
	ln -sf $(SONAME) $(TO)/lib/libradiosity.so
	$(INSTALL) -m 644 $(BUILD)/install/radiosity.pc $(TO)/lib/pkgconfig
	$(INSTALL) -m 644 $(BUILD)/install/radiosityConfig.cmake $(BUILD)/install/radiosityConfigVersion.cmake $(TO)/lib/cmake/radiosity
	$(INSTALL) -m 644 runtime/radiosity.h $(TO)/include/dagc
	$(INSTALL) -m 644 $(BUILD)/install/radiosity.1 $(TO)/share/man/man1

uninstall:
	rm -f $(addprefix $(TO)/,$(OF_DAGC) $(OF_RADIOSITY))
	-for folder in $(addprefix $(TO)/,$(FOLDERS)); do [ ! -d $$folder ] || rmdir $$folder; done

# PREFIX may differ from one run to the next.
.PHONY: $(BUILD)/install/dagc.pc $(BUILD)/install/radiosity.pc
$(BUILD)/install/dagc.pc: dagc/package/dagc.pc.in
	@mkdir -p $(@D)
	sed -e 's|@PREFIX@|$(PREFIX)|' -e 's|@VERSION@|$(VERSION)|' $< > $@
$(BUILD)/install/radiosity.pc: runtime/package/radiosity.pc.in
	@mkdir -p $(@D)
	sed -e 's|@PREFIX@|$(PREFIX)|' -e 's|@VERSION@|$(LIBRARY_VERSION)|' -e 's|@LIBS@|$(ENGINE_LIBS)|' $< > $@
$(BUILD)/install/radiosityConfig.cmake: runtime/package/radiosityConfig.cmake.in Makefile runtime/radiosity.h
	@mkdir -p $(@D)
	sed -e 's|@SONAME@|$(SONAME)|' -e 's|@LIBS@|$(addsuffix ;,$(patsubst -l%,%,$(ENGINE_LIBS)))|' -e 's|; |;|g' -e 's|;"|"|' $< > $@
$(BUILD)/install/radiosityConfigVersion.cmake: dagc/package/dagcConfigVersion.cmake.in runtime/radiosity.h
	@mkdir -p $(@D)
	sed 's|@VERSION@|$(LIBRARY_VERSION)|' $< > $@
$(BUILD)/install/dagcConfigVersion.cmake: dagc/package/dagcConfigVersion.cmake.in dagc/dag.h
	@mkdir -p $(@D)
	sed 's|@VERSION@|$(VERSION)|' $< > $@
$(BUILD)/install/dagc%: dagc/man/dagc% dagc/man/tables.sh dagc/dag.h $(wildcard dagc/*/*.def)
	@mkdir -p $(@D)
	sh dagc/man/tables.sh $(VERSION) $< > $@
$(BUILD)/install/radiosity.1: solver/man/radiosity.1 solver/man/options.sh $(BUILD)/bin/radiosity
	@mkdir -p $(@D)
	sh solver/man/options.sh $(BUILD)/bin/radiosity $< > $@
