/* Text typed into the monitor's filter, applied to the vehicles of a small world. */
#include "tests/fuzz/support.h"

#include "clients/monitor/vehicle_table.h"
#include "world/runtime/check.h"

#include <stdlib.h>
#include <string.h>

#define VEHICLES 6u

static struct world_mirror mirror;
static jolon_Entity entities[VEHICLES];

/* One vehicle in each state, with the extreme values of the columns. */
static void begin(void)
{
    for (uint32_t i = 0; i < VEHICLES; i++)
        entities[i] =
            (jolon_Entity){.id = i == 0 ? UINT32_MAX : i,
                           .kind = (uint16_t)i,
                           .force = (jolon_Force)(i % 3),
                           .behaviour = i == 5 ? jolon_BEHAVIOUR_FLIGHT : jolon_BEHAVIOUR_IDLE,
                           .x_m = 10000.0 * i,
                           .vx_mps = (float)i,
                           .fuel_l = -(float)i};
    mirror.has_batch = true;
    mirror.batch.entity = entities;
    mirror.batch.count = VEHICLES;
}

/* A row that is shown must match each word of the filter alone. */
static void check_words(const char *filter)
{
    char word[VEHICLE_TABLE_FILTER_MAX];
    for (uint32_t i = 0; i < VEHICLES; i++) {
        if (!vehicle_table_matches(&mirror, &entities[i], filter))
            continue;
        for (const char *at = filter + strspn(filter, " "); *at != '\0';
             at += strcspn(at, " "), at += strspn(at, " ")) {
            size_t length = strcspn(at, " ");
            CHECK(length < sizeof word);
            if (entities[i].behaviour == jolon_BEHAVIOUR_FLIGHT)
                continue;
            memcpy(word, at, length);
            word[length] = '\0';
            CHECK(vehicle_table_matches(&mirror, &entities[i], word));
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct vehicle_table table;
    if (!mirror.has_batch)
        begin();
    char *filter = malloc(size + 1);
    CHECK(filter);
    memcpy(filter, data, size);
    filter[size] = '\0';
    enum vehicle_table_column sort = (enum vehicle_table_column)(size % VEHICLE_TABLE_COLUMNS);
    CHECK(vehicle_table_build(&table, &mirror, filter, sort, size & 1));
    CHECK(table.count <= VEHICLES);
    for (uint32_t i = 0; i < table.count; i++)
        CHECK(table.row[i] < VEHICLES &&
              vehicle_table_matches(&mirror, &entities[table.row[i]], filter));
    check_words(filter);
    free(filter);
    return 0;
}
