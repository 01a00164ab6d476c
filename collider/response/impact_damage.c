/* The effect of a collision's energy on one body: damage, and a dent where it was hit. */
#include "collider/response/impact_damage.h"

#include "collider/solver/contact_spring.h"
#include "collider/response/damage.h"
#include "collider/response/deformation.h"
#include "world/entity/dent.h"
#include "world/entity/remote.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

/* inwards: unit, world axes. */
static void dent(struct response_context *context, uint32_t row, const struct impact *impact,
                 struct vec3 inwards, const struct deformation *deformation)
{
    const struct state *next = context->next;
    struct state_head *head = next->head;
    struct mat3 turn = rotation_matrix(body_motion_orientation(context->motion, row, impact->time));
    struct vec3 from_position = vec3_sub(impact->point, path_at(&context->path[row], impact->time));
    if (head->dent_count >= context->world->params->dent_slots) {
        head->tally.dents_refused++;
        return;
    }
    struct dent *entry = &next->dents[head->dent_count++];
    *entry = (struct dent){.id = next->entities.row[row].id,
                           .tick = (uint32_t)head->tick,
                           .plastic_m = (float)deformation->plastic_m,
                           .elastic_m = (float)deformation->elastic_m};
    vec3_to_floats(entry->point, rotation_back(&turn, from_position));
    vec3_to_floats(entry->direction, rotation_back(&turn, inwards));
}

/* Half of the spring's compression is this skin's. The skin gives way as far as it is not rigid,
 * and keeps of the compression that remains what it can be moulded to; all else comes back. */
static void dent_of_spring(const struct kind *kind, const struct contact_spring_impact *spring,
                           struct deformation *deformation)
{
    double gives = 0.5 * (1.0 - kind->rigidity);
    deformation->plastic_m = gives * spring->left_m * kind->moldability;
    deformation->elastic_m = gives * spring->depth_m - deformation->plastic_m;
}

/* Makes the dent of an impact by which the skin takes this energy. */
static struct deformation deform(struct response_context *context, uint32_t row,
                                 const struct impact *impact, double side, double joules,
                                 const struct contact_spring_impact *spring)
{
    const struct kind *kind = &context->world->kinds[context->next->entities.row[row].kind];
    struct deformation deformation = deformation_of(kind, joules);
    if (spring)
        dent_of_spring(kind, spring, &deformation);
    if (deformation.plastic_m + deformation.elastic_m >= DEFORMATION_DENT_LEAST_M &&
        !remote_is(&context->next->entities, row))
        dent(context, row, impact, vec3_scale(impact->normal, side), &deformation);
    return deformation;
}

void impact_damage_row(struct response_context *context, uint32_t row, const struct impact *impact,
                       double side, double joules, const struct contact_spring_impact *spring)
{
    struct deformation deformation = deform(context, row, impact, side, joules, spring);
    damage_row(context, row, deformation.harm_j, impact->time);
}

void impact_damage_vehicle(struct response_context *context, uint32_t row,
                           const struct impact *impact, double side, double joules,
                           const struct contact_spring_impact *spring)
{
    const struct entities *e = &context->next->entities;
    const struct kind *kind = &context->world->kinds[e->row[row].kind];
    struct deformation deformation =
        deform(context, row, impact, side, joules * IMPACT_HARM_OUTSIDE, spring);
    double lost = deformation.harm_j / IMPACT_HARM_OUTSIDE;
    damage_row(context, row, impact_harm(kind, e->row[row].harm_j, lost), impact->time);
}
