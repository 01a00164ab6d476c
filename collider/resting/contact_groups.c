/* Union-find over the rows of the contact table. */
#include "collider/resting/contact_groups.h"

#include "collider/narrow_phase/narrow_phase.h"
#include "collider/response/contact_table.h"
#include "collider/response/path_change.h"
#include "collider/resting/held_rest.h"
#include "world/checksum.h"
#include "world/entity/persistent_contact.h"
#include "world/entity/remote.h"
#include "world/maths/sort.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>

int contact_groups_init(struct contact_groups *groups, const struct world *world)
{
    uint32_t rows = world->params->capacity;
    *groups = (struct contact_groups){.capacity = world->params->contact_slots};
    groups->pair = reserve_take(groups->capacity, sizeof *groups->pair);
    groups->contact = reserve_take(groups->capacity, sizeof *groups->contact);
    groups->stirred = reserve_take(groups->capacity, sizeof *groups->stirred);
    groups->parent = calloc(rows, sizeof *groups->parent);
    groups->awake = calloc(rows, sizeof *groups->awake);
    groups->ground = calloc(rows, sizeof *groups->ground);
    groups->asked = reserve_take(rows, sizeof *groups->asked);
    groups->begun = reserve_take(rows, sizeof *groups->begun);
    if (groups->pair && groups->contact && groups->stirred && groups->parent && groups->awake &&
        groups->ground && groups->asked && groups->begun)
        return 0;
    contact_groups_free(groups);
    errno = ENOMEM;
    return -1;
}

void contact_groups_free(struct contact_groups *groups)
{
    reserve_free(groups->pair);
    reserve_free(groups->contact);
    reserve_free(groups->stirred);
    free(groups->parent);
    free(groups->awake);
    free(groups->ground);
    reserve_free(groups->asked);
    reserve_free(groups->begun);
    *groups = (struct contact_groups){0};
}

/* Returns true if the row is one of a remote entity that was corrected after the contacts of the
 * frame before: it may now be in another body. */
static bool is_corrected(const struct response_context *context, uint32_t row)
{
    const struct state *committed = context->motion->committed;
    return context->world->params->remotes_max != 0 && body_motion_old(context->motion, row) &&
           remote_is_corrected(&committed->entities, row, (uint32_t)committed->head->tick);
}

/* Returns true if bodies may overlap the row without a contact in the table. */
static bool is_new(const struct response_context *context, uint32_t row)
{
    return context->next->head->tick == 1 || !body_motion_old(context->motion, row) ||
           is_corrected(context, row);
}

/* --- pairs of the table ------------------------------------------------------------------------*/

#define OFF_GROUND 1u
#define ON_GROUND  2u
#define HELD       4u /* by a contact, in the frame before */

/* Returns true if the ground holds the row. A row has several contacts, and is asked once. */
static bool on_ground(struct contact_groups *groups, const struct response_context *context,
                      uint32_t row)
{
    if (groups->ground[row] == 0) { /* it is the first thing that is asked */
        groups->ground[row] = path_change_grounded(context, row) ? ON_GROUND : OFF_GROUND;
        groups->asked[groups->asked_count++] = row;
    }
    return groups->ground[row] & ON_GROUND;
}

/* Rows change after a search. */
static void forget_ground(struct contact_groups *groups)
{
    for (uint32_t i = 0; i < groups->asked_count; i++)
        groups->ground[groups->asked[i]] = 0;
    groups->asked_count = 0;
}

/* A wreck on the ground tips over if the ground alone makes it turn about a level axis as fast as
 * this: something else carries it, or it rolls [rad/s2]. */
#define TIPS_RPS2 0.5

/* It rocks if one of its ends leaves or meets the ground faster than this. A held body has no
 * weight for those on it: one that rocks would lift them, and lose nothing [m/s]. */
#define ROCKS_MPS 0.05

static double square(double x, double z)
{
    return x * x + z * z;
}

