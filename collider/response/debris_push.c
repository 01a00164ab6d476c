/* Pushes debris about on the map. */
#include "collider/response/debris_push.h"

#include "collider/narrow_phase/cruise_rows.h"
#include "collider/response/explosion.h"
#include "world/entity/kind.h"
#include "world/entity/mass_properties.h"
#include "world/params.h"
#include "world/terrain/fallen.h"
#include "world/world.h"

#include <string.h>

#define FRICTION   0.7    /* of debris on the ground: that of wrecks */
#define HEAP_KGPM3 1500.0 /* of rubble */
#define PUSH_MPS2                                                                                  \
    20.0               /* a push changes the lighter body's speed no faster: debris gives way in   \
                          pieces, and a vehicle climbs over what it cannot push along */
#define LEAST_MPS 1e-3 /* slower debris and vehicles are at rest */
#define HIGH_M    4.0  /* vehicles higher than that over debris do not touch it */

/* --- the list ----------------------------------------------------------------------------------*/

static bool rests(const struct debris *debris)
{
    return debris->vx == 0.0f && debris->vz == 0.0f && debris->spin_rps == 0.0f;
}

static void scatter(struct response_context *context, uint32_t index)
{
    struct state_head *head = context->next->head;
    uint32_t after = --head->debris_count - index;
    if (head->debris[index].half_length_m > 0.0f) { /* a trunk; a heap is spread out again */
        context->next->fixed_damage[head->debris[index].object] = DAMAGE_DESTROYED;
        head->tally.fixed_damaged++;
    }
    memmove(&head->debris[index], &head->debris[index + 1], after * sizeof *head->debris);
    memset(&head->debris[head->debris_count], 0, sizeof *head->debris);
}

/* Returns a free entry, or NULL. */
static struct debris *free_entry(struct response_context *context)
{
    struct state_head *head = context->next->head;
    for (uint32_t i = 0; head->debris_count == DEBRIS_MAX && i < DEBRIS_MAX; i++) {
        if (rests(&head->debris[i]))
            scatter(context, i);
    }
    return head->debris_count < DEBRIS_MAX ? &head->debris[head->debris_count++] : NULL;
}

/* Returns the heap before the vehicle: half a ball of rubble where the object was struck. */
static struct debris heap_of(const struct debris_fall *fall, double mass_kg)
{
    double radius = maths_cbrt(mass_kg / (HEAP_KGPM3 * (2.0 / 3.0) * PI));
    return (struct debris){.x = fall->x + radius * fall->away_x,
                           .z = fall->z + radius * fall->away_z,
                           .mass_kg = (float)mass_kg,
                           .radius_m = (float)radius};
}

static struct debris trunk_of(const struct debris_area *area, double heading_rad, double mass_kg)
{
    return (struct debris){.x = area->x,
                           .z = area->z,
                           .heading_rad = (float)heading_rad,
                           .mass_kg = (float)mass_kg,
                           .half_length_m = (float)area->half_length_m,
                           .radius_m = (float)area->radius_m};
}

void debris_push_add(struct response_context *context, const struct debris_fall *fall)
{
    const struct world *world = context->world;
    const struct fixed_object *object = &world->fixed[fall->object];
    const struct kind *kind = &world->kinds[object->kind];
    uint8_t *stored = &context->next->fixed_damage[fall->object];
    double loose = kind->mass_kg * (1.0 - kind->debris_keep);
    bool trunk = fallen_is_trunk(kind);
    *stored = fallen_towards(kind, fall->away_x, fall->away_z);
    double mass = trunk ? loose : maths_min(loose, fall->moving_kg);
    struct debris *entry = mass > 0.0 ? free_entry(context) : NULL;
    if (entry == NULL)
        return;
    const struct debris_area area = fallen_area(object, kind, *stored);
    *entry = trunk ? trunk_of(&area, fallen_heading(*stored), mass) : heap_of(fall, mass);
    /* The loose part has no more momentum than the part that the blow moved. */
    double speed = fall->speed_mps * maths_min(1.0, fall->moving_kg / mass);
    entry->vx = (float)(speed * fall->away_x);
    entry->vz = (float)(speed * fall->away_z);
    entry->object = fall->object;
    entry->fell_tick = (uint32_t)context->next->head->tick;
}

/* --- pushes ------------------------------------------------------------------------------------*/

/* A vehicle that touches debris: the unit vector towards the debris, and the point of the debris's
 * line where they touch, from its centre of mass. */
struct debris_contact {
    double normal_x, normal_z, arm_x, arm_z;
};

/* Returns true if the rectangle of the row overlaps the area. */
static bool touches(const struct response_context *context, uint32_t row,
                    const struct debris_area *area, struct debris_contact *touch)
{
    const struct entities *e = &context->next->entities;
    const struct kind *kind = &context->world->kinds[e->row[row].kind];
    struct vec3 point = debris_area_nearest(area, e->row[row].x, e->row[row].z);
    double sine, cosine, dx = point.x - e->row[row].x, dz = point.z - e->row[row].z;
    maths_sincos(e->row[row].heading, &sine, &cosine);
    double distance = sqrt(dx * dx + dz * dz);
    if (fabs(dx * sine - dz * cosine) > 0.5 * kind->length_m + area->radius_m ||
        fabs(dx * cosine + dz * sine) > 0.5 * kind->width_m + area->radius_m)
        return false;
    *touch = (struct debris_contact){.normal_x = distance > 0.0 ? dx / distance : sine,
                                     .normal_z = distance > 0.0 ? dz / distance : -cosine,
                                     .arm_x = point.x - area->x,
                                     .arm_z = point.z - area->z};
    return true;
}

