/* Reads command lines by getopt_long(). */
#include "ipc/process/option_table.h"

#include "ipc/process/log.h"
#include "world/runtime/check.h"
#include "world/runtime/parse_number.h"

#include <ctype.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROWS_MAX    64
#define FIRST_VALUE 256 /* getopt's value of the first long option; letters are smaller */
#define HELP_COLUMN 25
#define HELP_WIDTH  80

/* The table in the form that getopt_long() needs. */
struct parser {
    const struct option_row *row[ROWS_MAX + 1]; /* ends with NULL, and option with a zero entry */
    struct option option[ROWS_MAX + 1];
    char letters[2 * ROWS_MAX + 3];
    int count;
};

static const struct option_row help_row = {"help", NULL, NULL, .letter = 'h'};

/* --- options -----------------------------------------------------------------------------------*/

static void add_row(struct parser *parser, const struct option_row *row)
{
    size_t used = strlen(parser->letters);
    CHECK(parser->count < ROWS_MAX);
    parser->row[parser->count] = row;
    parser->option[parser->count] =
        (struct option){.name = row->name,
                        .has_arg = row->argument ? required_argument : no_argument,
                        .val = FIRST_VALUE + parser->count};
    parser->count++;
    if (row->letter)
        (void)snprintf(parser->letters + used, sizeof parser->letters - used, "%c%s", row->letter,
                       row->argument ? ":" : "");
}

/* order: "+" makes getopt stop at the first argument that is no option, "" does not. */
static void parser_begin(struct parser *parser, const struct option_table *table, const char *order)
{
    *parser = (struct parser){.count = 0};
    (void)snprintf(parser->letters, sizeof parser->letters, "%s:", order);
    for (const struct option_row *row = table->rows; row->name; row++)
        add_row(parser, row);
    for (const struct option_row *row = table->more; row && row->name; row++)
        add_row(parser, row);
    if (table->usage)
        add_row(parser, &help_row);
    optind = 0; /* makes getopt begin anew */
    opterr = 0; /* getopt prints nothing */
}

/* Returns the row of the value that getopt returned, NULL when there is none. */
static const struct option_row *find_row(const struct parser *parser, int value)
{
    int i = 0;
    while (parser->row[i] && value != FIRST_VALUE + i &&
           (value == 0 || value != parser->row[i]->letter))
        i++;
    return parser->row[i];
}

/* --- values ------------------------------------------------------------------------------------*/

static int take_whole(const struct option_row *row, const char *text, struct error_text *error)
{
    uint64_t value;
    if (!parse_whole(text, row->least, row->most, &value))
        return error_text_set(error, "must be a whole number from %llu to %llu",
                              (unsigned long long)row->least, (unsigned long long)row->most);
    if (row->integer)
        *row->integer = (int)value;
    else if (row->u32)
        *row->u32 = (uint32_t)value;
    else
        *row->u64 = value;
    return 0;
}

static int take_size(const struct option_row *row, const char *text, struct error_text *error)
{
    struct option_size size;
    int used = 0;
    if (sscanf(text, "%5ux%5u%n", &size.width, &size.height, &used) != 2 || text[used] != '\0' ||
        size.width < row->least || size.width > row->most || size.height < row->least ||
        size.height > row->most)
        return error_text_set(error, "not WxH with each from %llu to %llu, as 1280x720",
                              (unsigned long long)row->least, (unsigned long long)row->most);
    *row->size = size;
    return 0;
}

static int take_choice(const struct option_row *row, const char *text, struct error_text *error)
{
    char words[160] = "";
    int place = (int)row->least;
    for (const char *word = row->argument; word; place++) {
        size_t length = strcspn(word, "|"), used = strlen(words);
        if (strlen(text) == length && strncmp(word, text, length) == 0) {
            *row->choice = place;
            return 0;
        }
        (void)snprintf(words + used, sizeof words - used, "%s%.*s", used ? ", " : "", (int)length,
                       word);
        word = word[length] ? word + length + 1 : NULL;
    }
    return error_text_set(error, "not one of %s", words);
}