/* Returns true if an end of a wreck leaves or meets the ground. */
static bool rocks(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    struct vec3 velocity = entities_velocity(e, row);
    double half_m = 0.5 * context->world->kinds[e->row[row].kind].length_m;
    double end_mps = half_m * sqrt(square(e->row[row].spin_x, e->row[row].spin_z));
    if (vec3_length(velocity) + end_mps <= ROCKS_MPS)
        return false; /* the common case */
    struct vec3 normal = terrain_normal(&context->world->terrain, context->input.detect.craters,
                                        e->row[row].x, e->row[row].z);
    return fabs(vec3_dot(velocity, normal)) + end_mps > ROCKS_MPS;
}

static bool tips(const struct response_context *context, uint32_t row)
{
    const struct entities *w = &context->motion->before, *e = &context->next->entities;
    double x = e->row[row].spin_x - w->row[row].spin_x, z = e->row[row].spin_z - w->row[row].spin_z;
    double most = TIPS_RPS2 * world_dt_s(context->world);
    return square(x, z) > most * most || rocks(context, row);
}

bool contact_groups_flies(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    return e->row[row].state == ENTITY_ACTIVE && e->row[row].behaviour != BEHAVIOUR_FLIGHT &&
           !(e->row[row].flags & ENTITY_FLAG_LANDED) &&
           context->world->kinds[e->row[row].kind].domain == DOMAIN_AIR;
}

bool contact_groups_in_air(const struct response_context *context, uint32_t row)
{
    return contact_groups_flies(context, row) ||
           (context->next->entities.row[row].state == ENTITY_WRECK &&
            !path_change_grounded(context, row));
}

bool contact_groups_is_piloted(const struct response_context *context, uint32_t row)
{
    return context->next->entities.row[row].behaviour != BEHAVIOUR_HOLD &&
           contact_groups_flies(context, row);
}

/* Returns true for a body that is free, no matter whether the ground holds it. Sets *held to true
 * if it is free unless the ground does. */
static bool free_anyway(const struct response_context *context, uint32_t row, bool *held)
{
    const struct entities *e = &context->next->entities;
    enum domain domain = (enum domain)context->world->kinds[e->row[row].kind].domain;
    bool wreck = e->row[row].state == ENTITY_WRECK;
    *held = false;
    if (contact_groups_is_piloted(context, row))
        return body_motion_old(context->motion, row);
    if (domain == DOMAIN_SEA || !body_motion_old(context->motion, row) ||
        !(wreck || e->row[row].flags & (ENTITY_FLAG_CHASSIS | ENTITY_FLAG_LANDED)))
        return false;
    *held = true;
    return wreck && tips(context, row);
}

bool contact_groups_is_free(const struct response_context *context, uint32_t row)
{
    bool held;
    return free_anyway(context, row, &held) || (held && !path_change_grounded(context, row));
}

/* The same, in a search of the table. */
static bool is_free(struct contact_groups *groups, const struct response_context *context,
                    uint32_t row)
{
    bool held;
    return free_anyway(context, row, &held) || (held && !on_ground(groups, context, row));
}

static bool is_held(struct contact_groups *groups, const struct response_context *context,
                    uint32_t row, uint32_t id)
{
    return entities_alive(&context->next->entities, row, id) && on_ground(groups, context, row) &&
           !is_free(groups, context, row);
}

bool contact_groups_is_wall(const struct response_context *context, uint32_t object)
{
    return pair_filter_stands(&context->input.detect, object) &&
           !narrow_phase_lets_in(context->world, context->input.through_fixed, object);
}

/* Returns true if both sides still exist and can bear a load: the ground holds bodies, and fixed
 * objects are walls. */
static bool still_there(struct contact_groups *groups, const struct response_context *context,
                        const struct persistent_contact *contact)
{
    uint32_t object = contact->b_id & ~PERSISTENT_CONTACT_FIXED;
    if (!is_held(groups, context, contact->a_row, contact->a_id))
        return false;
    return contact->b_id & PERSISTENT_CONTACT_FIXED
               ? contact_groups_is_wall(context, object)
               : is_held(groups, context, contact->b_row, contact->b_id);
}