/* Returns what turns the trunk by an impulse [rad/s per N s], clockwise; 0 for a heap. */
static double turning(const struct debris *debris, const struct debris_contact *touch)
{
    double half = (double)debris->half_length_m;
    double lever = touch->arm_x * touch->normal_z - touch->arm_z * touch->normal_x;
    return half > 0.0 ? lever * 3.0 / ((double)debris->mass_kg * half * half) : 0.0;
}

/* Exchanges momentum along the normal until the two do not close, as far as the push allows. A
 * vehicle that stands is held by the ground. */
static void push(struct response_context *context, struct debris *debris, uint32_t row,
                 const struct debris_contact *touch)
{
    const struct entities *e = &context->next->entities;
    double mass = (double)debris->mass_kg,
           vehicle = context->world->kinds[e->row[row].kind].mass_kg;
    double turn = turning(debris, touch);
    double lever = touch->arm_x * touch->normal_z - touch->arm_z * touch->normal_x;
    double closing = (e->row[row].vx - (double)debris->vx) * touch->normal_x +
                     (e->row[row].vz - (double)debris->vz) * touch->normal_z -
                     lever * (double)debris->spin_rps;
    bool held = fabs(e->row[row].vx) < LEAST_MPS && fabs(e->row[row].vz) < LEAST_MPS;
    if (!(closing > 0.0))
        return;
    double gives = 1.0 / mass + lever * turn + (held ? 0.0 : 1.0 / vehicle);
    double most = PUSH_MPS2 * context->world->params->dt_s * maths_min(mass, vehicle);
    double impulse = maths_min(closing / gives, most);
    debris->vx += (float)(impulse / mass * touch->normal_x);
    debris->vz += (float)(impulse / mass * touch->normal_z);
    debris->spin_rps += (float)(impulse * turn);
    if (held)
        return;
    table_set_vx(&context->writer, row, e->row[row].vx - impulse / vehicle * touch->normal_x);
    table_set_vz(&context->writer, row, e->row[row].vz - impulse / vehicle * touch->normal_z);
}

static bool can_push(const struct response_context *context, uint32_t row, double height_m)
{
    const struct entities *e = &context->next->entities;
    return e->row[row].state == ENTITY_ACTIVE &&
           context->world->kinds[e->row[row].kind].domain == DOMAIN_LAND &&
           fabs(e->row[row].y - height_m) < HIGH_M;
}

static void push_by_all(struct response_context *context, struct debris *debris)
{
    const struct debris_area area = debris_area(debris);
    const struct terrain *terrain = &context->world->terrain;
    struct vec3 at = {
        area.x, terrain_height(terrain, context->input.detect.craters, area.x, area.z), area.z};
    const struct path still = {.at = at};
    double reach = area.half_length_m + area.radius_m + HIGH_M;
    struct path_box box = pair_filter_path_box(&still, reach);
    struct pair_list *near = &context->charges->near;
    near->count = 0;
    cruise_rows_query(&context->input, &box, near);
    for (uint32_t i = 0; i < near->count; i++) {
        struct debris_contact touch;
        uint32_t row = near->pair[i].a;
        if (can_push(context, row, at.y) && touches(context, row, &area, &touch))
            push(context, debris, row, &touch);
    }
    near->count = 0;
}

/* --- motion ------------------------------------------------------------------------------------*/

/* Returns the share of a speed that is left after friction has taken `lost` of it. */
static double left_of(double speed, double lost)
{
    return speed > lost ? 1.0 - lost / speed : 0.0;
}

static void slide(const struct world *world, struct debris *debris, double dt_s)
{
    double vx = (double)debris->vx, vz = (double)debris->vz, spin = (double)debris->spin_rps;
    double half = (double)debris->half_length_m, grip = FRICTION * GRAVITY_MPS2 * dt_s;
    double left = left_of(sqrt(vx * vx + vz * vz), grip);
    /* Friction turns a rod with half its weight times half its half length. */
    double spins = half > 0.0 ? left_of(fabs(spin), 1.5 * grip / half) : 0.0;
    debris->vx = (float)(vx * left);
    debris->vz = (float)(vz * left);
    debris->spin_rps = (float)(spin * spins);
    debris->x = world_clamp(world, debris->x + (double)debris->vx * dt_s);
    debris->z = world_clamp(world, debris->z + (double)debris->vz * dt_s);
    debris->heading_rad =
        (float)maths_wrap_turn((double)debris->heading_rad + (double)debris->spin_rps * dt_s);
}

void debris_push_step(struct response_context *context)
{
    struct state_head *head = context->next->head;
    for (uint32_t i = 0; i < head->debris_count; i++) {
        push_by_all(context, &head->debris[i]);
        if (!rests(&head->debris[i]))
            slide(context->world, &head->debris[i], context->world->params->dt_s);
    }
}
