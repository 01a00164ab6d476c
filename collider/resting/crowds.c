/* Union-find over the rows; the sums of a crowd are at its root. */
#include "collider/resting/crowds.h"

#include "collider/resting/deep_pair.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>

/* The edge of a dense crowd spreads so fast, until its bodies have this share of the room that they
 * cover. */
#define SPREAD_MPS 20.0
#define ROOM       2.0

int crowds_init(struct crowds *crowds, const struct world *world)
{
    uint32_t rows = world->params->capacity;
    *crowds = (struct crowds){.body = reserve_take(rows, sizeof *crowds->body),
                              .row = reserve_take(rows, sizeof *crowds->row),
                              .listed = calloc(rows, sizeof *crowds->listed)};
    if (crowds->body && crowds->row && crowds->listed)
        return 0;
    crowds_free(crowds);
    errno = ENOMEM;
    return -1;
}

void crowds_free(struct crowds *crowds)
{
    reserve_free(crowds->body);
    reserve_free(crowds->row);
    free(crowds->listed);
    *crowds = (struct crowds){0};
}

void crowds_forget(struct crowds *crowds)
{
    for (uint32_t i = 0; i < crowds->count; i++)
        crowds->listed[crowds->row[i]] = 0;
    crowds->count = 0;
}

static uint32_t root_of(struct crowds_body *body, uint32_t row)
{
    while (body[row].parent != row)
        row = body[row].parent = body[body[row].parent].parent;
    return row;
}

static void add(struct crowds *crowds, uint32_t row)
{
    if (crowds->listed[row])
        return;
    crowds->listed[row] = 1;
    crowds->body[row] = (struct crowds_body){.parent = row};
    crowds->row[crowds->count++] = row;
}

void crowds_join(struct crowds *crowds, const struct pair *pair, double depth_m)
{
    add(crowds, pair->a);
    uint32_t a = root_of(crowds->body, pair->a), b = a;
    if (!(pair->b & PAIR_FIXED)) {
        add(crowds, pair->b);
        b = root_of(crowds->body, pair->b);
    }
    struct crowds_body *root = &crowds->body[a < b ? a : b], *other = &crowds->body[a < b ? b : a];
    other->parent = a < b ? a : b;
    root->deepest_m = maths_max(depth_m, maths_max(root->deepest_m, other->deepest_m));
}

/* Returns true if the bodies of the crowd need more room than the disc about them has. Two bodies
 * have a way of their own (collider/resting/parting_ways.h). */
static bool is_dense(const struct crowds_body *root)
{
    double reach = root->reach_m + sqrt(root->area_m2 / (PI * root->members));
    return root->members > 2 && PI * reach * reach < ROOM * root->area_m2;
}

/* Sets where a row is from the centre of its crowd [m]. */
static void from_centre(const struct crowds_body *root, const struct response_context *context,
                        uint32_t row, double *x, double *z)
{
    deep_pair_place(context, row, x, z);
    *x -= root->centre_x / root->mass_kg;
    *z -= root->centre_z / root->mass_kg;
}

void crowds_measure(struct crowds *crowds, const struct response_context *context)
{
    for (uint32_t i = 0; i < crowds->count; i++) {
        struct crowds_body *body = &crowds->body[crowds->row[i]];
        *body = (struct crowds_body){.parent = body->parent, .deepest_m = body->deepest_m};
    }
    for (uint32_t i = 0; i < crowds->count; i++) {
        uint32_t row = crowds->row[i];
        const struct kind *kind = &context->world->kinds[context->next->entities.row[row].kind];
        struct crowds_body *root = &crowds->body[root_of(crowds->body, row)];
        double x, z;
        deep_pair_place(context, row, &x, &z);
        root->members++;
        root->mass_kg += kind->mass_kg;
        root->area_m2 += kind->length_m * kind->width_m;
        root->centre_x += kind->mass_kg * x;
        root->centre_z += kind->mass_kg * z;
    }
    for (uint32_t i = 0; i < crowds->count; i++) {
        uint32_t row = crowds->row[i];
        struct crowds_body *root = &crowds->body[root_of(crowds->body, row)];
        double x, z;
        from_centre(root, context, row, &x, &z);
        double far = sqrt(x * x + z * z);
        root->reach_m = maths_max(root->reach_m, far);
        root->along_m = maths_max(root->along_m, far / deep_pair_level(context, row));
    }
    for (uint32_t i = 0; i < crowds->count; i++) {
        struct crowds_body *body = &crowds->body[crowds->row[i]];
        body->dense = body->parent == crowds->row[i] && is_dense(body);
    }
}

bool crowds_spreads(struct crowds *crowds, uint32_t row)
{
    return crowds->listed[row] && crowds->body[root_of(crowds->body, row)].dense;
}

bool crowds_spread_together(struct crowds *crowds, const struct pair *pair)
{
    return !(pair->b & PAIR_FIXED) && crowds_spreads(crowds, pair->a) && crowds->listed[pair->b] &&
           root_of(crowds->body, pair->a) == root_of(crowds->body, pair->b);
}

void crowds_spread(struct crowds *crowds, const struct response_context *context, uint32_t row,
                   double *x_mps, double *z_mps)
{
    const struct crowds_body *root = &crowds->body[root_of(crowds->body, row)];
    double edge = maths_min(SPREAD_MPS, 0.5 * root->deepest_m / world_dt_s(context->world));
    double rate = edge / root->along_m, x, z;
    from_centre(root, context, row, &x, &z);
    *x_mps = rate * x;
    *z_mps = rate * z;
}
