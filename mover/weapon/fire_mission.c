/* The course of fire missions. */
#include "mover/weapon/fire_mission.h"

#include "mover/motion/kinematics.h"
#include "mover/weapon/fire_adjustment.h"
#include "mover/weapon/turret.h"
#include "world/entity/disabled.h"
#include "world/maths/random.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

#define FASTEST_ROUNDS 12u   /* in a row; M109A2: 4 rounds a minute for 3 minutes */
#define SUSTAINED_S    60.0  /* between two rounds afterwards */
#define LAYING_S       30.0  /* guns that do not bear by then do not take part in the volley */
#define OBSERVE_S      10.0  /* from an impact to the correction */
#define STILL_MPS      0.3   /* a howitzer fires only when it stands */
#define SURVEY_M       100.0 /* standard error of the place of a target that is not adjusted */
#define SHEAF_M        30.0  /* between the impacts of two guns off the map */
#define SHEAF_S        0.3   /* and between their times */

static uint32_t ticks(const struct serial_context *context, double time_s)
{
    return (uint32_t)(time_s / context->step->dt_s + 0.5);
}

static bool is_afar(const struct battery *battery)
{
    return battery->guns == 0;
}

static bool is_howitzer(const struct serial_context *context, uint32_t row)
{
    const struct entities *m = &context->moved->entities;
    const struct kind *kinds = context->step->world->kinds;
    if (m->row[row].state != ENTITY_ACTIVE || m->row[row].behaviour == BEHAVIOUR_FLIGHT)
        return false;
    uint16_t munition = kinds[m->row[row].kind].munition;
    return !disabled_gun(&kinds[m->row[row].kind], m, row) && munition != KIND_NONE &&
           kinds[munition].delivery == DELIVERY_ARC && m->row[row].rounds > 0;
}

/* --- orders ------------------------------------------------------------------------------------*/

static bool has_gun(const struct battery *battery, uint32_t id)
{
    for (uint32_t g = 0; g < battery->guns; g++) {
        if (battery->gun_id[g] == id)
            return true;
    }
    return false;
}

/* Returns the entry of the gun's battery, or a new one; NULL: none is free. id 0: a battery off the
 * map. */
static struct battery *entry_for(struct state_head *head, uint32_t id)
{
    for (uint32_t i = 0; i < head->battery_count; i++) {
        if (id != 0 && has_gun(&head->battery[i], id))
            return &head->battery[i];
    }
    return head->battery_count < BATTERIES_MAX ? &head->battery[head->battery_count++] : NULL;
}

static double distance(const struct entities *m, uint32_t row, double x, double z)
{
    double dx = m->row[row].x - x, dz = m->row[row].z - z;
    return sqrt(dx * dx + dz * dz);
}

static void add_gun(struct battery *battery, const struct entities *m, uint32_t row)
{
    battery->gun_slot[battery->guns] = row;
    battery->gun_id[battery->guns++] = m->row[row].id;
}

/* The given gun comes first: it adjusts. */
static void gather_guns(const struct serial_context *context, struct battery *battery,
                        uint32_t first)
{
    const struct entities *m = &context->moved->entities;
    add_gun(battery, m, first);
    for (uint32_t row = 0; row < context->moved->head->used; row++) {
        if (battery->guns < BATTERY_GUNS_MAX && row != first && is_howitzer(context, row) &&
            m->row[row].force == m->row[first].force && m->row[row].kind == m->row[first].kind &&
            distance(m, row, m->row[first].x, m->row[first].z) <= FIRE_MISSION_BATTERY_M)
            add_gun(battery, m, row);
    }
}

/* Draws the errors that all rounds of the mission share. */
static void draw_errors(const struct serial_context *context, struct battery *battery,
                        bool adjusted)
{
    const struct kind *round = &context->step->world->kinds[battery->munition];
    uint32_t n = battery->number;
    battery->mean_range = (float)(FIRE_RANGE_ERROR * fire_normal(context, n, RANDOM_MEAN_RANGE));
    battery->mean_azimuth =
        (float)(round->dispersion_rad * fire_normal(context, n, RANDOM_MEAN_AZIMUTH));
    if (!adjusted)
        return;
    battery->survey_x = (float)(SURVEY_M * fire_normal(context, n, RANDOM_SURVEY_RANGE));
    battery->survey_z = (float)(SURVEY_M * fire_normal(context, n, RANDOM_SURVEY_AZIMUTH));
}

