/* Records of remote entities for tests. */
#include "tests/support/remotes.h"

struct remote_record remotes_track(const struct fixture *fixture, uint64_t remote,
                                   struct vec3 place)
{
    return (struct remote_record){.remote = remote,
                                  .type = REMOTE_TRACK,
                                  .slot = SLOT_NONE,
                                  .kind = fixture_kind(fixture, "tank"),
                                  .force = FORCE_RED,
                                  .model = DEAD_RECKONING_STATIC,
                                  .position = {place.x, place.y, place.z}};
}

void remotes_send(struct fixture *fixture, struct remote_record record)
{
    steps_send(fixture, RING_GATEWAY, remote_record_slot(&record));
}

uint32_t remotes_row(const struct fixture *fixture, uint64_t remote)
{
    const struct state state = fixture_state(fixture);
    for (uint32_t row = 0; row < state.head->used; row++) {
        if (remote_is(&state.entities, row) && state.entities.row[row].driver == remote)
            return row;
    }
    return SLOT_NONE;
}

struct remote_record remotes_any(const struct fixture *fixture, uint64_t *random)
{
    static const char *const kinds[] = {"tank", "jeep", "jet", "helicopter", "shell", "artillery"};
    struct vec3 place = {fixture_uniform(random, 24900.0, 25100.0),
                         fixture_uniform(random, 95.0, 140.0),
                         fixture_uniform(random, 24900.0, 25100.0)};
    struct remote_record record =
        remotes_track(fixture, remote_id(7, 1, (uint16_t)(1 + fixture_random(random) % 12)), place);
    uint64_t draw = fixture_random(random) % 16;
    record.kind = fixture_kind(fixture, kinds[fixture_random(random) % 4]);
    record.model = (uint8_t)(1 + fixture_random(random) % 9);
    record.flags = (uint8_t)(fixture_random(random) % 2);
    record.force = (uint8_t)(fixture_random(random) % FORCE_COUNT);
    record.damage = (uint8_t)(fixture_random(random) % DAMAGE_COUNT);
    record.turret = (int16_t)fixture_random(random);
    for (int i = 0; i < 3; i++) {
        record.velocity[i] = (float)fixture_uniform(random, -30.0, 30.0);
        record.acceleration[i] = (float)fixture_uniform(random, -3.0, 3.0);
        record.rates[i] = (float)fixture_uniform(random, -1.0, 1.0);
        record.attitude[i] = (float)fixture_uniform(random, -3.0, 3.0);
    }
    if (draw < 10)
        return record;
    record.type = draw < 12 ? REMOTE_LOST : draw < 14 ? REMOTE_FIRE : REMOTE_STRUCK;
    record.kind = fixture_kind(fixture, kinds[4 + fixture_random(random) % 2]);
    record.entity = (uint32_t)(fixture_random(random) % 3);
    if (record.type == REMOTE_STRUCK && record.entity != 0) {
        for (int i = 0; i < 3; i++)
            record.position[i] = fixture_uniform(random, -2.0, 2.0);
    }
    if (fixture_random(random) % 32 == 0)
        record.position[1] = (double)NAN;
    return record;
}
