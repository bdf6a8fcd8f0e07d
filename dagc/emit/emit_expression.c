/* emit_expression.c - computed arguments in C.
 *
 * Terms and externs are read first, into constants, in the order of evaluation: reading a term may
 * compute it, and C leaves open which operand of + comes first; so are arguments of one call of
 * which several may be no number, as the discussion is told of the first. What is left is
 * arithmetic in double with the source's association. min and max are functions, so that each
 * operand stands once, and facts are functions of the discussion, so that a catalog's C text needs
 * no rewriting.
 * SPDX-License-Identifier: MIT */
#include "analyse/shared.h"
#include "emit/emit.h"

static int precedence(enum expression_kind kind)
{
    switch (kind) {
    case EXPRESSION_ADD:
    case EXPRESSION_SUBTRACT:
        return 1;
    case EXPRESSION_MULTIPLY:
    case EXPRESSION_DIVIDE:
        return 2;
    case EXPRESSION_NEGATE:
        return 3;
    default:
        return 4;
    }
}

/* `at` is the discussion's address, as the text around has it. Prints e where an operator of
 * precedence `around` stands; *value counts the constants. */
static void print(const struct dag *dag, struct text *out, int expression, int around,
                  const char *at, int *value)
{
    static const char *const operators[] = {" + ", " - ", " * ", " / "};
    static const char *const functions[] = {"sqrt(", "fabs("};
    const struct expression *e = &dag->expressions[expression];
    int own = precedence(e->kind), parentheses = own < around;
    dag_print(out, "%s", parentheses ? "(" : "");
    switch (e->kind) {
    case EXPRESSION_NUMBER:
        if (e->number < 0 && around > 0)
            dag_print(out, "(");
        dag_print_number(out, e->number);
        if (e->number < 0 && around > 0)
            dag_print(out, ")");
        break;
    case EXPRESSION_PARAMETER: {
        const struct parameter *parameter = &dag->parameters[e->parameter];
        int integer = dag->types[parameter->type].base == BASE_INTEGER;
        dag_print(out, "%sparameters->%s", integer ? "(double)" : "", parameter->name);
        break;
    }
    case EXPRESSION_FACT:
        dag_print(out, "fact_");
        dag_emit_fact_name(out, &dag->facts[e->index]);
        dag_print(out, "(%s)", at);
        break;
    case EXPRESSION_TERM:
    case EXPRESSION_EXTERN:
        dag_print(out, "value_%d", ++*value);
        break;
    case EXPRESSION_NEGATE:
        dag_print(out, "-");
        print(dag, out, e->left, 4, at, value);
        break;
    case EXPRESSION_SQRT:
    case EXPRESSION_ABS:
        dag_print(out, "%s", functions[e->kind - EXPRESSION_SQRT]);
        print(dag, out, e->left, 0, at, value);
        dag_print(out, ")");
        break;
    case EXPRESSION_MIN:
    case EXPRESSION_MAX:
        dag_print(out, e->kind == EXPRESSION_MIN ? "value_min(" : "value_max(");
        print(dag, out, e->left, 0, at, value);
        dag_print(out, ", ");
        print(dag, out, e->right, 0, at, value);
        dag_print(out, ")");
        break;
    default: /* the operators: left to right, so the right operand binds tighter */
        print(dag, out, e->left, own, at, value);
        dag_print(out, "%s", operators[e->kind - EXPRESSION_ADD]);
        print(dag, out, e->right, own + 1, at, value);
        break;
    }
    dag_print(out, "%s", parentheses ? ")" : "");
}

void dag_emit_fact_name(struct text *out, const struct fact *fact)
{
    for (const char *c = fact->name; *c != '\0'; c++)
        dag_print(out, "%c", *c == '.' ? '_' : *c);
}

void dag_emit_fact_number(const struct dag *dag, struct text *out, int fact)
{
    dag_print(out, "FACT_");
    for (const char *c = dag->facts[fact].name; *c != '\0'; c++) {
        char letter[2] = {*c == '.' ? '_' : *c, '\0'};
        dag_print_upper(out, letter);
    }
}