bool fire_mission_begin(struct serial_context *context, const struct fire_mission_order *order)
{
    const struct entities *m = &context->moved->entities;
    const struct kind *kinds = context->step->world->kinds;
    struct state_head *head = context->moved->head;
    bool afar = order->gun == SLOT_NONE;
    if (order->rounds == 0 ||
        (afar ? order->munition == KIND_NONE : !is_howitzer(context, order->gun)))
        return false;
    struct battery *entry = entry_for(head, afar ? 0 : m->row[order->gun].id);
    if (!entry)
        return false;
    uint16_t munition =
        order->munition == KIND_NONE ? kinds[m->row[order->gun].kind].munition : order->munition;
    uint32_t tick = (uint32_t)context->step->tick;
    *entry = (struct battery){
        .x = order->x,
        .z = order->z,
        .aim_x = order->x,
        .aim_z = order->z,
        .azimuth = (float)order->bearing_rad,
        .flight_s = afar ? (float)order->left_s : 0.0f,
        .number = tick * BATTERIES_MAX + (uint32_t)(entry - head->battery),
        .volley_tick = tick,
        .cold_tick = entry->cold_tick,
        .rounds = order->rounds,
        .munition = munition,
        .phase = order->adjusted ? BATTERY_ADJUSTS : BATTERY_FIRES,
        .fuze = order->fuze == FUZE_COUNT ? kinds[munition].fuze : order->fuze,
        .force = afar ? order->force : m->row[order->gun].force,
        .high = order->high,
    };
    if (!afar)
        gather_guns(context, entry, order->gun);
    draw_errors(context, entry, order->adjusted);
    return true;
}

static bool has_mission(const struct state_head *head, uint32_t id)
{
    for (uint32_t i = 0; i < head->battery_count; i++) {
        if (head->battery[i].phase != BATTERY_DONE && has_gun(&head->battery[i], id))
            return true;
    }
    return false;
}

bool fire_mission_can(const struct serial_context *context, uint32_t row, double x, double z)
{
    const struct entities *m = &context->moved->entities;
    return is_howitzer(context, row) && !has_mission(context->moved->head, m->row[row].id) &&
           distance(m, row, x, z) <= context->step->world->kinds[m->row[row].kind].range_m;
}

uint32_t fire_mission_gun(const struct serial_context *context, uint8_t force, double x, double z)
{
    const struct entities *m = &context->moved->entities;
    for (uint32_t row = 0; row < context->moved->head->used; row++) {
        if (m->row[row].force == force && fire_mission_can(context, row, x, z))
            return row;
    }
    return SLOT_NONE;
}

/* --- volleys -----------------------------------------------------------------------------------*/

static struct vec3 ground_point(const struct serial_context *context, double x, double z)
{
    return (struct vec3){x, kinematics_ground(context->step, x, z), z};
}

/* The point that the guns' data are for: survey errors are in the data. */
static struct vec3 aim_of(const struct serial_context *context, const struct battery *battery)
{
    return ground_point(context, battery->aim_x + (double)battery->survey_x,
                        battery->aim_z + (double)battery->survey_z);
}

static struct fire_error mean_of(const struct battery *battery)
{
    return (struct fire_error){(double)battery->mean_range, (double)battery->mean_azimuth};
}

static uint32_t guns_of(const struct battery *battery)
{
    if (battery->phase == BATTERY_ADJUSTS)
        return 1;
    return is_afar(battery) ? FIRE_MISSION_AFAR_GUNS : battery->guns;
}

static bool is_fit(const struct serial_context *context, const struct battery *battery, uint32_t g)
{
    const struct entities *m = &context->moved->entities;
    uint32_t row = battery->gun_slot[g];
    return battery->gun_id[g] != 0 && entities_alive(m, row, battery->gun_id[g]) &&
           is_howitzer(context, row);
}

/* Forgets guns that are lost or empty. The first that is left adjusts. Returns true if any is left.
 */
