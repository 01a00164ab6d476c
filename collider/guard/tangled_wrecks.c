/* Groups of wrecks by union of the pairs that are deeper. */
#include "collider/guard/tangled_wrecks.h"

#include "collider/guard/send_back.h"
#include "collider/response/path_change.h"
#include "world/entity/mass_properties.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/world.h"

#include <errno.h>

#define SLOW_MPS 2.0 /* slower groups come to rest, and impacts below this are told to nobody */

/* The sums of a group. */
struct tangle {
    double mass_kg, kinetic_j;
    double raised_kgm; /* mass times the height that going back has given it */
    struct vec3 momentum;
    uint32_t wrecks;
    bool held;
};

int tangled_wrecks_init(struct tangled_wrecks *tangled, const struct world *world)
{
    uint32_t rows = world->params->capacity;
    *tangled = (struct tangled_wrecks){.wreck = reserve_take(rows, sizeof *tangled->wreck),
                                       .of_row = reserve_take(rows, sizeof *tangled->of_row)};
    if (tangled->wreck && tangled->of_row)
        return 0;
    tangled_wrecks_free(tangled);
    errno = ENOMEM;
    return -1;
}

void tangled_wrecks_free(struct tangled_wrecks *tangled)
{
    reserve_free(tangled->wreck);
    reserve_free(tangled->of_row);
    *tangled = (struct tangled_wrecks){.count = 0};
}

/* --- rows --------------------------------------------------------------------------------------*/

static struct vec3 arm_of(const struct response_context *context, uint32_t row,
                          struct mass_properties *mass, struct mat3 *axes)
{
    const struct entities *e = &context->next->entities;
    *mass = mass_properties_of(&context->world->kinds[e->row[row].kind]);
    *axes = rotation_matrix(rotation_of(e->row[row].heading, e->row[row].pitch, e->row[row].roll));
    return rotation_apply(axes, (struct vec3){0.0, mass->centre_m, 0.0});
}

/* Returns the wreck of a row, which is new if it was not noted before. */
static uint32_t wreck_of(struct tangled_wrecks *tangled, const struct response_context *context,
                         uint32_t row)
{
    const struct entities *e = &context->next->entities;
    struct mass_properties mass;
    struct mat3 axes;
    if (tangled->of_row[row] != 0)
        return tangled->of_row[row] - 1;
    struct vec3 spin = {e->row[row].spin_x, e->row[row].spin_y, e->row[row].spin_z};
    struct vec3 arm = arm_of(context, row, &mass, &axes), turns = rotation_back(&axes, spin);
    struct vec3 velocity = vec3_add(entities_velocity(e, row), vec3_cross(spin, arm));
    tangled->wreck[tangled->count] = (struct tangled_wreck){
        .row = row,
        .parent = tangled->count,
        .velocity = velocity,
        .kinetic_j =
            0.5 * (mass.mass_kg * vec3_dot(velocity, velocity) + mass.moment.x * turns.x * turns.x +
                   mass.moment.y * turns.y * turns.y + mass.moment.z * turns.z * turns.z),
        .height_m = e->row[row].y + arm.y,
        .held = path_change_grounded(context, row)};
    tangled->of_row[row] = ++tangled->count;
    return tangled->count - 1;
}

static uint32_t first_of(const struct tangled_wrecks *tangled, uint32_t index)
{
    while (tangled->wreck[index].parent != index)
        index = tangled->wreck[index].parent;
    return index;
}

static bool is_wreck(const struct response_context *context, uint32_t side)
{
    return !(side & PAIR_FIXED) && context->next->entities.row[side].state == ENTITY_WRECK;
}

void tangled_wrecks_note(struct tangled_wrecks *tangled, const struct response_context *context,
                         uint32_t pair)
{
    const struct pair *sides = &context->contacts->pair[pair];
    bool first = is_wreck(context, sides->a), second = is_wreck(context, sides->b);
    if (first && second) {
        uint32_t a = first_of(tangled, wreck_of(tangled, context, sides->a));
        uint32_t b = first_of(tangled, wreck_of(tangled, context, sides->b));
        tangled->wreck[a > b ? a : b].parent = a > b ? b : a;
    } else if (first || second) {
        uint32_t row = first ? sides->a : sides->b;
        tangled->wreck[wreck_of(tangled, context, row)].held = true;
    }
}

/* --- groups ------------------------------------------------------------------------------------*/

static struct tangle sum_of(const struct tangled_wrecks *tangled,
                            const struct response_context *context, const uint8_t *sent_back,
                            uint32_t first)
{
    struct tangle sum = {.wrecks = 0};
    for (uint32_t i = first; i < tangled->count; i++) {
        const struct tangled_wreck *wreck = &tangled->wreck[i];
        struct mass_properties mass;
        struct mat3 axes;
        if (first_of(tangled, i) != first)
            continue;
        sum.held |= wreck->held;
        if (sent_back[wreck->row] != SEND_BACK_MOST)
            continue;
        double height_m =
            context->next->entities.row[wreck->row].y + arm_of(context, wreck->row, &mass, &axes).y;
        sum.wrecks++;
        sum.mass_kg += mass.mass_kg;
        sum.kinetic_j += wreck->kinetic_j;
        sum.raised_kgm += mass.mass_kg * (height_m - wreck->height_m);
        sum.momentum = vec3_add(sum.momentum, vec3_scale(wreck->velocity, mass.mass_kg));
    }
    return sum;
}

/* Returns the velocity with which a group goes on, or 0: it does not [m/s]. */
static struct vec3 velocity_of(const struct tangle *sum)
{
    const struct vec3 none = {0.0, 0.0, 0.0};
    if (sum->held || sum->wrecks < 2)
        return none;
    struct vec3 velocity = vec3_scale(sum->momentum, 1.0 / sum->mass_kg);
    double square = vec3_dot(velocity, velocity);
    double left_j = sum->kinetic_j - GRAVITY_MPS2 * sum->raised_kgm;
    if (square < SLOW_MPS * SLOW_MPS || left_j <= 0.0)
        return none;
    double most = 2.0 * left_j / sum->mass_kg;
    return square <= most ? velocity : vec3_scale(velocity, sqrt(most / square));
}

void tangled_wrecks_go_on(struct tangled_wrecks *tangled, struct response_context *context,
                          const uint8_t *sent_back)
{
    for (uint32_t first = 0; first < tangled->count; first++) {
        if (tangled->wreck[first].parent != first)
            continue;
        const struct tangle sum = sum_of(tangled, context, sent_back, first);
        const struct vec3 velocity = velocity_of(&sum);
        if (vec3_dot(velocity, velocity) == 0.0)
            continue;
        for (uint32_t i = first; i < tangled->count; i++) {
            if (first_of(tangled, i) != first || sent_back[tangled->wreck[i].row] != SEND_BACK_MOST)
                continue;
            table_set_velocity(&context->writer, tangled->wreck[i].row, velocity);
            table_set_spin(&context->writer, tangled->wreck[i].row, (struct vec3){0.0, 0.0, 0.0});
            table_set_until_tick(&context->writer, tangled->wreck[i].row, 0);
        }
    }
    for (uint32_t i = 0; i < tangled->count; i++)
        tangled->of_row[tangled->wreck[i].row] = 0;
    tangled->count = 0;
}
