/* Persistent contacts: pairs of bodies that bear a load on each other from frame to frame. Each
 * world buffer has its own list of them, sorted by the pair, because an entry changes and ends
 * (docs/decisions/030-table-of-contacts.md). */
#ifndef JOLON_WORLD_ENTITY_PERSISTENT_CONTACT_H
#define JOLON_WORLD_ENTITY_PERSISTENT_CONTACT_H

#include <stdint.h>

/* Set in b_id: the other bits are the index of a fixed object. Ids of entities never have it. */
#define PERSISTENT_CONTACT_FIXED 0x80000000u

/* A flag: the bodies overlap and have to part, even if nothing moves them. */
#define PERSISTENT_CONTACT_OVERLAPS 1u
/* A flag: both bodies ended the frame where they began it, because one was kept from moving into
 * the other (collider/resting/held_rest.h). */
#define PERSISTENT_CONTACT_HOLDS 2u
/* A flag: they were so deep in each other that they part without impacts. */
#define PERSISTENT_CONTACT_PARTS 4u

#define PERSISTENT_CONTACT_IMPACTS_MAX UINT16_MAX

/* The default length of the list: for each slot of the world's capacity, up to so many slots, and
 * one more for each slot beyond; but at least. No crowd of that size is one heap. */
#define PERSISTENT_CONTACTS_AN_ENTITY 4u
#define PERSISTENT_CONTACT_ENTITIES   16384u
#define PERSISTENT_CONTACT_SLOTS_MIN  256u
#define PERSISTENT_CONTACT_SLOTS_MAX  (1u << 22) /* 4 for each slot of the largest capacity */

/* Between which vertices the nearest points of two hulls lay a frame ago. The search for the
 * nearest points begins there (collider/geometry/gjk.h). The last bits of its result depend on
 * where it begins, so these numbers are a part of the world. They are a hint: any value gives a
 * right distance. a: the body with the lower row, and the entity beside a fixed object. */
struct nearest_vertices {
    uint8_t hulls;      /* HULLS_A_MODEL * hull of a + hull of b */
    uint8_t count;      /* of vertices, at most 3; 0: they are not known */
    uint8_t a[3], b[3]; /* vertices of the hulls */
};

#define PERSISTENT_CONTACT_NEAREST 4u /* pairs of hulls that a contact remembers */

/* The impulses that two hulls bore at the two ends of their contact, of which a short contact has
 * only the first. The solver begins there in the next frame (collider/solver/level_solver.h). */
struct contact_load {
    float normal_ns[2];   /* along the normal, >= 0 */
    float friction_ns[2]; /* across it, to the left of the normal from a to b */
};

struct persistent_contact {
    uint32_t a_id;         /* an entity; less than b_id unless b is a fixed object */
    uint32_t b_id;         /* an entity, or PERSISTENT_CONTACT_FIXED | a fixed object's index */
    uint32_t a_row, b_row; /* of these entities; b_row of a fixed object: SLOT_NONE */
    uint32_t begin_tick;   /* of simulated time: when it first bore a load */
    uint32_t pressed_tick; /* when it last bore a load */
    uint16_t flags;        /* PERSISTENT_CONTACT_OVERLAPS, _HOLDS, _PARTS */
    uint16_t impacts;      /* since it began, PERSISTENT_CONTACT_IMPACTS_MAX at most */
    float impulse_ns;      /* of all these impacts together */
    struct nearest_vertices nearest[PERSISTENT_CONTACT_NEAREST];
    struct contact_load load[PERSISTENT_CONTACT_NEAREST]; /* of the pairs of hulls in nearest */
};

_Static_assert(sizeof(struct persistent_contact) == 128, "shared layout");

/* Returns the key of a contact. The list rises strictly by it: by a_id, then b_id, fixed objects
 * last. */
static inline uint64_t persistent_contact_key(const struct persistent_contact *contact)
{
    return (uint64_t)contact->a_id << 32 | contact->b_id;
}

#endif
