/* The mover's step: copy, commands, every row for itself, then what reaches beyond a row. */
#include "mover/step.h"

#include "mover/motion/aircraft.h"
#include "mover/agent/attack.h"
#include "mover/motion/constant_course.h"
#include "mover/motion/ground_vehicle.h"
#include "mover/agent/perception.h"
#include "mover/context/serial_context.h"
#include "mover/agent/think_schedule.h"
#include "mover/weapon/turret.h"
#include "mover/motion/wreck.h"

#include <stdlib.h>
#include <string.h>

#define PIECES_A_WORKER 2u /* at a time */
#define ROWS_A_WORKER   (PIECES_A_WORKER * CHECKSUM_ROWS)

int mover_init(struct mover *mover, const struct world *world, const struct crater *craters,
               struct thread_pool *workers)
{
    *mover = (struct mover){.world = world, .workers = workers};
    piece_hashes_blank(&mover->blank);
    avoidance_init(&mover->avoid, world);
    mover->patches = calloc(world->params->capacity + GROUND_POSE_AHEAD, sizeof *mover->patches);
    mover->patches_ahead = calloc(world->params->capacity, sizeof *mover->patches_ahead);
    if (mover->patches && mover->patches_ahead && ground_marks_init(&mover->scars, world) == 0 &&
        slope_max_map_init(&mover->easy, &world->terrain) == 0 &&
        crater_index_init(&mover->craters, craters) == 0 &&
        neighbour_index_init(&mover->near, world->params->capacity) == 0 &&
        neighbour_lists_init(&mover->company, world->params->capacity) == 0 &&
        line_of_sight_init(&mover->outlook, world, &mover->craters) == 0)
        return 0;
    mover_free(mover);
    return -1;
}

void mover_free(struct mover *mover)
{
    crater_index_free(&mover->craters);
    neighbour_index_free(&mover->near);
    neighbour_lists_free(&mover->company);
    line_of_sight_free(&mover->outlook);
    ground_marks_free(&mover->scars);
    slope_max_map_free(&mover->easy);
    free(mover->patches);
    free(mover->patches_ahead);
}

struct rows {
    const struct step_context *move;
    struct table committed, moved;
    const struct state_head *head; /* of moved */
    struct moved_pieces *pieces;
    const struct piece_hashes *blank;
    bool known; /* moved is what this process left: the rows before collisions changed some */
};

/* Rows that move together: those of a piece of the table that have yet to. */
struct together {
    const struct row_block *piece;
    uint8_t motion[CHECKSUM_ROWS];
    struct ground_vehicle land;
    struct aircraft air;
    struct constant_course hold;
    struct wrecks wrecks;
};

/* What follows a vehicle's own motion. */
static void after_motion(const struct step_context *move, struct together *together, uint32_t i,
                         bool blocked)
{
    uint8_t *motion = &together->motion[i - together->piece->first];
    if (blocked) {
        agent_blocked(move, i);
        *motion = MOTION_AGENT;
    }
    if (*motion == MOTION_COURSE && piece_lacks(together->piece, GUN_COLUMNS))
        return;
    struct turret_solution solution;
    turret_turn(move, i, &solution);
    turret_hold_fire(move, i, &solution);
}

static void move_land(const struct step_context *move, struct together *together)
{
    struct ground_vehicle *land = &together->land;
    ground_vehicle_move(move, land);
    for (int l = 0; l < land->count; l++)
        after_motion(move, together, land->row[l], land->blocked.lane[l] != 0);
    land->count = 0;
}

static void move_air(const struct step_context *move, struct together *together)
{
    struct aircraft *air = &together->air;
    aircraft_move(move, air);
    for (int l = 0; l < air->count; l++)
        after_motion(move, together, air->row[l], air->blocked.lane[l] != 0);
    air->count = 0;
}

static void move_hold(const struct step_context *move, struct together *together)
{
    struct constant_course *hold = &together->hold;
    const bool guns = !piece_lacks(together->piece, GUN_COLUMNS);
    constant_course_pose(move, hold);
    for (int l = 0; l < hold->count; l++) {
        if (guns && move->m->state[hold->row[l]] != ENTITY_WRECK)
            turret_turn(move, hold->row[l], &(struct turret_solution){0});
    }
    hold->count = 0;
}

