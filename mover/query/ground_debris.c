/* Finds the debris at a point: around or along what fell, and where it was pushed. */
#include "mover/query/ground_debris.h"

#include "world/entity/debris.h"
#include "world/state.h"
#include "world/terrain/fallen.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#define TRUNK_MOST_M 24.0 /* no trunk reaches farther from its foot */
#define NOTHING      2.0  /* the share where no debris lies */

/* Returns the debris of a fallen object that lies loose where it fell [kg]. moved: its entry in the
 * list, or NULL. */
static double loose_kg(const struct kind *object, const struct debris *moved)
{
    double loose = object->mass_kg * (1.0 - object->debris_keep);
    return moved ? maths_max(0.0, loose - (double)moved->mass_kg) : loose;
}

/* The vehicle shares its momentum with the loose debris in its way, which lies evenly over the
 * object's rectangle. */
static double speed_share(const struct kind *vehicle, const struct kind *object, double loose)
{
    double covered = vehicle->length_m * vehicle->width_m / (object->length_m * object->width_m);
    return vehicle->mass_kg / (vehicle->mass_kg + loose * maths_min(1.0, covered));
}

/* Returns true if debris of the object lies at the point, where it fell. moved: set to its entry in
 * the list, or NULL. */
static bool lies(const struct world *world, const struct state *committed, uint32_t object,
                 double x, double z, const struct debris **moved)
{
    const struct state_head *head = committed->head;
    uint8_t stored = committed->fixed_damage[object];
    if (stored < DAMAGE_HIGH || stored == DAMAGE_DESTROYED)
        return false;
    const struct kind *kind = &world->kinds[world->fixed[object].kind];
    const struct debris_area area = fallen_area(&world->fixed[object], kind, stored);
    if (!debris_area_holds(&area, x, z))
        return false;
    *moved = debris_find(head->debris, head->debris_count, object);
    return *moved == NULL || !fallen_is_trunk(kind);
}

/* Returns the least share of full speed that the debris of one square's objects leaves the vehicle
 * at the point, NOTHING if none lies there. */
static double share_of_square(const struct world *world, const struct state *committed,
                              const struct kind *vehicle, uint32_t square, double x, double z)
{
    const uint32_t *objects;
    double share = NOTHING;
    uint32_t count = world_reach(world, square, &objects);
    for (uint32_t n = 0; n < count; n++) {
        const struct debris *moved;
        if (!lies(world, committed, objects[n], x, z, &moved))
            continue;
        const struct kind *object = &world->kinds[world->fixed[objects[n]].kind];
        share = maths_min(share, speed_share(vehicle, object, loose_kg(object, moved)));
    }
    return share;
}

/* The same for all objects whose trunks may reach the point. */
static double share_of_fallen(const struct world *world, const struct state *committed,
                              const struct kind *vehicle, double x, double z)
{
    const struct gridsquares *squares = &world->terrain.squares;
    struct gridsquare_box box = gridsquare_box_of(squares, x - TRUNK_MOST_M, z - TRUNK_MOST_M,
                                                  x + TRUNK_MOST_M, z + TRUNK_MOST_M);
    double share = NOTHING;
    for (int32_t row = box.z0; row <= box.z1; row++) {
        for (int32_t column = box.x0; column <= box.x1; column++)
            share = maths_min(share, share_of_square(world, committed, vehicle,
                                                     gridsquare_index(squares, column, row), x, z));
    }
    return share;
}

double ground_debris_share(const struct world *world, const struct state *committed,
                           const struct kind *vehicle, double x, double z)
{
    return maths_min(1.0, share_of_fallen(world, committed, vehicle, x, z));
}

bool ground_debris_lies(const struct world *world, const struct state *committed, double x,
                        double z)
{
    const struct state_head *head = committed->head;
    for (uint32_t i = 0; i < head->debris_count; i++) {
        const struct debris_area area = debris_area(&head->debris[i]);
        if (debris_area_holds(&area, x, z))
            return true;
    }
    return share_of_fallen(world, committed, &world->kinds[0], x, z) < NOTHING;
}