static bool keep_guns(const struct serial_context *context, struct battery *battery)
{
    uint32_t left = 0;
    for (uint32_t g = 0; g < battery->guns; g++) {
        if (!is_fit(context, battery, g))
            continue;
        uint32_t fired = battery->fired >> g & 1u;
        battery->gun_slot[left] = battery->gun_slot[g];
        battery->gun_id[left] = battery->gun_id[g];
        battery->fired = (battery->fired & ~(1u << left)) | fired << left;
        left++;
    }
    battery->guns = (uint8_t)left;
    return left > 0;
}

/* The middle of the muzzles of the guns that fire. */
static struct vec3 middle_of(const struct serial_context *context, const struct battery *battery)
{
    struct vec3 sum = {0.0, 0.0, 0.0};
    uint32_t guns = guns_of(battery);
    for (uint32_t g = 0; g < guns; g++)
        sum = vec3_add(
            sum, turret_muzzle(context->step, &context->moved->entities, battery->gun_slot[g]));
    return vec3_scale(sum, 1.0 / (double)guns);
}

/* All guns fire along the same direction, so that their rounds fall as they stand. */
static bool find_data(const struct serial_context *context, const struct battery *battery,
                      struct firing_arc_solution *solution)
{
    return fire_solve(context->step, middle_of(context, battery), battery->munition,
                      aim_of(context, battery), battery->high, solution);
}

/* solution: of this frame; found when the first gun fires. */
static bool fire_gun(struct serial_context *context, struct battery *battery, uint32_t g,
                     struct firing_arc_solution *solution, struct fire_error *error)
{
    const struct entities *m = &context->moved->entities;
    uint32_t row = battery->gun_slot[g];
    if (context->step->tick < m->row[row].reload_tick ||
        vec3_length(entities_velocity(m, row)) > STILL_MPS ||
        (solution->flight_s == 0.0 && !find_data(context, battery, solution)))
        return false;
    const struct fire_shell shell = {.solution = solution,
                                     .mean = mean_of(battery),
                                     .munition = battery->munition,
                                     .fuze = battery->fuze};
    return fire_shell(context, row, &shell, error);
}

static bool fire_afar_gun(struct serial_context *context, struct battery *battery, uint32_t g,
                          struct fire_error *error)
{
    struct vec3 ahead = fire_adjustment_line(battery);
    double aside = battery->phase == BATTERY_ADJUSTS
                       ? 0.0
                       : SHEAF_M * ((double)g - 0.5 * (double)(FIRE_MISSION_AFAR_GUNS - 1));
    struct vec3 point = aim_of(context, battery);
    point = ground_point(context, point.x - aside * ahead.z, point.z + aside * ahead.x);
    const struct fire_afar afar = {.point = point,
                                   .bearing_rad = (double)battery->azimuth,
                                   .left_s = (double)battery->flight_s,
                                   .mean = mean_of(battery),
                                   .errs = true,
                                   .high = battery->high != 0,
                                   .munition = battery->munition,
                                   .fuze = battery->fuze,
                                   .force = battery->force};
    return context->step->tick >= battery->volley_tick + g * ticks(context, SHEAF_S) &&
           fire_from_afar(context, &afar, error);
}

/* Lays gun g, and fires it if it is due and bears. */
static void serve_gun(struct serial_context *context, struct battery *battery, uint32_t g,
                      struct firing_arc_solution *solution)
{
    struct fire_error error = {0.0, 0.0};
    bool due = context->step->tick >= battery->volley_tick && battery->rounds > 0 &&
               !(battery->fired >> g & 1u);
    if (is_afar(battery)) {
        if (!due || !fire_afar_gun(context, battery, g, &error))
            return;
    } else {
        struct vec3 direction =
            firing_arc_unit((double)battery->azimuth, (double)battery->elevation);
        bool laid = turret_lay(context->step, &context->writer, battery->gun_slot[g], direction);
        if (!due || !laid || !fire_gun(context, battery, g, solution, &error))
            return;
    }
    battery->fired |= 1u << g;
    if (battery->phase == BATTERY_ADJUSTS)
        fire_adjustment_note(context, battery, error);
    else
        battery->rounds--;
}

/* Sets the time of the next volley by how hot the barrels are: each volley heats them for
 * SUSTAINED_S, and they bear the heat of FASTEST_ROUNDS rounds in a row. */
