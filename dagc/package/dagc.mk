# dagc.mk - how make gets NAME.c and NAME.h from NAME.dag, here and in folders below. In a makefile:
#
#   include $(shell pkg-config --variable=makefragment dagc)
#   CFLAGS += $(DAGC_CFLAGS)
#   program: main.o graph.o sub/other.o
#   	$(CC) -o $@ $^ $(DAGC_LIBS)
#   main.o: graph.h sub/other.h
#
# DAGCFLAGS are options for dagc, e.g. -Werror. With DAGC_CXX = 1 set before the include it is NAME.cpp, for C++. With
# DAGC_CATALOG = net.dag set before, or where a graph beside the makefile says catalog "net.dag"; on a line of its own,
# graphs are compiled for that, and catalog.h is made beside the makefile. What a graph is made of is seen to: NAME.dag.d
# lists it, and a newer dagc makes all anew.
# SPDX-License-Identifier: MIT
DAGC_PREFIX := $(patsubst %/share/dagc/,%,$(dir $(abspath $(lastword $(MAKEFILE_LIST)))))
DAGC        ?= $(DAGC_PREFIX)/bin/dagc
DAGC_CATALOG ?= $(shell sed -n 's/^[ 	]*catalog[ 	]*"\([^"]*\)".*/\1/p' *.dag 2>/dev/null | sed 1q)
DAGC_CFLAGS  = $(if $(DAGC_CATALOG),-I. $(addprefix -I,$(patsubst %/,%,$(dir $(DAGC_CATALOG))))) -I$(DAGC_PREFIX)/include/dagc -ffp-contract=off -fno-math-errno -fno-trapping-math
DAGC_LIBS    = -lm
DAGC_FILE   := $(shell command -v $(firstword $(DAGC)))
DAGC_TEXT   := $(if $(DAGC_CXX),cpp,c)
DAGC_GOAL   := $(.DEFAULT_GOAL)

%.$(DAGC_TEXT) %.h: %.dag $(DAGC_FILE)
	$(DAGC) $(DAGCFLAGS) $(if $(DAGC_CATALOG),--catalog $(DAGC_CATALOG)) -o $*.$(DAGC_TEXT) --header $*.h --depfile $*.dag.d $<
.PRECIOUS: %.$(DAGC_TEXT) %.h

ifneq ($(DAGC_CATALOG),)
catalog.h: $(DAGC_CATALOG) $(DAGC_FILE)
	$(DAGC) --emit=catalog-h -o $@ --depfile catalog.dag.d $<
# net.h is the runtime, if there is one of that name, and not made of net.dag.
$(DAGC_CATALOG:.dag=.h) $(DAGC_CATALOG:.dag=.$(DAGC_TEXT)): ;
# Whatever includes a graph's header needs it.
DAGC_GRAPHS := $(filter-out $(DAGC_CATALOG:.dag=),$(patsubst ./%.dag,%,$(shell find . -name '*.dag')))
$(addsuffix .h,$(DAGC_GRAPHS)) $(addsuffix .$(DAGC_TEXT),$(DAGC_GRAPHS)): | catalog.h
endif

# What those files say is no goal of the makefile's.
-include $(shell find . -name '*.dag.d')
.DEFAULT_GOAL := $(DAGC_GOAL)
