/* Counts of crash points. */
#include "tests/crash/point_counts.h"

#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static struct point_count *find(struct point_counts *counts, const char *role, const char *name)
{
    for (int i = 0; i < counts->count; i++) {
        struct point_count *point = &counts->point[i];
        if (strcmp(point->role, role) == 0 && strcmp(point->name, name) == 0)
            return point;
    }
    return NULL;
}

struct point_count *point_counts_find(struct point_counts *counts, const char *role,
                                      const char *name)
{
    struct point_count *point = find(counts, role, name);
    if (point)
        return point;
    assert_true(counts->count < POINT_COUNTS_MAX);
    point = &counts->point[counts->count++];
    *point = (struct point_count){0};
    snprintf(point->role, sizeof point->role, "%s", role);
    snprintf(point->name, sizeof point->name, "%s", name);
    return point;
}

void point_counts_read(struct point_counts *counts, const char *path)
{
    char line[256], role[32], name[64];
    uint64_t crossings;
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    counts->count = 0;
    while (fgets(line, sizeof line, file)) {
        assert_int_equal(sscanf(line, "%31[^\t]\t%63[^\t]\t%" SCNu64, role, name, &crossings), 3);
        if (find(counts, role, name))
            fail_msg("two crash points of the %s have the name \"%s\"", role, name);
        point_counts_find(counts, role, name)->crossings = crossings;
    }
    fclose(file);
}

uint64_t point_counts_deaths(const struct point_counts *counts, const char *name)
{
    uint64_t deaths = 0;
    for (int i = 0; i < counts->count; i++) {
        if (strcmp(counts->point[i].name, name) == 0)
            deaths += counts->point[i].deaths;
    }
    return deaths;
}
