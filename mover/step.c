/* The mover's step: copy, commands, every row for itself, then what reaches beyond a row. */
#include "mover/step.h"

#include "mover/percept.h"
#include "mover/serial.h"
#include "mover/turret.h"

#include <string.h>

#define PREFETCH_ROWS 8

int mover_init(struct mover *mover, const struct world *world, const struct crater *craters,
               struct workers *workers)
{
    *mover = (struct mover){.world = world, .workers = workers};
    avoid_init(&mover->avoid, world);
    if (crater_index_init(&mover->craters, craters) == 0 &&
        near_init(&mover->near, world->params->capacity) == 0 &&
        outlook_init(&mover->outlook, world, &mover->craters) == 0)
        return 0;
    mover_free(mover);
    return -1;
}

void mover_free(struct mover *mover)
{
    crater_index_free(&mover->craters);
    near_free(&mover->near);
    outlook_free(&mover->outlook);
}

static void move_row(const struct move *move, uint32_t i)
{
    struct entities *m = move->m;
    struct wish wish;
    bool blocked = false;
    m->trigger[i] = 0;
    if (m->state[i] == ENTITY_WRECK) {
        move_wreck(move, i);
        return;
    }
    if (m->behaviour[i] == BEHAVIOUR_FLIGHT) {
        move_flight(move, i);
        return;
    }
    spin_row(move, i);
    if (!agent_think(move, i, &wish)) {
        move_hold(move, i);
        turret_turn(move, i);
        return;
    }
    switch ((enum domain)move->world->kinds[m->kind[i]].domain) {
    case DOMAIN_SEA:
        blocked = move_sea(move, i, &wish);
        break;
    case DOMAIN_AIR:
        blocked = move_air(move, i, &wish);
        break;
    default:
        blocked = move_land(move, i, &wish);
        break;
    }
    if (blocked)
        agent_blocked(move, i);
    turret_turn(move, i);
    turret_hold_fire(move, i);
}

static void move_piece(const struct move *move, uint32_t first, uint32_t end)
{
    const struct entities *w = &move->committed->entities;
    for (uint32_t i = first; i < end; i++) {
        if (i + PREFETCH_ROWS < end)
            terrain_prefetch(&move->world->terrain, w->x[i + PREFETCH_ROWS],
                             w->z[i + PREFETCH_ROWS]);
        if (w->state[i] != ENTITY_FREE && move->m->id[i] == w->id[i])
            move_row(move, i);
    }
}

struct rows {
    const struct move *move;
    struct moved_pieces *pieces;
};

/* Rows that the committed world has; one spawned by a command of this frame moves from the next. A
 * piece is hashed while it is in the cache. */
static void move_rows(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct rows *rows = context;
    (void)worker;
    for (; first < end; first += CHECKSUM_ROWS) {
        uint32_t past = end - first < CHECKSUM_ROWS ? end : first + CHECKSUM_ROWS;
        move_piece(rows->move, first, past);
        row_hashes_piece(&rows->pieces->hashes, rows->move->m, first / CHECKSUM_ROWS, past);
    }
}

static void copy_rows(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct move *move = context;
    (void)worker;
    entities_copy(move->m, &move->committed->entities, first, end - first);
}

static void scenario_fires(struct serial *serial)
{
    const struct world *world = serial->move->world;
    struct state_head *head = serial->moved->head;
    const struct entities *m = &serial->moved->entities;
    while (head->fire_cursor < world->counts.fires &&
           world->fires[head->fire_cursor].tick <= head->tick) {
        const struct fire_order *order = &world->fires[head->fire_cursor++];
        uint32_t shooter = order->shooter_slot, target = order->target_slot;
        if (shooter == SLOT_NONE) {
            weapons_drop(serial, order->kind, order->x, order->z);
            continue;
        }
        /* Initial slots hold their first owner while the id is slot + 1. */
        if (!entities_alive(m, shooter, shooter + 1) || m->state[shooter] != ENTITY_ACTIVE)
            continue;
        if (target != SLOT_NONE && !entities_alive(m, target, target + 1))
            continue;
        if (target != SLOT_NONE)
            weapons_fire(serial, shooter, target, order->kind);
        else
            weapons_fire_at(serial, shooter, order->x, order->z, order->kind);
    }
}

