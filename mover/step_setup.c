/* The mover's own memory: taken, touched and given back. */
#include "mover/step.h"

#include "mover/motion/ground_pose.h"
#include "mover/weapon/firing_table.h"
#include "world/entity/table_touch.h"
#include "world/params.h"
#include "world/runtime/prefault.h"
#include "world/state.h"
#include "world/world.h"

#include <stdlib.h>

/* Returns the tables of all kinds, or NULL with errno ENOMEM. */
static struct firing_table *make_firing_tables(const struct world *world)
{
    uint32_t count = kind_of_files(world->kinds, world->counts.kinds);
    struct firing_table *tables = calloc(count > 0 ? count : 1, sizeof *tables);
    for (uint32_t i = 0; tables && i < count; i++)
        firing_table_make(&tables[i], &world->kinds[i]);
    return tables;
}

int mover_init(struct mover *mover, const struct world *world, const struct crater *craters,
               struct thread_pool *workers)
{
    *mover = (struct mover){.world = world, .workers = workers};
    mover->terrain_entries =
        calloc(world->params->capacity + GROUND_POSE_AHEAD, sizeof *mover->terrain_entries);
    mover->terrain_entries_ahead =
        calloc(world->params->capacity, sizeof *mover->terrain_entries_ahead);
    mover->firing_tables = make_firing_tables(world);
    mover->asks = calloc(1, written_bytes(world->params->capacity));
    mover->serial = calloc(1, written_bytes(world->params->capacity));
    mover->change = calloc(world->params->capacity, sizeof *mover->change);
    if (mover->asks && mover->serial && mover->change && mover->terrain_entries &&
        mover->terrain_entries_ahead && mover->firing_tables &&
        avoidance_init(&mover->avoidance, world) == 0 &&
        ground_marks_init(&mover->ground_marks, world) == 0 &&
        square_bounds_init(&mover->slopes, &world->terrain.squares, square_bounds_slope,
                           &world->terrain) == 0 &&
        crater_index_init(&mover->craters, &world->terrain.squares, craters) == 0 &&
        resting_rows_init(&mover->resting, world->params->capacity,
                          world->terrain.squares.world_m) == 0 &&
        remote_index_init(&mover->remotes, world->params->capacity, world->params->remotes_max) ==
            0 &&
        neighbour_index_init(&mover->neighbours, world->params->capacity) == 0 &&
        neighbour_lists_init(&mover->neighbour_lists, world->params->capacity) == 0 &&
        line_of_sight_init(&mover->line_of_sight, world, &mover->craters) == 0)
        return 0;
    mover_free(mover);
    return -1;
}

void mover_free(struct mover *mover)
{
    avoidance_free(&mover->avoidance);
    crater_index_free(&mover->craters);
    resting_rows_free(&mover->resting);
    remote_index_free(&mover->remotes);
    neighbour_index_free(&mover->neighbours);
    neighbour_lists_free(&mover->neighbour_lists);
    line_of_sight_free(&mover->line_of_sight);
    ground_marks_free(&mover->ground_marks);
    square_bounds_free(&mover->slopes);
    free(mover->asks);
    free(mover->serial);
    free(mover->change);
    free(mover->firing_tables);
    free(mover->terrain_entries);
    free(mover->terrain_entries_ahead);
}

void mover_touch(const struct mover *mover, const struct moved *moved, const struct state states[2],
                 uint32_t rows)
{
    table_touch(&moved->entities, rows, true);
    table_touch(&states[0].entities, rows, false);
    table_touch(&states[1].entities, rows, false);
    neighbour_index_touch(&mover->neighbours, rows);
    neighbour_lists_touch(&mover->neighbour_lists, rows);
    remote_index_touch(&mover->remotes);
    prefault_own(mover->terrain_entries, rows * sizeof *mover->terrain_entries);
    prefault_own(mover->terrain_entries_ahead, rows * sizeof *mover->terrain_entries_ahead);
}
