/* option_table.h - every option of `radiosity` is one row, every command another: the parser,
 * --help, the man page and the tests derive from them.
 * SPDX-License-Identifier: MIT */
#ifndef OPTION_TABLE_H
#define OPTION_TABLE_H

#include "options/options.h"

struct command_row {
    const char *name, *argument; /* one word or two; what follows, or "" */
    const char *help;            /* one line, for the list of commands */
    const char *lesson;          /* the lines before its options */
    const char *example;         /* the line behind them */
};
extern const struct command_row command_rows[COMMANDS];

struct option_row {
    const char *name;     /* without dashes; of one letter: it has one dash, else two */
    const char *argument; /* NULL: none; "[=VALUE]": may be left out, then `read` gets NULL */
    /* those that take it: bits 1 << enum command. A name may have a row for each */
    unsigned commands;
    const char *preset; /* its value when it is not given; NULL: none */
    const char *help;   /* one line, without the preset, which is appended */
    /* what values it takes, for messages; NULL: its words or the argument say it */
    const char *takes;

    /* Store what `value` says. Returns 0, or -1 when the option does not take that. */
    int (*read)(struct options *o, const struct option_row *row, const char *value);
    size_t field;             /* in struct options, of a reader that serves many options */
    int low, high;            /* of read_whole */
    const char *const *words; /* to choose from, or endings of a file's name; NULL-terminated */
    int rare;                 /* 1: only --help=all shows it */
    int output;               /* 1: its value names a file that is written */
    int standard;             /* 1: which may be -, standard output */
};
extern const struct option_row option_rows[];
extern const int option_row_count;

/* "LOW:HIGH", numbers with 0 < LOW <= HIGH. Returns 0, or -1. */
int option_range(const char *text, double *low, double *high);

/* What values it takes, in words. Good until the next call. */
const char *option_takes(const struct option_row *row);

#endif