static int take_value(const struct option_row *row, const char *value, struct error_text *error)
{
    if (row->flag)
        *row->flag = true;
    if (row->text)
        *row->text = row->argument ? value : row->name;
    if (row->choice && take_choice(row, value, error) != 0)
        return -1;
    if ((row->integer || row->u32 || row->u64) && take_whole(row, value, error) != 0)
        return -1;
    if (row->size && take_size(row, value, error) != 0)
        return -1;
    if (row->real && !parse_real(value, row->low, row->high, row->real))
        return error_text_set(error, "must be a number from %g to %g", row->low, row->high);
    return row->take ? row->take(value, error) : 0;
}

/* --- help --------------------------------------------------------------------------------------*/

static void show_row(const struct option_row *row)
{
    const char *text = row->help;
    int room = HELP_WIDTH - HELP_COLUMN;
    char letter[] = "-?, ";
    letter[1] = row->letter;
    int used = printf("  %s--%s%s%s", row->letter ? letter : "", row->name,
                      row->argument ? " " : "", row->argument ? row->argument : "");
    if (used > HELP_COLUMN - 2) {
        printf("\n");
        used = 0;
    }
    printf("%*s", HELP_COLUMN - used, "");
    while (strlen(text) > (size_t)room) {
        int end = room;
        while (text[end] != ' ')
            end--;
        printf("%.*s\n%*s", end, text, HELP_COLUMN, "");
        text += end + 1;
    }
    printf("%s\n", text);
}

static void show_help(const struct option_table *table)
{
    printf("usage: %s %s\n", table->program, table->usage);
    for (const struct option_row *row = table->rows; row->name; row++) {
        if (row->help)
            show_row(row);
    }
    printf("%s", table->ending ? table->ending : "");
}

/* --- reading -----------------------------------------------------------------------------------*/

/* word is the argument that getopt refused. optopt is the letter or value of its option, or 0. */
static int refuse(const struct option_table *table, const struct parser *parser, int result,
                  const char *word, struct error_text *error)
{
    const struct option_row *row = find_row(parser, optopt);
    const char *wrong = "no such option";
    char letter[] = "-?";
    int alike = 0;
    if (row)
        wrong = result == ':' ? "its value is missing" : "takes no value";
    else if (optopt) {
        letter[1] = (char)optopt;
        word = letter;
    } else {
        for (int i = 0; parser->row[i]; i++)
            alike += strncmp(parser->row[i]->name, word + 2, strcspn(word + 2, "=")) == 0;
        if (alike > 1)
            wrong = "the beginning of several options";
    }
    return error_text_set(error, "%.200s: %s; see %s --help", word, wrong, table->program);
}

static bool usage_names(const char *usage, const char *name)
{
    char word[64];
    size_t length = (size_t)snprintf(word, sizeof word, "--%s", name);
    for (const char *at = strstr(usage, word); at; at = strstr(at + 1, word)) {
        if (at[length] != '-' && !isalnum((unsigned char)at[length]))
            return true;
    }
    return false;
}

int option_table_try(const struct option_table *table, int argc, char **argv,
                     struct error_text *error)
{
    struct parser parser;
    struct error_text wrong;
    int result;
    parser_begin(&parser, table, "");
    while ((result = getopt_long(argc, argv, parser.letters, parser.option, NULL)) != -1) {
        const struct option_row *row = find_row(&parser, result);
        if (!row)
            return refuse(table, &parser, result, argv[optind - 1], error);
        if (row == &help_row) {
            show_help(table);
            exit(EXIT_OK);
        }
        if (table->usage_rows && !usage_names(table->usage, row->name))
            return error_text_set(error, "--%s: %s does not take it; see %s --help", row->name,
                                  table->program, table->program);
        const char *value = optarg ? optarg : "";
        if (take_value(row, value, &wrong) != 0)
            return error_text_set(error, "--%s %.200s: %s", row->name, value, wrong.text);
    }
    if (argc - optind > table->plain)
        return error_text_set(error, "'%.200s': one argument too many; see %s --help",
                              argv[optind + table->plain], table->program);
    return argc - optind;
}

int option_table_read(const struct option_table *table, int argc, char **argv)
{
    struct error_text error;
    int plain = option_table_try(table, argc, argv, &error);
    if (plain < 0)
        die_usage("%s", error.text);
    return plain;
}

int option_table_verb(const struct option_table *table, int argc, char **argv)
{
    struct parser parser;
    parser_begin(&parser, table, "+");
    while (getopt_long(argc, argv, parser.letters, parser.option, NULL) != -1)
        continue;
    return optind;
}
