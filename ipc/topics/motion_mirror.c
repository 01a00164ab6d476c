/* Follows the batches of motions. */
#include "ipc/topics/motion_mirror.h"

#include "ipc/topics/entity_place.h"
#include "ipc/topics/samples.h"

#include <stdlib.h>
#include <string.h>

void motion_mirror_close(struct motion_mirror *mirror)
{
    free(mirror->row);
    *mirror = (struct motion_mirror){0};
}

void motion_mirrors_close(struct motion_mirrors *mirrors)
{
    for (uint32_t i = 0; i < MOTION_MIRRORS; i++)
        motion_mirror_close(&mirrors->of[i]);
}

struct motion_mirror *motion_mirrors_for(struct motion_mirrors *mirrors, uint64_t writer)
{
    struct motion_mirror *mirror = &mirrors->of[0];
    for (uint32_t i = 0; i < MOTION_MIRRORS && mirror->writer != writer; i++) {
        if (mirrors->of[i].writer == writer || mirrors->of[i].taken < mirror->taken)
            mirror = &mirrors->of[i];
    }
    if (mirror->writer != writer)
        motion_mirror_close(mirror);
    mirror->writer = writer;
    mirror->taken = ++mirrors->taken;
    return mirror;
}

/* Makes room for rows below this one. Returns false without memory. */
static bool grow(struct motion_mirror *mirror, uint32_t rows)
{
    if (rows <= mirror->room)
        return true;
    uint32_t room = rows > 2 * mirror->room ? rows : 2 * mirror->room;
    struct motion_mirror_row *row = realloc(mirror->row, room * sizeof *row);
    if (!row)
        return false;
    memset(row + mirror->room, 0, (room - mirror->room) * sizeof *row);
    mirror->row = row;
    mirror->room = room;
    return true;
}

static bool is_empty(const struct motion_mirror *mirror, uint32_t row)
{
    return mirror->row[row].entity.state == jolon_ENTITY_FREE;
}

/* At the end of a whole batch: empties the rows that are in no part of it. */
static void drop_others(struct motion_mirror *mirror)
{
    for (uint32_t row = 0; row < mirror->used; row++) {
        if (is_empty(mirror, row) || mirror->row[row].whole == mirror->whole)
            continue;
        mirror->row[row].entity.state = jolon_ENTITY_FREE;
        mirror->count--;
    }
    mirror->known = true;
}

static void put(struct motion_mirror *mirror, const jolon_MotionBatch *batch, uint32_t i,
                const jolon_Course *course)
{
    uint32_t row = batch->rows._buffer[i];
    bool was_empty = is_empty(mirror, row);
    mirror->row[row] = (struct motion_mirror_row){
        .entity = batch->entities._buffer[i], .told_s = batch->sim_time_s, .whole = mirror->whole};
    if (course)
        mirror->row[row].course = *course;
    mirror->used = row < mirror->used ? mirror->used : row + 1;
    mirror->count += (uint32_t)was_empty - (uint32_t)is_empty(mirror, row);
}

bool motion_mirror_take(struct motion_mirror *mirror, const jolon_MotionBatch *batch)
{
    uint32_t count = batch->entities._length, next = 0;
    if (mirror->run != batch->run) { /* another world */
        mirror->run = batch->run;
        mirror->whole++;
        drop_others(mirror);
        mirror->known = false;
        mirror->whole_parts = 0;
    }
    if (count && !grow(mirror, batch->rows._buffer[count - 1] + 1))
        return false; /* the next whole batch tries again */
    if (batch->whole && batch->part == 0) {
        mirror->whole++;
        mirror->whole_parts = batch->parts;
    }
    for (uint32_t i = 0; i < count; i++) {
        bool has_course = next < batch->courses._length && batch->courses._buffer[next].entity == i;
        put(mirror, batch, i, has_course ? &batch->courses._buffer[next++] : NULL);
    }
    mirror->frame = batch->frame;
    mirror->time_s = batch->sim_time_s;
    if (batch->whole && mirror->whole_parts > 0 && --mirror->whole_parts == 0)
        drop_others(mirror);
    return mirror->known && batch->part + 1 == batch->parts;
}

/* Returns false for places and velocities that no world has, and that readers need not expect: a
 * false writer may tell speeds that lead there. */
static bool is_sane(const struct told_motion *motion)
{
    const double numbers[] = {motion->at.x,        motion->at.y,       motion->at.z,
                              motion->velocity.x,  motion->velocity.y, motion->velocity.z,
                              motion->heading_rad, motion->pitch_rad,  motion->roll_rad};
    bool sane = true;
    for (size_t i = 0; sane && i < sizeof numbers / sizeof numbers[0]; i++)
        sane = samples_number(numbers[i]);
    return sane;
}

/* Returns where the entity of a row is now. */
static jolon_Entity entity_at(const struct motion_mirror_row *row, double time_s)
{
    jolon_Entity entity = row->entity;
    const double after_s = time_s - row->told_s;
    if (!(after_s > 0.0))
        return entity;
    const struct told_motion told = {
        .at = {entity.x_m, entity.y_m, entity.z_m},
        .velocity = {(double)entity.vx_mps, (double)entity.vy_mps, (double)entity.vz_mps},
        .heading_rad = (double)entity.heading_rad,
        .pitch_rad = (double)entity.pitch_rad,
        .roll_rad = (double)entity.roll_rad,
        .turn_rps = row->course.turn_rps,
        .pitch_rps = row->course.pitch_rps,
        .roll_rps = row->course.roll_rps,
        .gain_mps2 = row->course.gain_mps2,
        .climb_mps2 = row->course.climb_mps2,
        .lasts_s = row->course.lasts_s};
    struct told_motion now = told_motion_at(&told, after_s);
    if (!is_sane(&now))
        return entity;
    entity_place_set(&entity, &now);
    entity.reload_s = (float)maths_max(0.0, (double)entity.reload_s - after_s);
    return entity;
}

void motion_mirror_entities(const struct motion_mirror *mirror, jolon_Entity *entity)
{
    uint32_t count = 0;
    for (uint32_t row = 0; row < mirror->used; row++) {
        if (!is_empty(mirror, row))
            entity[count++] = entity_at(&mirror->row[row], mirror->time_s);
    }
}