/* Returns true if two bodies in the air only have to part (collider/parting/aircraft_parting.h). */
static bool parts_in_air(const struct response_context *context,
                         const struct persistent_contact *contact)
{
    return contact->flags & PERSISTENT_CONTACT_PARTS &&
           !(contact->b_id & PERSISTENT_CONTACT_FIXED) &&
           contact_groups_in_air(context, contact->a_row) &&
           contact_groups_in_air(context, contact->b_row);
}

/* Returns true if one of the bodies is free, and the other one can bear a load. */
static bool is_free_pair(struct contact_groups *groups, const struct response_context *context,
                         const struct persistent_contact *contact)
{
    bool a = is_free(groups, context, contact->a_row);
    if (contact->b_id & PERSISTENT_CONTACT_FIXED)
        return a;
    bool b = is_free(groups, context, contact->b_row);
    return (a || b) && !parts_in_air(context, contact) &&
           (a || on_ground(groups, context, contact->a_row)) &&
           (b || on_ground(groups, context, contact->b_row));
}

/* Returns true if a side of a contact is still there. id: as in the contact. */
static bool is_there(const struct response_context *context, uint32_t row, uint32_t id)
{
    return id & PERSISTENT_CONTACT_FIXED
               ? contact_groups_is_wall(context, id & ~PERSISTENT_CONTACT_FIXED)
               : entities_alive(&context->next->entities, row, id);
}

/* What a wreck at rest may have leant on is gone. */
static void wake_wreck(struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    if (e->row[row].state == ENTITY_WRECK && e->row[row].until_tick != 0)
        table_set_until_tick(&context->writer, row, 0);
}

static struct pair pair_of(const struct persistent_contact *contact)
{
    if (contact->b_id & PERSISTENT_CONTACT_FIXED)
        return (struct pair){contact->a_row, contact->b_id};
    return contact->a_row < contact->b_row ? (struct pair){contact->a_row, contact->b_row}
                                           : (struct pair){contact->b_row, contact->a_row};
}

/* --- groups ------------------------------------------------------------------------------------*/

static uint32_t root_of(struct contact_groups *groups, uint32_t row)
{
    uint32_t *parent = groups->parent;
    while (parent[row] != row + 1) {
        parent[row] = parent[parent[row] - 1];
        row = parent[row] - 1;
    }
    return row;
}

/* The lower root becomes that of both. */
static void join(struct contact_groups *groups, uint32_t p, uint32_t q)
{
    uint32_t a = root_of(groups, p), b = root_of(groups, q);
    groups->parent[a > b ? a : b] = (a > b ? b : a) + 1;
}

static void join_pair(struct contact_groups *groups, struct pair pair)
{
    if (groups->parent[pair.a] == 0)
        groups->parent[pair.a] = pair.a + 1;
    if (pair.b & PAIR_FIXED)
        return;
    if (groups->parent[pair.b] == 0)
        groups->parent[pair.b] = pair.b + 1;
    join(groups, pair.a, pair.b);
}

static void add(struct contact_groups *groups, struct pair pair, uint32_t contact)
{
    groups->contact[groups->count] = contact;
    groups->pair[groups->count++] = pair;
    join_pair(groups, pair);
}

/* Notes that a contact that is still there held its bodies in the frame before. */
static void note_holding(struct contact_groups *groups, const struct pair *pair)
{
    groups->ground[pair->a] |= HELD;
    if (!(pair->b & PAIR_FIXED))
        groups->ground[pair->b] |= HELD;
}

/* Returns true if a row moves, and its contacts do not hold it. */
static bool moves(const struct contact_groups *groups, struct response_context *context,
                  uint32_t row)
{
    return (body_motion_moves(context->motion, row) &&
            !(groups->ground[row] & HELD && held_rest_stays(context, row))) ||
           is_corrected(context, row);
}