static int count_values(const struct dag *dag, int expression)
{
    const struct expression *e = &dag->expressions[expression];
    int count = e->kind == EXPRESSION_TERM || e->kind == EXPRESSION_EXTERN;
    if (e->left >= 0)
        count += count_values(dag, e->left);
    return e->right >= 0 ? count + count_values(dag, e->right) : count;
}

static int number_of(const struct dag *dag, const struct argument *argument)
{
    return (int)(argument - dag->arguments);
}

static int is_doubtful(const struct dag *dag, const struct argument *argument,
                       const struct place *place)
{
    return place->inside == NULL ? dag_is_doubtful(dag, argument)
                                 : dag_shared_doubt(place->inside, number_of(dag, argument)) >= 0;
}

/* May more than one of the node's arguments be no number? */
static int has_doubts(const struct dag *dag, const struct node *node, const struct place *place)
{
    int count = 0;
    for (int i = node->arguments.first; i < node->arguments.first + node->arguments.count; i++)
        count += is_doubtful(dag, &dag->arguments[i], place);
    return count > 1;
}

/* Which of a shared function's it is, if its uses differ in it; -1. */
static int given_of(const struct dag *dag, const struct argument *argument,
                    const struct place *place)
{
    return place->inside == NULL ? -1
                                 : dag_shared_argument(place->inside, number_of(dag, argument));
}

static void print_checked(struct dag *dag, struct text *out, const struct node *node,
                          const struct argument *argument, const struct place *place, int *value)
{
    const struct dag_doubt doubt = dag_doubt(dag, node, argument);
    const double numbers[] = {doubt.low, doubt.high, doubt.instead};
    int given = given_of(dag, argument, place);
    dag_print(out, "value_checked(%s, ", place->told);
    if (given >= 0)
        dag_print(out, "argument_%d", given + 1);
    else
        print(dag, out, argument->expression, 0, place->at, value);
    for (int i = 0; i < 3; i++) {
        dag_print(out, ", ");
        dag_print_number(out, numbers[i]);
    }
    if (place->inside != NULL)
        dag_print(out, ", what_%d", dag_shared_doubt(place->inside, number_of(dag, argument)) + 1);
    else {
        dag_print(out, ",\n        ");
        dag_print_string(out, doubt.what);
    }
    dag_print(out, ")");
}

void dag_emit_expression(struct dag *dag, struct text *out, const struct node *node,
                         const struct argument *argument, const struct place *place, int *value)
{
    const struct expression *e = &dag->expressions[argument->expression];
    int integer = dag->types[dag->parameters[argument->parameter].type].base == BASE_INTEGER;
    int given = given_of(dag, argument, place), doubtful = is_doubtful(dag, argument, place);
    if (given >= 0 && !doubtful)
        dag_print(out, "argument_%d", given + 1);
    else if (e->kind == EXPRESSION_PARAMETER && !doubtful)
        dag_print(out, "parameters->%s", dag->parameters[e->parameter].name);
    else if (integer && e->kind == EXPRESSION_NUMBER && !doubtful)
        dag_print_integer(out, e->number);
    else {
        dag_print(out, "%s", integer ? "(int)(" : "");
        if (!doubtful)
            print(dag, out, argument->expression, 0, place->at, value);
        else if (!has_doubts(dag, node, place))
            print_checked(dag, out, node, argument, place, value);
        else {
            dag_print(out, "checked_%d", number_of(dag, argument) - node->arguments.first + 1);
            *value += count_values(dag, argument->expression);
        }
        dag_print(out, "%s", integer ? ")" : "");
    }
}

/* What a use gives its function: of a doubtful one the bare number, the function looks at it. */
void dag_emit_shared_argument(struct dag *dag, struct text *out, const struct argument *argument,
                              const char *at, int doubtful)
{
    const struct place place = {at, NULL, NULL};
    int value = 0;
    if (doubtful)
        print(dag, out, argument->expression, 0, at, &value);
    else
        dag_emit_expression(dag, out, NULL, argument, &place, &value);
}