static void pull_triggers(struct serial *serial)
{
    const struct entities *w = &serial->move->committed->entities;
    struct entities *m = &serial->moved->entities;
    uint32_t used = serial->move->committed->head->used;
    for (uint32_t i = 0; i < used; i++) {
        uint8_t trigger = m->trigger[i];
        if (trigger == 0)
            continue;
        m->trigger[i] = 0;
        serial_changes(serial, i);
        if (trigger >> TRIGGER_REASON_SHIFT) {
            struct event *event = serial_intent(serial, EVENT_AGENT);
            if (event)
                event->agent =
                    (struct event_agent){serial_party(serial, i), w->behaviour[i], m->behaviour[i],
                                         (uint32_t)(trigger >> TRIGGER_REASON_SHIFT) - 1};
            serial->moved->head->tally.agent_changes++;
        }
        if ((trigger & TRIGGER_FIRE) && entities_alive(m, m->target_slot[i], m->target_id[i]))
            weapons_fire(serial, i, m->target_slot[i], KIND_NONE);
        if (trigger & TRIGGER_FIRE_AT)
            weapons_fire_at(serial, i, m->goal_x[i], m->goal_z[i], KIND_NONE);
    }
}

static void begin_head(struct moved *moved, const struct state_head *committed)
{
    *moved->head = *committed;
    moved->head->frame = committed->frame + 1;
    moved->head->intent_count = 0;
    moved->head->advanced = 0;
    moved->head->checksum = 0;
}

/* The checksum of the table that is now whole: pieces that changed after they were hashed again. */
static uint64_t checksum(struct mover *mover, const struct moved *moved)
{
    struct moved_pieces *pieces = &mover->pieces;
    uint32_t used = moved->head->used;
    if (!moved->head->advanced)
        row_hashes_all(&pieces->hashes, &moved->entities, used, mover->workers);
    for (uint32_t i = 0; i * CHECKSUM_ROWS < used && moved->head->advanced; i++) {
        if (pieces->changed[i])
            row_hashes_piece(&pieces->hashes, &moved->entities, i, used);
    }
    memset(pieces->changed, 0, sizeof pieces->changed);
    return moved_checksum_of(moved, &pieces->hashes);
}

int mover_step(struct mover *mover, const struct state *committed, struct moved *moved,
               const struct command_source sources[COMMAND_RING_COUNT])
{
    struct state_head *head = moved->head;
    struct move move = {
        .world = mover->world,
        .craters = &mover->craters,
        .near = &mover->near,
        .outlook = &mover->outlook,
        .avoid = &mover->avoid,
        .committed = committed,
        .m = &moved->entities,
        .tick = committed->head->tick + 1,
        .think = percept_think(mover->world->params, committed->head->used),
        .turn = percept_turn(mover->world->params, committed->head->used),
        .dt_s = mover->world->params->dt_s,
    };
    struct serial serial = {.move = &move, .moved = moved, .pieces = &mover->pieces};
    struct rows rows = {&move, &mover->pieces};
    uint32_t used = committed->head->used;
    if (crater_index_update(&mover->craters, committed->head->crater_count) != 0)
        return -1;
    begin_head(moved, committed->head);
    workers_run(mover->workers, copy_rows, &move, used, CHECKSUM_ROWS);
    commands_apply(&serial, sources);
    if (!head->paused || head->steps_left > 0) {
        if (head->paused)
            head->steps_left--;
        head->advanced = 1;
        head->tick = move.tick;
        near_build(&mover->near, &committed->entities, used);
        mover->outlook.fixed_damage = committed->fixed_damage;
        workers_run(mover->workers, move_rows, &rows, used, CHECKSUM_ROWS);
        scenario_fires(&serial);
        pull_triggers(&serial);
    }
    head->checksum = checksum(mover, moved);
    return 0;
}