static void move_wrecks(const struct step_context *move, struct together *together)
{
    struct wrecks *wrecks = &together->wrecks;
    wrecks_find_ground(move, wrecks);
    for (int l = 0; l < wrecks->count; l++) {
        uint32_t i = wrecks->row[l];
        if (wreck_row(move, i, wrecks->y.lane[l]) && constant_course_take(move, &together->hold, i))
            move_hold(move, together);
    }
    wrecks->count = 0;
}

static void move_by_wish(const struct step_context *move, uint32_t i,
                         const struct desired_motion *wish, struct together *together)
{
    switch ((enum domain)move->world->kinds[move->m->kind[i]].domain) {
    case DOMAIN_SEA:
        after_motion(move, together, i, ship_move(move, i, wish));
        break;
    case DOMAIN_AIR:
        if (aircraft_take(move, &together->air, i, wish))
            move_air(move, together);
        break;
    default:
        if (ground_vehicle_take(move, &together->land, i, wish))
            move_land(move, together);
        break;
    }
}

/* By the controls that its agent set. */
static void move_held(const struct step_context *move, uint32_t i, struct together *together)
{
    struct desired_motion wish;
    if (move->world->kinds[move->m->kind[i]].domain != DOMAIN_LAND) {
        agent_hold(move, i, &wish);
        move_by_wish(move, i, &wish, together);
    } else if (ground_vehicle_take_held(move, &together->land, i)) {
        move_land(move, together);
    }
}

static void move_row(const struct step_context *move, uint32_t i, struct together *together)
{
    struct desired_motion wish;
    switch ((enum motion)together->motion[i - together->piece->first]) {
    case MOTION_NONE:
        break;
    case MOTION_WRECK:
        if (wrecks_take(move, &together->wrecks, i))
            move_wrecks(move, together);
        break;
    case MOTION_FLIGHT:
        projectile_move(move, i);
        break;
    case MOTION_HOLD:
        if (!constant_course_row(move, i))
            turret_turn(move, i, &(struct turret_solution){0});
        else if (constant_course_take(move, &together->hold, i))
            move_hold(move, together);
        break;
    case MOTION_ALONE:
        agent_alone(move, i, &wish);
        move_by_wish(move, i, &wish, together);
        break;
    case MOTION_COURSE:
    case MOTION_AGENT:
        move_held(move, i, together);
        break;
    }
}

static void move_rest(const struct step_context *move, struct together *together)
{
    if (together->land.count > 0)
        move_land(move, together);
    if (together->air.count > 0)
        move_air(move, together);
    if (together->wrecks.count > 0)
        move_wrecks(move, together);
    if (together->hold.count > 0)
        move_hold(move, together);
}

/* What no row changes of itself: commands, shots and collisions do. */
#define STILL_COLUMNS                                                                              \
    (COLUMN_BIT(harm_j) | COLUMN_BIT(bump_heading) | COLUMN_BIT(id) | COLUMN_BIT(owner_slot) |     \
     COLUMN_BIT(owner_id) | COLUMN_BIT(touch_body) | COLUMN_BIT(touch_tick) |                      \
     COLUMN_BIT(born_tick) | COLUMN_BIT(changed_tick) | COLUMN_BIT(kind) | COLUMN_BIT(state) |     \
     COLUMN_BIT(force) | COLUMN_BIT(damage))

/* Columns that motion changes; and those of a gun that is laid. */
#define MOTION_COLUMNS                                                                             \
    (COLUMN_BIT(x) | COLUMN_BIT(y) | COLUMN_BIT(z) | COLUMN_BIT(vx) | COLUMN_BIT(vy) |             \
     COLUMN_BIT(vz) | COLUMN_BIT(heading) | COLUMN_BIT(pitch) | COLUMN_BIT(roll) |                 \
     COLUMN_BIT(fuel_l))
#define LAID_COLUMNS (GUN_COLUMNS | COLUMN_BIT(trigger))

/* Columns that are as blank as they were: those in which nobody has written who did more than go
 * on, or only zeros. */