/* Wakes the groups in which a row moves, or of which a pair overlaps and has to part. */
static void wake(struct contact_groups *groups, struct response_context *context)
{
    for (uint32_t i = 0; i < groups->count; i++) {
        const struct pair *pair = &groups->pair[i];
        /* Both are asked in any case, because that computes their paths. */
        bool a_moves = moves(groups, context, pair->a);
        bool b_moves = !(pair->b & PAIR_FIXED) && moves(groups, context, pair->b);
        if (groups->awake[pair->a] || a_moves || b_moves)
            groups->awake[root_of(groups, pair->a)] = 1;
    }
}

/* A root is the lowest row of its group, so the higher row of a pair is never marked as awake. */
static void clear(struct contact_groups *groups, const struct pair *pair)
{
    groups->parent[pair->a] = 0;
    groups->awake[pair->a] = 0;
    if (pair->b & PAIR_FIXED)
        return;
    groups->parent[pair->b] = 0;
}

/* Returns true if both sides of a contact are the same as in the frame before. */
static bool are_there(const struct response_context *context,
                      const struct persistent_contact *contact)
{
    const struct entities *e = &context->next->entities;
    return entities_alive(e, contact->a_row, contact->a_id) &&
           (contact->b_id & PERSISTENT_CONTACT_FIXED ||
            entities_alive(e, contact->b_row, contact->b_id));
}

/* Returns true if a body of the contact moves, or if they have to part. */
static bool is_stirred(struct response_context *context, const struct persistent_contact *contact)
{
    struct pair pair = pair_of(contact);
    /* Both are asked in any case, because that computes their paths. */
    bool a_moves = body_motion_moves(context->motion, pair.a);
    bool b_moves = !(pair.b & PAIR_FIXED) && body_motion_moves(context->motion, pair.b);
    return a_moves || b_moves || contact->flags & PERSISTENT_CONTACT_OVERLAPS ||
           is_corrected(context, pair.a) ||
           (!(pair.b & PAIR_FIXED) && is_corrected(context, pair.b));
}

/* Returns true if a contact of the table is stirred. In a world whose heaps are all at rest none
 * is, and then the paths of all their bodies are known. */
static bool any_stirred(struct response_context *context)
{
    const struct state *committed = context->motion->committed;
    for (uint32_t i = 0; i < committed->head->contact_count; i++) {
        const struct persistent_contact *contact = &committed->contacts[i];
        if (are_there(context, contact) && is_stirred(context, contact))
            return true;
    }
    return false;
}

/* Joins all contacts of the table, whether they bear loads or not, and marks the rows with motion.
 */
static void stir(struct contact_groups *groups, struct response_context *context)
{
    const struct state *committed = context->motion->committed;
    for (uint32_t i = 0; i < committed->head->contact_count; i++) {
        const struct persistent_contact *contact = &committed->contacts[i];
        struct pair pair = pair_of(contact);
        if (!are_there(context, contact))
            continue;
        join_pair(groups, pair);
        if (is_stirred(context, contact))
            groups->awake[pair.a] = 1;
    }
    for (uint32_t i = 0; i < committed->head->contact_count; i++) {
        uint32_t row = pair_of(&committed->contacts[i]).a;
        if (groups->awake[row])
            groups->awake[root_of(groups, row)] = 1;
    }
}

/* Lists the contacts of bodies that are joined with one that moves. Those of all others sleep in
 * any case, and it need not be known what holds their bodies. */
static void list_stirred(struct contact_groups *groups, struct response_context *context)
{
    const struct state *committed = context->motion->committed;
    groups->stirred_count = 0;
    if (context->contacts_sleep || !any_stirred(context))
        return;
    stir(groups, context);
    for (uint32_t i = 0; i < committed->head->contact_count; i++) {
        const struct persistent_contact *contact = &committed->contacts[i];
        if (are_there(context, contact) && groups->awake[root_of(groups, pair_of(contact).a)])
            groups->stirred[groups->stirred_count++] = i;
    }
    for (uint32_t i = 0; i < committed->head->contact_count; i++) {
        const struct pair pair = pair_of(&committed->contacts[i]);
        clear(groups, &pair);
    }
}

