/* The books of the crash points. */
#include "tests/crash/ledger.h"

#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static struct ledger_point *find(struct ledger *ledger, const char *role, const char *name)
{
    for (int i = 0; i < ledger->count; i++) {
        struct ledger_point *point = &ledger->point[i];
        if (strcmp(point->role, role) == 0 && strcmp(point->name, name) == 0)
            return point;
    }
    return NULL;
}

struct ledger_point *ledger_point(struct ledger *ledger, const char *role, const char *name)
{
    struct ledger_point *point = find(ledger, role, name);
    if (point)
        return point;
    assert_true(ledger->count < LEDGER_POINTS_MAX);
    point = &ledger->point[ledger->count++];
    *point = (struct ledger_point){0};
    snprintf(point->role, sizeof point->role, "%s", role);
    snprintf(point->name, sizeof point->name, "%s", name);
    return point;
}

void ledger_read(struct ledger *ledger, const char *path)
{
    char line[256], role[32], name[64];
    uint64_t crossings;
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    ledger->count = 0;
    while (fgets(line, sizeof line, file)) {
        assert_int_equal(sscanf(line, "%31[^\t]\t%63[^\t]\t%" SCNu64, role, name, &crossings), 3);
        if (find(ledger, role, name))
            fail_msg("two crash points of the %s are named \"%s\"", role, name);
        ledger_point(ledger, role, name)->crossings = crossings;
    }
    fclose(file);
}

uint64_t ledger_deaths(const struct ledger *ledger, const char *name)
{
    uint64_t deaths = 0;
    for (int i = 0; i < ledger->count; i++) {
        if (strcmp(ledger->point[i].name, name) == 0)
            deaths += ledger->point[i].deaths;
    }
    return deaths;
}