static void cool(const struct serial_context *context, struct battery *battery)
{
    const struct kind *kinds = context->step->world->kinds;
    const struct entities *m = &context->moved->entities;
    double reload = is_afar(battery) ? 15.0 : kinds[m->row[battery->gun_slot[0]].kind].reload_s;
    double burst_s = (double)(FASTEST_ROUNDS - 1) * maths_max(SUSTAINED_S - reload, 0.0);
    uint32_t start = battery->volley_tick, bears = ticks(context, burst_s);
    if (battery->cold_tick < start)
        battery->cold_tick = start;
    battery->cold_tick += ticks(context, SUSTAINED_S);
    uint32_t next = start + ticks(context, reload);
    if (battery->cold_tick > next + bears)
        next = battery->cold_tick - bears;
    battery->volley_tick = next;
    battery->fired = 0;
}

/* Ends the volley when all guns have fired, or the time for laying is over. */
static void end_volley(const struct serial_context *context, struct battery *battery)
{
    uint32_t tick = (uint32_t)context->step->tick, all = (1u << guns_of(battery)) - 1u;
    bool late = tick > battery->volley_tick + ticks(context, LAYING_S);
    if (battery->rounds > 0 && (battery->fired & all) != all && !late)
        return;
    if (battery->rounds == 0 || battery->fired == 0)
        battery->phase = BATTERY_DONE;
    if (battery->fired != 0)
        cool(context, battery);
}

/* The round for adjustment is in the air until next_tick. Returns true while it is. */
static bool await_correction(const struct serial_context *context, struct battery *battery)
{
    uint32_t tick = (uint32_t)context->step->tick;
    if (battery->fired == 0)
        return false;
    if (battery->next_tick == 0)
        battery->next_tick = tick + ticks(context, (double)battery->flight_s + OBSERVE_S);
    if (tick < battery->next_tick)
        return true;
    fire_adjustment_correct(context, battery);
    cool(context, battery);
    battery->flight_s = is_afar(battery) ? battery->flight_s : 0.0f;
    battery->next_tick = 0;
    battery->volley_tick = battery->volley_tick > tick ? battery->volley_tick : tick;
    return false;
}

/* Finds the data by which the guns are laid, once for each aim. Returns false if the aim is out of
 * range. */
static bool lay_data(const struct serial_context *context, struct battery *battery)
{
    struct firing_arc_solution solution;
    if (battery->flight_s > 0.0f)
        return true;
    if (!find_data(context, battery, &solution))
        return false;
    battery->azimuth = (float)solution.azimuth_rad;
    battery->elevation = (float)solution.elevation_rad;
    battery->flight_s = (float)solution.flight_s;
    return true;
}

static void run_battery(struct serial_context *context, struct battery *battery)
{
    struct firing_arc_solution solution = {.flight_s = 0.0};
    if (!is_afar(battery) && !keep_guns(context, battery)) {
        battery->phase = BATTERY_DONE;
        return;
    }
    if (battery->phase == BATTERY_ADJUSTS && await_correction(context, battery))
        return;
    if (!is_afar(battery) && !lay_data(context, battery)) {
        battery->phase = BATTERY_DONE;
        return;
    }
    uint32_t guns = guns_of(battery);
    for (uint32_t g = 0; g < guns; g++)
        serve_gun(context, battery, g, &solution);
    if (battery->phase == BATTERY_FIRES)
        end_volley(context, battery);
}

void fire_mission_run(struct serial_context *context)
{
    struct state_head *head = context->moved->head;
    uint32_t left = 0, tick = (uint32_t)context->step->tick;
    for (uint32_t i = 0; i < head->battery_count; i++) {
        struct battery *battery = &head->battery[i];
        if (battery->phase != BATTERY_DONE)
            run_battery(context, battery);
        /* The barrels of a battery off the map are not kept: each mission has other guns. */
        if (battery->phase != BATTERY_DONE || (battery->cold_tick > tick && !is_afar(battery)))
            head->battery[left++] = *battery;
    }
    for (uint32_t i = left; i < head->battery_count; i++)
        head->battery[i] = (struct battery){0};
    head->battery_count = left;
}
