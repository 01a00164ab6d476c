/* Closing speeds at points of contact. */
#include "collider/narrow_phase/contact_rests.h"

#include "world/world.h"

/* Returns the velocity of a row's skin at a contact [m/s]. */
static struct vec3 skin_velocity(const struct contact_input *input, uint32_t row,
                                 const struct hull_contact *impact)
{
    const struct path *path = &input->detect.path[row];
    double hz = 1.0 / world_dt_s(input->detect.world), left = 1.0 - path->since;
    struct rotation_path rotation = body_motion_rotation(input->motion, row);
    struct vec3 spin = left > 0.0
                           ? vec3_scale(rotation_speed(rotation.from, rotation.to, 0.0), hz / left)
                           : (struct vec3){0.0, 0.0, 0.0};
    struct vec3 arm = vec3_sub(impact->point, path_at(path, impact->toi));
    return vec3_add(vec3_scale(path->along, hz), vec3_cross(spin, arm));
}

bool contact_rests_on(const struct contact_input *input, const struct contact *contact)
{
    struct vec3 velocity = skin_velocity(input, contact->a, &contact->impact);
    if (!(contact->b & PAIR_FIXED))
        velocity = vec3_sub(velocity, skin_velocity(input, contact->b, &contact->impact));
    return vec3_dot(velocity, contact->impact.normal) < CONTACT_IMPACT_MPS;
}

/* Returns the velocity of a row on the map at an arm from its position [m/s]. */
static struct vec3 level_velocity(const struct contact_queue *contacts, uint32_t row, double hz,
                                  double x, double z)
{
    const struct row_pose *pose = pair_apart_pose(&contacts->apart, row);
    double spin = pose->spin_y * hz;
    return (struct vec3){pose->body.path.along.x * hz + spin * z, 0.0,
                         pose->body.path.along.z * hz - spin * x};
}

bool contact_rests_still(const struct contact_queue *contacts, const struct contact_input *input,
                         uint32_t index)
{
    const struct pair *pair = &contacts->pair[index];
    const struct rest_span *rest = &contacts->rest[index];
    double hz = 1.0 / world_dt_s(input->detect.world);
    for (uint32_t i = rest->first; i < rest->first + rest->count; i++) {
        const struct rest_point *point = &contacts->rest_point[i];
        struct vec3 slip = level_velocity(contacts, pair->a, hz, point->a_x, point->a_z);
        if (!(pair->b & PAIR_FIXED))
            slip = vec3_sub(slip, level_velocity(contacts, pair->b, hz, point->b_x, point->b_z));
        if (slip.x * point->normal_x + slip.z * point->normal_z >= CONTACT_IMPACT_MPS)
            return false;
    }
    return rest->count > 0;
}
