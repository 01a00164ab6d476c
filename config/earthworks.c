/* Reads the earthworks and computes their slopes. */
#include "config/earthworks.h"

#include "config/syntax/entry.h"
#include "config/syntax/schema.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/maths/maths.h"
#include "world/terrain/earthwork.h"
#include "world/terrain/gridsquare.h"

#define FREEBOARD_M 0.25 /* from the ground down to the water of a ford */
#define EDGE_SHARE  0.6  /* of the height: an edge of 59 degrees */
#define FORD_GRADE  0.1
#define ROUNDED_M   1e-9 /* more than sums of lengths are rounded by */

#define BIT(key) (1u << (key))

/* The keys of each shape beside those that every shape has. */
static const struct {
    unsigned needed, allowed;
} keys_of[EARTHWORK_SHAPE_COUNT] = {
    [EARTHWORK_RAMP] = {BIT(EARTHWORK_KEY_HEIGHT), BIT(EARTHWORK_KEY_EDGE)},
    [EARTHWORK_TABLE] = {BIT(EARTHWORK_KEY_HEIGHT),
                         BIT(EARTHWORK_KEY_EDGE) | BIT(EARTHWORK_KEY_GRADE)},
    [EARTHWORK_TRENCH] = {BIT(EARTHWORK_KEY_DEPTH),
                          BIT(EARTHWORK_KEY_EDGE) | BIT(EARTHWORK_KEY_GRADE)},
    [EARTHWORK_WASHBOARD] = {BIT(EARTHWORK_KEY_HEIGHT) | BIT(EARTHWORK_KEY_WAVE),
                             BIT(EARTHWORK_KEY_EDGE)},
    [EARTHWORK_FORD] = {BIT(EARTHWORK_KEY_DEPTH),
                        BIT(EARTHWORK_KEY_EDGE) | BIT(EARTHWORK_KEY_GRADE)},
    [EARTHWORK_SKID_PAN] = {BIT(EARTHWORK_KEY_GRIP), 0},
};

static int check_keys(const struct entry *entry, const struct earthwork_entry *given)
{
    const char *shape =
        key_table_choice(&schema_earthwork.keys[EARTHWORK_KEY_SHAPE], given->shape).name;
    for (uint32_t key = EARTHWORK_KEY_HEIGHT; key < EARTHWORK_KEY_COUNT; key++) {
        bool needed = keys_of[given->shape].needed & BIT(key);
        bool allowed = needed || (keys_of[given->shape].allowed & BIT(key));
        if (needed && !entry_given(entry, key))
            return entry_refuse(entry, key, "is missing; a %s needs it", shape);
        if (!allowed && entry_given(entry, key))
            return entry_refuse(entry, key, "is no key of a %s; right would be: without it", shape);
    }
    return 0;
}

/* Sets the lengths of the slopes. */
static void slope(struct earthwork *work, const struct entry *entry,
                  const struct earthwork_entry *given)
{
    double high = fabs(work->height_m);
    double edge = entry_given(entry, EARTHWORK_KEY_EDGE) ? given->edge_m : EDGE_SHARE * high;
    if (high == 0.0)
        edge = 1.0; /* any length is right for a slope without a height */
    double end = edge;
    if (entry_given(entry, EARTHWORK_KEY_GRADE))
        end = high / given->grade;
    else if (given->shape == EARTHWORK_FORD)
        end = high / FORD_GRADE;
    work->side_m = edge;
    work->front_m = end;
    work->back_m = given->shape == EARTHWORK_RAMP ? given->length_m - edge : end;
}

static int check_slopes(const struct entry *entry, const struct earthwork *work)
{
    double high = fabs(work->height_m), least = high / EARTHWORK_STEEPEST;
    double length = 2.0 * work->half_length, width = 2.0 * work->half_width;
    if (work->height_m == 0.0)
        return 0;
    if (work->side_m < least)
        return entry_refuse(entry, EARTHWORK_KEY_EDGE,
                            "makes too steep a face; allowed: at least %.4g m", least);
    if (work->back_m < least || work->back_m + work->front_m > length + ROUNDED_M)
        return entry_refuse(entry, EARTHWORK_KEY_LENGTH,
                            "is too short for the slopes of its ends; allowed: at least %.4g m",
                            work->shape == EARTHWORK_RAMP ? work->front_m + least
                                                          : work->back_m + work->front_m);
    if (2.0 * work->side_m > width)
        return entry_refuse(entry, EARTHWORK_KEY_WIDTH,
                            "is too narrow for the slopes of its sides; allowed: at least %.4g m",
                            2.0 * work->side_m);
    if (work->wave_m > 0.0 && work->wave_m < PI * least)
        return entry_refuse(entry, EARTHWORK_KEY_WAVE,
                            "makes too steep a wave; allowed: at least %.4g m", PI * least);
    return 0;
}

static int check_place(const struct entry *entry, const struct earthwork *work)
{
    const double side_m = entry->scenario->settings->side_m;
    double x = earthwork_reach_x(work), z = earthwork_reach_z(work);
    if (work->x - x >= 0.0 && work->z - z >= 0.0 && work->x + x <= side_m && work->z + z <= side_m)
        return 0;
    return entry_refuse(entry, EARTHWORK_KEY_AT,
                        "the earthwork reaches out of the world; allowed: all of it within 0..%g m",
                        side_m);
}

static int read_work(struct earthwork *work, const struct entry *entry,
                     const struct earthwork_entry *given)
{
    if (check_keys(entry, given) != 0)
        return -1;
    bool dug = given->shape == EARTHWORK_TRENCH || given->shape == EARTHWORK_FORD;
    *work = (struct earthwork){.x = given->at[0],
                               .z = given->at[1],
                               .half_length = 0.5 * given->length_m,
                               .half_width = 0.5 * given->width_m,
                               .height_m = dug ? -given->depth_m : given->height_m,
                               .wave_m = given->wave_m,
                               .grip = 1.0,
                               .shape = given->shape};
    maths_sincos(given->heading_rad, &work->sine, &work->cosine);
    if (given->shape == EARTHWORK_FORD) {
        work->freeboard_m = FREEBOARD_M;
        work->height_m -= FREEBOARD_M;
    }
    if (given->shape == EARTHWORK_SKID_PAN)
        work->grip = given->grip;
    slope(work, entry, given);
    return check_slopes(entry, work) != 0 ? -1 : check_place(entry, work);
}

int earthworks_read(struct scenario *scenario, const config_setting_t *list, const char *file,
                    struct error_text *error)
{
    struct entry entry = {.scenario = scenario, .keys = {.file = file}, .error = error};
    int length = list != NULL ? entry_count(list, file, EARTHWORKS_MAX, error) : 0;
    if (length < 0)
        return -1;
    scenario->earthworks =
        entry_allocate((uint32_t)length, sizeof(*scenario->earthworks), file, error);
    if (scenario->earthworks == NULL)
        return -1;
    for (int i = 0; i < length; i++) {
        struct earthwork_entry given;
        if (entry_read(&entry, &schema_earthwork, i, list, &given) != 0 ||
            read_work(&scenario->earthworks[scenario->earthwork_count], &entry, &given) != 0)
            return -1;
        scenario->earthwork_count++;
    }
    return 0;
}
