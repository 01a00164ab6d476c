/* Reads WorldInfo and EntityNames once. */
#include "clients/ctl/lookup.h"

#include "ipc/process/clock.h"
#include "ipc/process/process.h"
#include "world/earth_location.h"
#include "world/entity/kind.h"
#include "world/params.h"

#include <stdio.h>
#include <string.h>

static bool open_readers(struct lookup *lookup)
{
    struct error_text error;
    if (names_reader_open(&lookup->names_reader, lookup->link, &error) != 0)
        return false;
    lookup->world = dds_topics_reader(lookup->link, TOPIC_WORLD, &error);
    lookup->reading = true;
    const dds_entity_t readers[] = {lookup->world, lookup->names_reader.reader};
    lookup->waitset = dds_topics_waitset(lookup->link, readers, 2, &error);
    return lookup->world >= 0 && lookup->waitset >= 0;
}

static void add(char *list, size_t bytes, const char *name)
{
    size_t used = strlen(list);
    (void)snprintf(list + used, bytes - used, "%s%s", used ? ", " : "", name);
}

static void add_kind(struct lookup *lookup, const char *name, int domain)
{
    if (domain == DOMAIN_MUNITION)
        add(lookup->munitions, sizeof lookup->munitions, name);
    else if (domain != DOMAIN_FIXED)
        add(lookup->vehicles, sizeof lookup->vehicles, name);
}

static bool read_view(struct lookup *lookup)
{
    const struct world *world = &lookup->view->world;
    lookup->hz = world->params->hz;
    earth_location_frame(&lookup->frame, world->params, world->terrain.squares.world_m);
    for (uint32_t i = 0; i < world->counts.kinds; i++)
        add_kind(lookup, world->kinds[i].name, world->kinds[i].domain);
    lookup->reading = name_table_read_world(&lookup->names, world, lookup->view->header->made);
    return lookup->reading;
}

static void take_world(struct lookup *lookup)
{
    void *sample = NULL;
    dds_sample_info_t info;
    if (dds_take(lookup->world, &sample, &info, 1, 1) <= 0)
        return;
    const jolon_WorldInfo *world = sample;
    if (info.valid_data) {
        lookup->hz = world->hz;
        location_frame_make(&lookup->frame, world->latitude_deg, world->longitude_deg,
                            world->side_m);
        lookup->vehicles[0] = lookup->munitions[0] = '\0';
        for (uint32_t i = 0; i < world->kinds._length; i++) {
            const jolon_KindInfo *kind = &world->kinds._buffer[i];
            add_kind(lookup, kind->name, (int)kind->domain);
        }
    }
    (void)dds_return_loan(lookup->world, &sample, 1);
}

bool lookup_wait(struct lookup *lookup, uint64_t until_ns)
{
    if (lookup->view)
        return lookup->reading || read_view(lookup);
    if (!lookup->reading && !open_readers(lookup))
        return false;
    while (!process_stopping()) {
        take_world(lookup);
        names_reader_take(&lookup->names_reader, &lookup->names);
        uint64_t now_ns = clock_now_ns();
        if (lookup->names.known && lookup->hz > 0.0)
            return true;
        if (now_ns >= until_ns)
            return false;
        dds_topics_wait(lookup->waitset, until_ns - now_ns);
    }
    return false;
}

void lookup_close(struct lookup *lookup)
{
    if (lookup->reading)
        name_table_close(&lookup->names);
}
