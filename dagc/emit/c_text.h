/* c_text.h - C text as tokens, and the names that it defines.
 * SPDX-License-Identifier: MIT */
#ifndef C_TEXT_H
#define C_TEXT_H

#include "base/internal.h"

enum c_kind { C_SPACE, C_COMMENT, C_NAME, C_NUMBER, C_LITERAL, C_DIRECTIVE, C_MARK };

/* A directive is one token, up to the end of its (continued) line. */
struct c_token {
    enum c_kind kind;
    const char *text;
    size_t length;
    unsigned char member; /* a name: of a field, where that is declared or used */
};

struct c_tokens {
    struct c_token *items; /* in the arena; all of the text, blanks included */
    int count;
};

struct c_tokens dag_c_tokens(struct dag *dag, const char *text, size_t length);

int dag_c_is(const struct c_token *token, const char *word);
/* What a directive says after `#` and blanks, if it is `word`; else NULL. */
const char *dag_c_directive(const struct c_token *token, const char *word);
const char *dag_c_copy_name(struct dag *dag, const char *text); /* the name that it begins with */
const char *dag_c_upper(struct dag *dag, const char *name);     /* it in capitals */

/* What texts define at file scope, beyond doubt: what is left out keeps its name. */
struct c_names {
    struct table tags;     /* of structures, unions and enumerations that have a body */
    struct table ordinary; /* functions with a body, types, enumerators, initialised objects */
    struct table macros;
    struct table expanded; /* names that stand anywhere but in #define, #undef and conditions */
};
void dag_c_collect(struct dag *dag, struct c_names *names, const struct c_tokens *tokens);

/* Prints a token; where it is, or holds, a name of `names`, that gets the prefix: p_name, P_NAME.
 * `before` is the last token that is no blank; NULL: none. */
void dag_c_print(struct dag *dag, struct text *out, const struct c_token *token,
                 const struct c_token *before, const struct c_names *names, const char *prefix);

#endif
