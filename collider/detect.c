/* What the methods of detection share: boxes, and who can never collide. */
#include "collider/detect.h"

#include <stdlib.h>

/* Half a float's step at 50 km is 2 mm; 1 cm keeps every box outside. */
#define BOX_SLACK_M 0.01

int pair_list_add(struct pair_list *list, uint32_t a, uint32_t b)
{
    if (list->count == list->capacity) {
        uint32_t capacity = list->capacity * 2 + 1024;
        struct pair *pair = realloc(list->pair, capacity * sizeof *pair);
        if (!pair)
            return -1;
        list->pair = pair;
        list->capacity = capacity;
    }
    list->pair[list->count++] = (struct pair){a, b};
    return 0;
}

static double kind_reach(const struct world *world, const struct kind *kind)
{
    return world->params->collision.shape == SHAPE_MODEL ? kind->bound_m : kind->radius_m;
}

double detect_row_reach(const struct detect_input *input, uint32_t row)
{
    return kind_reach(input->world, &input->world->kinds[input->entities->kind[row]]);
}

double detect_grow(const struct world *world, const struct kind *kind)
{
    double dt_s = world->params->dt_s;
    return kind_reach(world, kind) + BOX_SLACK_M + lean_mps(dt_s) * dt_s;
}

double detect_fixed_reach(const struct world *world, const struct fixed_object *object)
{
    const struct kind *kind = &world->kinds[object->kind];
    if (world->params->collision.shape != SHAPE_MODEL)
        return (double)object->radius_m;
    return kind->level_m * ((double)object->radius_m / kind->radius_m);
}

struct sweep_box detect_box(const struct detect_input *input, uint32_t row)
{
    const struct kind *kind = &input->world->kinds[input->entities->kind[row]];
    return detect_way_box(&input->path[row], detect_grow(input->world, kind));
}

static bool rests(const struct path *path)
{
    return path->along.x == 0.0 && path->along.y == 0.0 && path->along.z == 0.0;
}

/* The way, lowered by the threshold, does not reach the ground. */
static bool above_threshold(const struct detect_input *input, const struct path *path)
{
    struct path lowered = *path;
    double toi;
    lowered.at.y -= input->world->params->collision.threshold_height_m;
    return !sweep_ground(&input->world->terrain, input->craters, &lowered, &toi);
}

bool detect_tests_fixed(const struct detect_input *input, uint32_t row)
{
    const struct path *path = &input->path[row];
    const struct kind *kind = &input->world->kinds[input->entities->kind[row]];
    return input->world->counts.fixed > 0 && !rests(path) &&
           !(kind->domain == DOMAIN_AIR && above_threshold(input, path));
}

bool detect_apart(const struct detect_input *input, uint32_t a, uint32_t b)
{
    const struct entities *e = input->entities;
    bool round_a = e->behaviour[a] == BEHAVIOUR_FLIGHT,
         round_b = e->behaviour[b] == BEHAVIOUR_FLIGHT;
    if (round_a && e->owner_slot[a] == b && e->owner_id[a] == e->id[b])
        return true;
    if (round_b && e->owner_slot[b] == a && e->owner_id[b] == e->id[a])
        return true;
    if (round_a && round_b && e->owner_id[a] != 0 && e->owner_id[a] == e->owner_id[b])
        return true;
    return rests(&input->path[a]) && rests(&input->path[b]);
}

bool detect_boxes_meet(const struct sweep_box *a, const struct sweep_box *b)
{
    return a->min_x <= b->max_x && b->min_x <= a->max_x && a->min_z <= b->max_z &&
           b->min_z <= a->max_z && a->min_y <= b->max_y && b->min_y <= a->max_y;
}

bool detect_box_meets_fixed(const struct detect_input *input, const struct sweep_box *box,
                            const struct fixed_object *object)
{
    const struct kind *kind = &input->world->kinds[object->kind];
    double r = detect_fixed_reach(input->world, object), y = (double)object->y;
    double low = -r, high = r;
    if (input->world->params->collision.shape == SHAPE_MODEL) {
        double scale = (double)object->radius_m / kind->radius_m;
        low = kind->low_m * scale;
        high = kind->high_m * scale;
    }
    return (double)box->min_x <= object->x + r && object->x - r <= (double)box->max_x &&
           (double)box->min_z <= object->z + r && object->z - r <= (double)box->max_z &&
           (double)box->min_y <= y + high && y + low <= (double)box->max_y;
}
