/* What tests of gateway/remote_input.c share: a small world with a tank of ours, which takes what
 * the gateway has written into its ring. The test has its own clock. */
#ifndef JOLON_TESTS_UNIT_GATEWAY_REMOTE_STAGE_H
#define JOLON_TESTS_UNIT_GATEWAY_REMOTE_STAGE_H

#include "gateway/earth/euler.h"
#include "gateway/remote_input.h"
#include "ipc/process/clock.h"
#include "tests/support/remotes.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static struct fixture f;
static struct remote_input input;
static struct type_table types;
static struct local_frame frame;
static struct snapshot snapshot;
static struct error_text error;
static struct udp_address peer, other;
static uint64_t now_ns;

static inline void open_input(void)
{
    char path[512];
    const struct world *world = &f.view.world;
    memset(&input, 0, sizeof input);
    snprintf(path, sizeof path, "%s/dis/types.txt", fixture_shipped_dir());
    assert_int_equal(type_table_read(&types, path, world->kinds, world->counts.kinds, &error), 0);
    input.types = &types;
    input.frame = &frame;
    input.own = (struct entity_ids){1991, 10, 2};
    input.clamp = true;
    input.timeout_ns = 12 * (uint64_t)NS_PER_S;
    assert_int_equal(remote_input_open(&input, &f.view, now_ns, &error), 0);
}

static inline int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; remotes_max = 4; }; vehicles = ();");
    fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                            .at = {25000.0, FIXTURE_GROUND_M, 25000.0},
                                            .force = FORCE_BLUE});
    local_frame_make(&frame, 35.95, -121.25, -33.7, 25000.0, 25000.0);
    assert_int_equal(snapshot_init(&snapshot, &f.view), 0);
    assert_int_equal(udp_address_parse(&peer, "127.0.0.1:40000", 0, &error), 0);
    assert_int_equal(udp_address_parse(&other, "127.0.0.1:40001", 0, &error), 0);
    now_ns = 1000 * (uint64_t)NS_PER_S;
    open_input();
    return 0;
}

static inline int close_world(void **state)
{
    remote_input_close(&input);
    snapshot_free(&snapshot);
    return fixture_teardown(state);
}

/* Lets the world take what was told, and the gateway see it. */
static inline void pass(double seconds)
{
    remote_input_tell(&input, &f.view, now_ns);
    fixture_run(&f, 2);
    now_ns += (uint64_t)(seconds * 1e9);
    assert_int_equal(snapshot_take(&snapshot, &f.view), 0);
    remote_input_see(&input, &f.view, &snapshot, now_ns);
    remote_input_tell(&input, &f.view, now_ns);
    fixture_run(&f, 1);
}

static inline struct pdu state_of(uint16_t entity, struct vec3 at)
{
    static struct pdu pdu;
    struct vec3 ecef = local_frame_ecef(&frame, at);
    struct mat3 turn = rotation_matrix(rotation_of(1.0, 0.1, -0.2));
    struct mat3 matrix = local_frame_ecef_turn(&frame.axes, &turn);
    struct euler angles = euler_of(&matrix);
    memset(&pdu, 0, sizeof pdu);
    pdu.header.type = PDU_ENTITY_STATE;
    pdu.entity_state = (struct pdu_entity_state){.id = {7, 1, entity},
                                                 .force = PDU_FORCE_OPPOSING,
                                                 .type = {1, 1, 222, 1, 2, 1, 0}, /* T-72 */
                                                 .location = {ecef.x, ecef.y, ecef.z},
                                                 .dead_reckoning = DEAD_RECKONING_STATIC,
                                                 .marking = "T72"};
    vec3_to_floats(pdu.entity_state.orientation,
                   (struct vec3){angles.psi, angles.theta, angles.phi});
    return pdu;
}

static inline void take(const struct pdu *pdu, const struct udp_address *from)
{
    assert_true(remote_input_take(&input, &f.view, pdu, from, now_ns));
}

/* Returns the last record that was written into the ring. */
static inline struct remote_record last_record(void)
{
    const struct command_ring_words *words = f.view.commands[RING_GATEWAY];
    uint64_t slots = layout_ring_slots(f.view.header, RING_GATEWAY);
    return remote_record_of(&words->slot[(segment_load(&words->head) - 1) & (slots - 1)]);
}

static inline uint32_t row_of(uint16_t entity)
{
    return remotes_row(&f, remote_id(7, 1, entity));
}

/* Returns the length of a vector. */
static inline double length_of(const float v[3])
{
    return sqrt((double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] +
                (double)v[2] * (double)v[2]);
}

#endif