static uint64_t still_blank(const struct rows *rows, const struct together *together)
{
    const struct row_block *piece = together->piece;
    uint64_t columns = piece->blank & ~STILL_COLUMNS & ~MOTION_COLUMNS & ~SPIN_COLUMNS;
    /* What does not turn does not begin to; what turns may turn about another axis. */
    uint64_t spins = piece_lacks(piece, SPIN_COLUMNS) ? SPIN_COLUMNS : 0;
    uint32_t row[CHECKSUM_ROWS], count = 0;
    if (!piece_lacks(piece, GUN_COLUMNS))
        columns &= ~LAID_COLUMNS;
    for (uint32_t i = piece->first; i < piece->end; i++) {
        enum motion how = (enum motion)together->motion[i - piece->first];
        if (how != MOTION_NONE && how != MOTION_HOLD && how != MOTION_COURSE)
            row[count++] = i;
    }
    return spins | table_zero(rows->moved, columns, row, count);
}

/* Returns the columns that are as they were. */
static uint64_t move_piece(const struct rows *rows, const struct row_block *piece)
{
    const struct step_context *move = rows->move;
    struct together together;
    together.piece = piece;
    think_schedule_take(move, piece, together.motion);
    ground_vehicle_begin(&together.land);
    aircraft_begin(&together.air);
    constant_course_begin(&together.hold);
    wrecks_begin(&together.wrecks);
    for (uint32_t i = piece->first; i < piece->end; i++)
        move_row(move, i, &together);
    move_rest(move, &together);
    return still_blank(rows, &together);
}

/* Rows that the committed world has; one spawned by a command of this frame moves from the next. A
 * piece is hashed while it is in the cache. */
static void move_rows(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct rows *rows = context;
    (void)worker;
    for (; first < end; first += CHECKSUM_ROWS) {
        uint32_t number = first / CHECKSUM_ROWS;
        uint64_t *changed = &rows->pieces->changed[number];
        const struct row_block piece = {
            .first = first,
            .end = end - first < CHECKSUM_ROWS ? end : first + CHECKSUM_ROWS,
            .changed = *changed,
            .blank = ~*changed & table_blank(rows->committed, number,
                                             rows->move->committed->head->used, rows->blank),
        };
        uint64_t same = move_piece(rows, &piece);
        table_hash_piece(rows->moved, number, rows->head->used,
                         *changed | (COLUMNS_ALL & ~STILL_COLUMNS & ~same));
        *changed = 0;
    }
}

/* Of a table of which nothing is known the hashes are not either. */
static void take_pieces(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct rows *rows = context;
    (void)worker;
    for (uint32_t piece = first; piece < end; piece++) {
        table_take(rows->moved, rows->committed, piece, rows->move->committed->head->used,
                   rows->known);
        rows->pieces->changed[piece] = rows->known ? 0 : COLUMNS_ALL;
    }
}

static void scenario_fires(struct serial_context *serial)
{
    const struct world *world = serial->move->world;
    struct state_head *head = serial->moved->head;
    const struct entities *m = &serial->moved->entities;
    while (head->fire_cursor < world->counts.fires &&
           world->fires[head->fire_cursor].tick <= head->tick) {
        const struct fire_order *order = &world->fires[head->fire_cursor++];
        uint32_t shooter = order->shooter_slot, target = order->target_slot;
        if (shooter == SLOT_NONE) {
            fire_drop_bomb(serial, order->kind, order->x, order->z);
            continue;
        }
        /* Initial slots hold their first owner while the id is slot + 1. */
        if (!entities_alive(m, shooter, shooter + 1) || m->state[shooter] != ENTITY_ACTIVE)
            continue;
        if (target != SLOT_NONE && !entities_alive(m, target, target + 1))
            continue;
        if (target != SLOT_NONE)
            fire_shoot(serial, shooter, target, order->kind);
        else
            fire_shoot_at(serial, shooter, order->x, order->z, order->kind);
    }
}

