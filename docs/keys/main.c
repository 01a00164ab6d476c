/* Makes the tables of a document anew: keys docs/scenario.md */
#include "docs/keys/key_tables.h"

#include <stdlib.h>

#define DOCUMENT_BYTES_MAX (1u << 20)

static int read_document(const char *path, char *text)
{
    FILE *file = fopen(path, "r");

    if (file == NULL)
        return -1;
    text[fread(text, 1, DOCUMENT_BYTES_MAX - 1, file)] = '\0';
    return fclose(file);
}

static int write_document(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");

    if (file == NULL)
        return -1;
    fputs(text, file);
    return fclose(file);
}

int main(int argc, char **argv)
{
    static char before[DOCUMENT_BYTES_MAX], problem[256];
    char *after = NULL;
    size_t bytes = 0;

    if (argc != 2) {
        fprintf(stderr, "usage: keys DOCUMENT\n");
        return 2;
    }
    if (read_document(argv[1], before) != 0) {
        perror(argv[1]);
        return 1;
    }
    FILE *to = open_memstream(&after, &bytes);
    if (to == NULL || key_tables_write(to, before, problem, sizeof(problem)) != 0) {
        fprintf(stderr, "%s: %s\n", argv[1], to == NULL ? "no memory" : problem);
        return 1;
    }
    if (fclose(to) != 0 || write_document(argv[1], after) != 0) {
        perror(argv[1]);
        return 1;
    }
    free(after);
    return 0;
}