/* Keeps the pairs that are awake, and marks no row any more. */
static void keep_awake(struct contact_groups *groups)
{
    uint32_t all = groups->count;
    struct pair *pair = groups->pair;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < all; i++) {
        struct pair one = pair[i];
        bool awake = groups->awake[root_of(groups, one.a)] != 0;
        pair[i] = pair[kept];
        pair[kept] = one;
        groups->contact[kept] = groups->contact[i];
        kept += awake;
    }
    for (uint32_t i = 0; i < all; i++)
        clear(groups, &pair[i]);
    groups->count = kept;
}

/* Puts a row of a group that is asleep back. A contact holds it, or it would not have moved. */
static void put_row_back(struct response_context *context, uint32_t row)
{
    held_rest_put_back(context, row);
    held_rest_pin(context, row);
}

/* What is asleep stands still: the bodies that contacts hold go back. all: pairs, with those that
 * are not kept. */
static void put_back(const struct contact_groups *groups, struct response_context *context,
                     uint32_t all)
{
    for (uint32_t i = groups->count; i < all; i++) {
        const struct pair *pair = &groups->pair[i];
        if (body_motion_moves(context->motion, pair->a))
            put_row_back(context, pair->a);
        if (!(pair->b & PAIR_FIXED) && body_motion_moves(context->motion, pair->b))
            put_row_back(context, pair->b);
    }
}

/* --- bodies that are new -----------------------------------------------------------------------*/

void contact_groups_add(struct contact_groups *groups, const struct pair *pair)
{
    if (groups->count == groups->capacity) {
        uint32_t more = 2 * groups->capacity + 1;
        groups->pair = reserve_grow(groups->pair, groups->count, more, sizeof *groups->pair);
        groups->capacity = more;
    }
    groups->pair[groups->count++] = *pair;
}

static void add_pairs_of(struct contact_groups *groups, struct response_context *context,
                         uint32_t row)
{
    const struct contact_queue *contacts = context->contacts;
    contact_queue_look(context->contacts, &context->input, row, true);
    for (uint32_t link = contacts->head[row]; link != 0; link = contacts->link[link - 1].next) {
        const struct pair *pair = &contacts->pair[contacts->link[link - 1].pair];
        uint32_t other = pair->a == row ? pair->b : pair->a;
        bool counts = other & PAIR_FIXED
                          ? contact_groups_is_wall(context, other & ~PAIR_FIXED)
                          : !(other < row && is_new(context, other)) &&
                                path_change_grounded(context, other) &&
                                context->next->entities.row[other].behaviour != BEHAVIOUR_FLIGHT;
        if (counts && !contact_table_find(context, pair->a, pair->b))
            contact_groups_add(groups, pair);
    }
}

/* Which bodies are looked for among those that are new. */
typedef bool new_body(const struct response_context *context, uint32_t row);

/* Lists those of 64 rows whose bodies were not there in the committed frame. */
static void list_new(struct contact_groups *groups, struct response_context *context,
                     uint32_t first, uint64_t rows, new_body *counts)
{
    const struct entities *e = &context->next->entities;
    for (; rows != 0; rows &= rows - 1) {
        uint32_t row = first + (uint32_t)__builtin_ctzll(rows);
        if (row >= context->next->head->used)
            break;
        if (e->row[row].state == ENTITY_FREE || e->row[row].behaviour == BEHAVIOUR_FLIGHT ||
            !is_new(context, row) || !counts(context, row))
            continue;
        groups->begun[groups->begun_count++] = row;
    }
}