/* term_NAME(&d, NAME_LEVEL), or term_NAME(&d) for a term without levels */
static void print_term(const struct dag *dag, struct text *out, int term, int level, const char *at)
{
    const struct term *t = &dag->terms[term];
    dag_print(out, "term_%s(%s", t->name, at);
    if (t->levels.count > 0) {
        dag_print(out, ", ");
        dag_print_constant(out, t->name, dag->levels[t->levels.first + level - 1].name);
    }
    dag_print(out, ")");
}

static void print_reads(const struct dag *dag, struct text *out, int expression, const char *at,
                        int *value)
{
    const struct expression *e = &dag->expressions[expression];
    if (e->kind == EXPRESSION_TERM) {
        dag_print(out, "    const double value_%d = ", ++*value);
        print_term(dag, out, e->index, e->level, at);
        dag_print(out, ";\n");
    } else if (e->kind == EXPRESSION_EXTERN) {
        const struct callback *callback = &dag->callbacks[e->index];
        struct span reads = callback->reads;
        for (int i = reads.first; i < reads.first + reads.count; i++) {
            dag_print(out, "    (void)");
            print_term(dag, out, dag->needs[i].term, dag->needs[i].level, at);
            dag_print(out, ";\n");
        }
        dag_print(out, "    const double value_%d = %s(%s);\n", ++*value, callback->name, at);
    }
    if (e->left >= 0)
        print_reads(dag, out, e->left, at, value);
    if (e->right >= 0)
        print_reads(dag, out, e->right, at, value);
}

void dag_emit_reads(struct dag *dag, struct text *out, const struct node *node,
                    const struct place *place)
{
    const struct argument *arguments = &dag->arguments[node->arguments.first];
    int value = 0;
    for (int i = 0; i < node->arguments.count; i++)
        print_reads(dag, out, arguments[i].expression, place->at, &value);
    value = 0;
    for (int i = 0; has_doubts(dag, node, place) && i < node->arguments.count; i++) {
        if (!is_doubtful(dag, &arguments[i], place)) {
            value += count_values(dag, arguments[i].expression);
            continue;
        }
        dag_print(out, "    const double checked_%d = ", i + 1);
        print_checked(dag, out, node, &arguments[i], place, &value);
        dag_print(out, ";\n");
    }
}

int dag_has_reads(const struct dag *dag, const struct node *node, const struct place *place)
{
    for (int i = node->arguments.first; i < node->arguments.first + node->arguments.count; i++)
        if (count_values(dag, dag->arguments[i].expression) > 0)
            return 1;
    return has_doubts(dag, node, place);
}

/* ---- what the expressions of all reached nodes call */

static void reach(const struct dag *dag, struct dag_reached *reached, int expression)
{
    const struct expression *e = &dag->expressions[expression];
    if (e->kind == EXPRESSION_FACT)
        reached->facts[e->index] = 1;
    else if (e->kind == EXPRESSION_EXTERN)
        reached->callbacks[e->index] = 1;
    reached->minimum |= e->kind == EXPRESSION_MIN;
    reached->maximum |= e->kind == EXPRESSION_MAX;
    reached->arithmetic |= e->left >= 0;
    if (e->left >= 0)
        reach(dag, reached, e->left);
    if (e->right >= 0)
        reach(dag, reached, e->right);
}

int dag_emit_has_doubts(const struct dag *dag)
{
    for (int i = 0; i < dag->order_count; i++) {
        const struct span arguments = dag->nodes[dag->order[i]].arguments;
        for (int a = arguments.first; a < arguments.first + arguments.count; a++)
            if (dag_is_doubtful(dag, &dag->arguments[a]))
                return 1;
    }
    return 0;
}

