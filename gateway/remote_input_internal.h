/* What the parts of remote_input share: remote_input.c has the entities and remote_input_events.c
 * their shots and collisions. One thread; nothing blocks. */
#ifndef JOLON_GATEWAY_REMOTE_INPUT_INTERNAL_H
#define JOLON_GATEWAY_REMOTE_INPUT_INTERNAL_H

#include "gateway/remote_input.h"

#define REMOTE_INPUT_SPEED_MPS 10000.0 /* nothing is faster */

static inline struct vec3 vec3_of(const float value[3])
{
    return (struct vec3){(double)value[0], (double)value[1], (double)value[2]};
}

static inline uint64_t id_of(struct pdu_id id)
{
    return remote_id(id.site, id.application, id.entity);
}

/* Writes a record into the ring. Velocities of other simulators are by the clock, and those in the
 * ring by simulated time. Returns 0, or -1 if the ring is full. */
int remote_input_append(struct remote_input *input, struct view *view, struct remote_record record);

/* Returns true if a place is one of the world, and else counts why not. */
bool remote_input_in_world(struct remote_input *input, struct vec3 at);

/* Returns a place of the world. One that is nowhere near is outside the square. */
struct vec3 remote_input_place(const struct remote_input *input, const double location[3]);

/* Returns the kind of a type, and notes the type if it is none of ours. */
uint16_t remote_input_kind(struct remote_input *input, struct pdu_entity_type type, bool munition);

/* Returns true if a sender is the owner of an entity. */
bool remote_input_owns(const struct remote_input *input, const struct remote_entry *entry,
                       const struct udp_address *from, uint64_t now_ns);

/* Tells that an entity is lost. */
void remote_input_lose(struct remote_input *input, struct view *view, struct remote_entry *entry);

/* Take a PDU. */
void remote_input_fire(struct remote_input *input, struct view *view, const struct pdu *pdu,
                       uint64_t now_ns);
void remote_input_detonation(struct remote_input *input, struct view *view, const struct pdu *pdu,
                             const struct udp_address *from, uint64_t now_ns);
void remote_input_collision(struct remote_input *input, const struct pdu *pdu, uint64_t now_ns);

/* Tells of the collisions that our collider has not told of in time. */
void remote_input_tell_bodies(struct remote_input *input, struct view *view, uint64_t now_ns);

#endif