/* Lists the bodies that are new and near others. */
static void list_all_new(struct contact_groups *groups, struct response_context *context,
                         new_body *counts)
{
    uint32_t kept = 0;
    /* In the first frame all are new, and other simulators correct bodies that are not. */
    bool any = context->next->head->tick == 1 || context->world->params->remotes_max != 0;
    groups->begun_count = 0;
    for (uint32_t w = 0; w * 64 < context->next->head->used; w++)
        list_new(groups, context, w * 64, any ? UINT64_MAX : context->fresh[w], counts);
    broad_phase_expect_queries(context->broad, groups->begun_count);
    contact_queue_find_alone(context->contacts, &context->input, groups->begun,
                             groups->begun_count);
    for (uint32_t i = 0; i < groups->begun_count; i++) {
        if (!contact_queue_alone(context->contacts, groups->begun[i]))
            groups->begun[kept++] = groups->begun[i];
    }
    groups->begun_count = kept;
}

static void find_new(struct contact_groups *groups, struct response_context *context)
{
    list_all_new(groups, context, path_change_grounded);
    for (uint32_t i = 0; i < groups->begun_count; i++) {
        body_motion_require(context->motion, groups->begun[i]);
        add_pairs_of(groups, context, groups->begun[i]);
    }
}

static bool is_any(const struct response_context *context, uint32_t row)
{
    (void)context;
    (void)row;
    return true;
}

void contact_groups_find_begun(struct contact_groups *groups, struct response_context *context)
{
    list_all_new(groups, context, is_any);
}

void contact_groups_find(struct contact_groups *groups, struct response_context *context)
{
    const struct state *committed = context->motion->committed;
    groups->count = 0;
    list_stirred(groups, context);
    for (uint32_t i = 0; i < groups->stirred_count; i++) {
        const struct persistent_contact *contact = &committed->contacts[groups->stirred[i]];
        if (!still_there(groups, context, contact))
            continue;
        struct pair pair = pair_of(contact);
        add(groups, pair, groups->stirred[i]);
        if (contact->flags & PERSISTENT_CONTACT_HOLDS)
            note_holding(groups, &pair);
        if (contact->flags & PERSISTENT_CONTACT_OVERLAPS)
            groups->awake[pair.a] = 1;
    }
    uint32_t all = groups->count;
    wake(groups, context);
    keep_awake(groups);
    put_back(groups, context, all);
    forget_ground(groups);
    groups->known = groups->count;
    find_new(groups, context);
    sort_words(&groups->pair[groups->known], groups->count - groups->known);
}

void contact_groups_find_free(struct contact_groups *groups, struct response_context *context)
{
    const struct state *committed = context->motion->committed;
    bool any = false;
    groups->count = groups->known = 0;
    list_all_new(groups, context, contact_groups_in_air);
    for (uint32_t i = 0; !context->contacts_sleep && i < committed->head->contact_count; i++) {
        const struct persistent_contact *contact = &committed->contacts[i];
        bool a = is_there(context, contact->a_row, contact->a_id);
        bool b = is_there(context, contact->b_row, contact->b_id);
        any |= a && b && is_free_pair(groups, context, contact);
        if (a && !b)
            wake_wreck(context, contact->a_row);
        if (b && !a && !(contact->b_id & PERSISTENT_CONTACT_FIXED))
            wake_wreck(context, contact->b_row);
    }
    if (!any) {
        forget_ground(groups);
        return;
    }
    list_stirred(groups, context);
    for (uint32_t i = 0; i < groups->stirred_count; i++) {
        const struct persistent_contact *contact = &committed->contacts[groups->stirred[i]];
        if (!is_there(context, contact->a_row, contact->a_id) ||
            !is_there(context, contact->b_row, contact->b_id) ||
            !is_free_pair(groups, context, contact))
            continue;
        struct pair pair = pair_of(contact);
        add(groups, pair, groups->stirred[i]);
        if (contact->flags & PERSISTENT_CONTACT_OVERLAPS)
            groups->awake[pair.a] = 1;
    }
    wake(groups, context);
    keep_awake(groups);
    forget_ground(groups);
    groups->known = groups->count;
}
