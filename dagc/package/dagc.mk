# dagc.mk - how make gets NAME.c and NAME.h from NAME.dag. In a makefile:
#
#   include $(shell pkg-config --variable=makefragment dagc)
#   CFLAGS += $(DAGC_CFLAGS)
#   program: main.o graph.o
#   	$(CC) -o $@ $^ $(DAGC_LIBS)
#   main.o: graph.h
#
# DAGCFLAGS are options for dagc, e.g. -Werror. Imported files are seen to: NAME.dag.d lists them.
# SPDX-License-Identifier: MIT
DAGC_PREFIX := $(patsubst %/share/dagc/,%,$(dir $(abspath $(lastword $(MAKEFILE_LIST)))))
DAGC        ?= $(DAGC_PREFIX)/bin/dagc
DAGC_CFLAGS  = -I$(DAGC_PREFIX)/include/dagc -ffp-contract=off
DAGC_LIBS    = -lm

%.c %.h: %.dag
	$(DAGC) $(DAGCFLAGS) -o $*.c --header $*.h --depfile $*.dag.d $<
.PRECIOUS: %.c %.h

# What those files say is no goal of the makefile's.
DAGC_GOAL := $(.DEFAULT_GOAL)
-include $(wildcard *.dag.d)
.DEFAULT_GOAL := $(DAGC_GOAL)