struct dag_reached dag_emit_reached(struct dag *dag)
{
    struct dag_reached reached = {0};
    reached.facts = dag_alloc(&dag->arena, (size_t)dag->fact_count);
    reached.callbacks = dag_alloc(&dag->arena, (size_t)dag->callback_count);
    reached.terms = dag_alloc(&dag->arena, (size_t)dag->term_count);
    for (int i = 0; i < dag->order_count; i++) {
        const struct node *node = &dag->nodes[dag->order[i]];
        for (int a = node->arguments.first; a < node->arguments.first + node->arguments.count; a++)
            reach(dag, &reached, dag->arguments[a].expression);
        for (int r = node->reads.first; r < node->reads.first + node->reads.count; r++)
            reached.terms[dag->needs[r].term] = 1;
    }
    return reached;
}

void dag_emit_externs(struct dag *dag, struct text *out)
{
    struct dag_reached reached = dag_emit_reached(dag);
    for (int i = 0; i < dag->callback_count; i++) {
        const struct callback *callback = &dag->callbacks[i];
        if (!reached.callbacks[i])
            continue;
        dag_print(out, "\n/* Yours to define");
        if (*callback->doc != '\0') {
            dag_print(out, ": ");
            dag_print_comment(out, callback->doc);
        }
        dag_print(out, " */\ndouble %s(const struct discussion *d);\n", callback->name);
    }
}

int dag_emit_extern_calls(struct dag *dag, struct text *out)
{
    struct dag_reached reached = dag_emit_reached(dag);
    int count = 0;
    dag_print(out, "#include \"%s\"\n", dag->runtime_header);
    for (int i = 0; i < dag->callback_count; i++) {
        const char *name = dag->callbacks[i].name;
        if (!reached.callbacks[i])
            continue;
        count++;
        dag_print(out,
                  "\ndouble (*extern_%s)(const struct discussion *d);\n"
                  "double %s(const struct discussion *d);\n"
                  "double %s(const struct discussion *d)\n{\n    return extern_%s(d);\n}\n",
                  name, name, name, name);
    }
    return count;
}

void dag_emit_accessors(struct dag *dag, struct text *out)
{
    struct dag_reached reached = dag_emit_reached(dag);
    for (int i = 0; i < dag->term_count; i++)
        if (reached.terms[i])
            dag_print(out, "#include \"%s\"\n", dag->terms[i].header);
    if (reached.arithmetic) /* a * b + c must round twice, as in the interpreter; gcc has a flag */
        dag_print(out, "\n#ifdef __clang__\n#pragma STDC FP_CONTRACT OFF\n#endif\n");
    if (reached.minimum)
        dag_print(out,
                  "\nstatic inline double value_min(double a, double b)\n{\n"
                  "    return a < b || a != a || (a == b && 1 / a < 0) ? a : b; /* -0 < 0; none of "
                  "no number */\n}\n");
    if (reached.maximum)
        dag_print(out,
                  "\nstatic inline double value_max(double a, double b)\n{\n"
                  "    return a > b || a != a || (a == b && 1 / a > 0) ? a : b; /* 0 > -0; none of "
                  "no number */\n}\n");
    if (dag_emit_has_doubts(dag))
        dag_print(
            out,
            "\n/* An argument that may be no number, as 0 / 0: the discussion keeps which. */\n"
            "static inline double value_checked(struct discussion *d, double value, double low,\n"
            "    double high, double instead, const char *what)\n{\n"
            "    if (value >= low && value <= high)\n        return value;\n"
            "    if (d->terms.no_number == NULL)\n        d->terms.no_number = what;\n"
            "    return instead;\n}\n");
    for (int i = 0; i < dag->fact_count; i++)
        if (reached.facts[i]) {
            dag_print(out, "\nstatic inline ");
            dag_emit_fact(dag, out, i);
        }
}

void dag_emit_fact(const struct dag *dag, struct text *out, int fact)
{
    dag_print(out, "double fact_");
    dag_emit_fact_name(out, &dag->facts[fact]);
    dag_print(out, "(const struct discussion *d)\n{\n    return %s;\n}\n", dag->facts[fact].c);
}
