/* A sweep of one angle at a time, from the committed one to the mover's, against the row's pairs.
 */
#include "collider/guard/turret_guard.h"

#include "collider/resting/contact_groups.h"
#include "world/checksum.h"
#include "world/maths/maths.h"
#include "world/runtime/work_done.h"

/* A row while its turret and its gun turn. */
struct aiming_row {
    struct response_context *context;
    uint32_t row;
    double turret, gun; /* [rad] where they point now */
};

static bool turns(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    return e->row[row].state != ENTITY_FREE && body_motion_aimed(context->motion, row);
}

/* Returns the other side of a pair as it ends the frame. Turrets of higher rows have not turned. */
static struct swept_body other_body(const struct aiming_row *aiming, uint32_t other)
{
    const struct entities *e = &aiming->context->next->entities;
    const struct body_motion *motion = aiming->context->motion;
    struct swept_body body = body_motion_standing(motion, e, other);
    if (!(other & PAIR_FIXED) && other < aiming->row)
        body_motion_aim(motion, other, (double)e->row[other].turret, (double)e->row[other].gun, 0.0,
                        0.0, &body);
    return body;
}

/* Returns true if the other side of a pair stops turrets. */
static bool stops(const struct response_context *context, uint32_t other)
{
    const struct entities *e = &context->next->entities;
    if (other & PAIR_FIXED)
        return contact_groups_is_wall(context, other & ~PAIR_FIXED);
    return e->row[other].state != ENTITY_FREE && e->row[other].behaviour != BEHAVIOUR_FLIGHT;
}

/* Returns the share of a turn until the parts touch something, 1 if they do not. */
static double free_share(const struct aiming_row *aiming, const struct swept_body *parts)
{
    const struct contact_queue *contacts = aiming->context->contacts;
    struct hull_contact impact;
    double share = 1.0;
    for (uint32_t link = contacts->head[aiming->row]; link != 0;
         link = contacts->link[link - 1].next) {
        const struct pair *pair = &contacts->pair[contacts->link[link - 1].pair];
        uint32_t other = pair->a == aiming->row ? pair->b : pair->a;
        if (!stops(aiming->context, other))
            continue;
        struct swept_body body = other_body(aiming, other);
        if (time_of_impact_find(parts, &body, 0.0, &impact))
            share = maths_min(share, impact.toi);
    }
    return share;
}

/* Turns turret and gun by these angles, or until they touch something. Returns the share. */
static double turn(const struct aiming_row *aiming, double turret_turn, double gun_turn)
{
    const struct response_context *context = aiming->context;
    const struct entities *e = &context->next->entities;
    const struct kind *kind = &context->world->kinds[e->row[aiming->row].kind];
    struct swept_body parts = body_motion_standing(context->motion, e, aiming->row);
    body_motion_aim(context->motion, aiming->row, aiming->turret, aiming->gun, turret_turn,
                    gun_turn, &parts);
    parts.hull += kind->body_hulls;
    parts.hull_count -= kind->body_hulls;
    return free_share(aiming, &parts);
}

static void turn_row(struct response_context *context, uint32_t row)
{
    const struct entities *w = &context->motion->before, *e = &context->next->entities;
    struct aiming_row aiming = {context, row, (double)w->row[row].turret, (double)w->row[row].gun};
    double turret_turn = maths_wrap_half((double)e->row[row].turret - aiming.turret);
    double gun_turn = (double)e->row[row].gun - aiming.gun, share = 1.0;
    if (turret_turn != 0.0)
        share = turn(&aiming, turret_turn, 0.0);
    if (share < 1.0) {
        aiming.turret =
            share > 0.0 ? maths_wrap_half(aiming.turret + turret_turn * share) : aiming.turret;
        table_set_turret(&context->writer, row, (float)aiming.turret);
    }
    aiming.turret = (double)e->row[row].turret;
    share = gun_turn != 0.0 ? turn(&aiming, 0.0, gun_turn) : 1.0;
    if (share < 1.0)
        table_set_gun(&context->writer, row, (float)(aiming.gun + gun_turn * share));
}

void turret_guard_run(struct response_context *context)
{
    const uint32_t *head = context->contacts->head;
    for (uint32_t w = 0; w * 64 < context->next->head->used; w++) {
        for (uint64_t left = context->moved[w]; left != 0; left &= left - 1) {
            uint32_t row = w * 64 + (uint32_t)__builtin_ctzll(left);
            if (head[row] == 0 || !turns(context, row))
                continue;
            turn_row(context, row);
            work_done();
        }
    }
}