static void pull_trigger(struct serial_context *serial, uint32_t i)
{
    const struct entities *w = &serial->move->committed->entities;
    struct entities *m = &serial->moved->entities;
    uint8_t trigger = m->trigger[i];
    m->trigger[i] = 0;
    serial_context_changes(serial, i, COLUMN_BIT(trigger));
    if (trigger >> TRIGGER_REASON_SHIFT) {
        struct event *event = serial_context_intent(serial, EVENT_AGENT);
        if (event)
            event->agent = (struct event_agent){serial_context_party(serial, i), w->behaviour[i],
                                                m->behaviour[i],
                                                (uint32_t)(trigger >> TRIGGER_REASON_SHIFT) - 1};
        serial->moved->head->tally.agent_changes++;
    }
    if ((trigger & TRIGGER_FIRE) && entities_alive(m, m->target_slot[i], m->target_id[i]))
        fire_shoot(serial, i, m->target_slot[i], KIND_NONE);
    if (trigger & TRIGGER_FIRE_AT)
        fire_shoot_at(serial, i, m->goal_x[i], m->goal_z[i], KIND_NONE);
}

/* Few rows have one: those that do not are passed over eight at a time. */
static void pull_triggers(struct serial_context *serial)
{
    const uint8_t *trigger = serial->moved->entities.trigger;
    uint32_t used = serial->move->committed->head->used;
    for (uint32_t first = 0; first < used; first += 8) {
        uint32_t end = used - first < 8 ? used : first + 8;
        uint64_t eight = 0;
        memcpy(&eight, trigger + first, end - first);
        for (uint32_t i = first; i < end && eight != 0; i++) {
            if (trigger[i] != 0)
                pull_trigger(serial, i);
        }
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

/* Does the moved table hold what this process left in it for the frame that is now committed? Then
 * it differs from that frame only where collisions changed it. */
static bool is_own(const struct mover *mover, const struct state *committed,
                   const struct moved *moved)
{
    return mover->left != 0 && moved->head->checksum == mover->left &&
           moved->head->frame == committed->head->frame &&
           moved->head->used == committed->head->used;
}

/* The checksum of the table that is now whole. */
static uint64_t checksum(struct mover *mover, const struct moved *moved)
{
    uint32_t used = moved->head->used;
    table_hash(moved_table(moved), used, mover->pieces.changed, mover->workers);
    memset(mover->pieces.changed, 0, sizeof mover->pieces.changed);
    return moved_checksum_of(moved, rows_hash(moved->hashes, used));
}

void mover_step(struct mover *mover, const struct state *committed, struct moved *moved,
                const struct command_source sources[COMMAND_RING_COUNT])
{
    struct state_head *head = moved->head;
    struct step_context move = {
        .world = mover->world,
        .craters = &mover->craters,
        .near = &mover->near,
        .outlook = &mover->outlook,
        .avoid = &mover->avoid,
        .company = &mover->company,
        .committed = committed,
        .scars = &mover->scars,
        .easy = &mover->easy,
        .m = &moved->entities,
        .patches = mover->patches,
        .patches_ahead = mover->patches_ahead,
        .tick = committed->head->tick + 1,
        .think = perception_think(mover->world->params, committed->head->used),
        .turn = perception_turn(mover->world->params, committed->head->used),
        .aim = attack_aim(mover->world->params),
        .dt_s = mover->world->params->dt_s,
    };
    struct serial_context serial = {.move = &move, .moved = moved, .pieces = &mover->pieces};
    struct rows rows = {.move = &move,
                        .committed = state_table(committed),
                        .moved = moved_table(moved),
                        .head = head,
                        .pieces = &mover->pieces,
                        .blank = &mover->blank,
                        .known = is_own(mover, committed, moved)};
    uint32_t used = committed->head->used;
    crater_index_update(&mover->craters, committed->head->crater_count);
    begin_head(moved, committed->head);
    thread_pool_run(mover->workers, take_pieces, &rows, piece_count(used), PIECES_A_WORKER);
    command_apply_all(&serial, sources);
    if (!head->paused || head->steps_left > 0) {
        if (head->paused)
            head->steps_left--;
        head->advanced = 1;
        head->tick = move.tick;
        neighbour_index_build(&mover->near, &committed->entities, used, (uint32_t)move.tick,
                              move.think, mover->workers);
        neighbour_lists_gather(&mover->company, &mover->near, mover->world, &mover->avoid,
                               mover->workers);
        mover->outlook.fixed_damage = committed->fixed_damage;
        ground_marks_update(&mover->scars, mover->world, committed);
        thread_pool_run(mover->workers, move_rows, &rows, used, ROWS_A_WORKER);
        scenario_fires(&serial);
        pull_triggers(&serial);
    }
    mover->left = head->checksum = checksum(mover, moved);
}
