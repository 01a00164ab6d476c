/* Command lines. A program declares its options in a table. The reader stores their values, and
 * makes the help and the error texts from the table. getopt_long() has global state, so only one
 * thread may read. */
#ifndef JOLON_IPC_PROCESS_OPTION_TABLE_H
#define JOLON_IPC_PROCESS_OPTION_TABLE_H

#include "world/runtime/error_text.h"

#include <limits.h>
#include <stdbool.h>
#include <stdint.h>

/* [pixel] */
struct option_size {
    uint32_t width, height;
};

/* An option. The pointer that is set determines which kind of value the option takes, and where the
 * value is stored. When the option is repeated, its last value stays. */
struct option_row {
    const char *name;         /* without the two dashes */
    const char *argument;     /* name of its value in the help; NULL: it takes no value */
    const char *help;         /* without newlines, for the reader wraps it; NULL: unlisted */
    bool *flag;               /* true when the option is given */
    const char **text;        /* any text; of an option without a value: the option's name */
    int *choice;              /* argument is "word|word"; set to the word's index + least */
    int *integer;             /* a whole number, least..most */
    uint32_t *u32;            /* a whole number, least..most */
    uint64_t *u64;            /* a whole number, least..most */
    double *real;             /* a number, low..high */
    struct option_size *size; /* WIDTHxHEIGHT, each least..most */
    /* Checks the value, or reads a value of another kind. It is called after the value has been
     * stored. Returns 0, or -1 with the reason in error. The reader puts the option and its value
     * before the reason. */
    int (*take)(const char *value, struct error_text *error);
    uint64_t least, most;
    double low, high;
    char letter; /* its short form, 0: none */
};

struct option_table {
    const char *program; /* with its verb if it has one: "jolon-world info" */
    const char *usage;   /* the help's first lines, after "usage: PROGRAM "; NULL: no --help */
    const char *ending;  /* the help's last lines, NULL: none */
    const struct option_row *rows;
    const struct option_row *more; /* further rows, which the help does not list; NULL: none */
    bool usage_rows;               /* only the options that usage names are taken */
    int plain;                     /* most arguments that are no options */
};

/* clang-format off */
#define OPTION_ROWS_END {.name = NULL} /* ends rows and more */

/* Options that many programs have. o is a struct with the member world, parent or sandbox_off.
 * check becomes take. */
#define OPTION_ROW_WORLD(o, check)                                                                 \
    {"world", "NAME", "the world (default \"default\")", .text = &(o).world, .take = (check),      \
     .letter = 'w'}
#define OPTION_ROW_PARENT(o)                                                                       \
    {"parent", "PID", "end when this process does", .integer = &(o).parent, .least = 1,            \
     .most = INT_MAX}
#define OPTION_ROW_NO_SANDBOX(o)                                                                   \
    {"no-sandbox", NULL, "give up no privileges", .flag = &(o).sandbox_off}
/* clang-format on */

/* Reads a command line; argv[0] is ignored. Moves the arguments that are no options to the end of
 * argv and returns their number. --help prints the help on standard output and ends the process
 * (exit 0). An error ends the process with one line that says what would be right (exit 2). */
int option_table_read(const struct option_table *table, int argc, char **argv);

/* As option_table_read(), but an error does not end the process: the line goes into error, and -1
 * is returned. */
int option_table_try(const struct option_table *table, int argc, char **argv,
                     struct error_text *error);

/* Returns the index in argv of the first argument that is neither an option nor an option's value,
 * or argc when there is none. Values are neither checked nor stored. */
int option_table_verb(const struct option_table *table, int argc, char **argv);

#endif
