/* Finds targets: candidates from the index of neighbours, a random time of search, and lines of
 * sight. */
#include "mover/agent/target_search.h"

#include "mover/agent/fire_control.h"
#include "mover/agent/smoke_screen.h"
#include "mover/motion/kinematics.h"
#include "world/maths/random.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

#define CANDIDATES     8u   /* a look considers so many enemies */
#define LINES          3u   /* lines of sight of a look */
#define EYE_SHARE      0.9  /* height of the eye as a share of the height; not of aircraft */
#define SEARCH_MOST_S  30.0 /* mean time to find an enemy at the end of the sight */
#define SEARCH_LEAST_S 1.0  /* and of one near by */
#define PREFERENCE     2.0  /* a target's distance, squared, counts up to 1 + this much */
#define FIRST          0.1  /* of that: as little counts that of air defence that it outranges */

/* --- seeing ------------------------------------------------------------------------------------*/

struct vec3 target_search_eye(const struct step_context *context, uint32_t i)
{
    struct vec3 at = step_context_position(context, &context->committed->entities, i);
    const struct kind *kind = &context->world->kinds[context->committed->entities.row[i].kind];
    if (kind->domain != DOMAIN_AIR)
        at.y += EYE_SHARE * kind->height_m;
    return at;
}

struct vec3 target_search_middle(const struct step_context *context, uint32_t i)
{
    struct vec3 at = step_context_position(context, &context->committed->entities, i);
    at.y += kinematics_aim_height(context, context->committed->entities.row[i].kind);
    return at;
}

/* Its view: all round, or a sector around the direction of its turret. */
struct sector {
    bool around;
    double sine, cosine; /* of the middle */
    double edge;         /* cosine of half the width */
};

static struct sector sector_of(const struct step_context *context, uint32_t i)
{
    const struct entities *w = &context->committed->entities;
    double wide = context->world->kinds[w->row[i].kind].view_rad;
    struct sector view = {.around = wide >= TWO_PI - 1e-9};
    if (!view.around) {
        maths_sincos(w->row[i].heading + (double)w->row[i].turret, &view.sine, &view.cosine);
        view.edge = maths_cos(0.5 * wide);
    }
    return view;
}

static bool in_view(const struct sector *view, double dx, double dz)
{
    return view->around ||
           dx * view->sine - dz * view->cosine >= view->edge * sqrt(dx * dx + dz * dz);
}

bool target_search_sees(const struct step_context *context, uint32_t i, uint32_t other)
{
    const struct entities *w = &context->committed->entities;
    struct vec3 off = vec3_sub(step_context_position(context, w, other), entities_position(w, i));
    double dx = off.x, dz = off.z;
    double sight = context->world->kinds[w->row[i].kind].sight_m;
    if (!(dx * dx + dz * dz < sight * sight))
        return false;
    struct sector view = sector_of(context, i);
    return in_view(&view, dx, dz) && !smoke_screen_between(context, i, other) &&
           line_of_sight_clear(context->line_of_sight, target_search_eye(context, i),
                               target_search_middle(context, other));
}

/* --- candidates --------------------------------------------------------------------------------*/

struct candidates {
    uint32_t count;
    uint32_t row[CANDIDATES];
    double square[CANDIDATES]; /* of the distance, weighted; ascending */
};

static void consider(struct candidates *c, uint32_t row, double square)
{
    uint32_t n = c->count < CANDIDATES ? c->count++ : CANDIDATES;
    if (n == CANDIDATES) {
        if (square >= c->square[CANDIDATES - 1])
            return;
        n--;
    }
    for (; n > 0 && c->square[n - 1] > square; n--) {
        c->square[n] = c->square[n - 1];
        c->row[n] = c->row[n - 1];
    }
    c->square[n] = square;
    c->row[n] = row;
}

/* A weight of 1 .. 1 + PREFERENCE that each pair of vehicles keeps: neighbours prefer different
 * targets among those at about the same distance. */
static double preference(const struct step_context *context, uint32_t i, uint32_t other)
{
    const struct entities *w = &context->committed->entities;
    return 1.0 + PREFERENCE * random_unit(context->world->params->seed, w->row[other].id,
                                          w->row[i].id, RANDOM_SEARCH);
}

/* Returns true if a look considers enemies that it cannot harm. A crew that is at ease minds them,
 * and takes cover; one with the order never to flee looks past them. */
static bool minds_all(const struct step_context *context, uint32_t i, enum target_search how)
{
    return how == TARGET_SEARCH_CALM && !(context->m->row[i].flags & ENTITY_FLAG_STAND);
}

static void gather(const struct step_context *context, uint32_t i, const struct sector *view,
                   double radius, enum target_search how, struct candidates *c)
{
    const struct entities *w = &context->committed->entities;
    const struct neighbour_index_entry *entry;
    struct neighbour_query query = neighbour_query_begin(
        context->neighbours, neighbour_index_enemies((enum force)w->row[i].force), w->row[i].x,
        w->row[i].z, radius);
    bool all = minds_all(context, i, how);
    c->count = 0;
    while ((entry = neighbour_query_next(&query))) {
        double dx = (double)entry->x - query.x, dz = (double)entry->z - query.z;
        double square = dx * dx + dz * dz;
        if (in_view(view, dx, dz) && fire_control_worth(context, i, entry->row, square) &&
            (all || fire_control_fights(context, i, entry->row))) {
            bool first = fire_control_outranges_m(context, i, entry->row) > 0.0;
            square *= preference(context, i, entry->row);
            consider(c, entry->row, first ? FIRST * square : square);
        }
    }
}

/* --- the search --------------------------------------------------------------------------------*/

/* Returns the tick of the look that is due now or next. An agent that may begin to cruise looks
 * ahead of it, and does so again if the stretch is refused: it is one look all the same. */
static uint64_t look_tick(const struct step_context *context, uint32_t i)
{
    uint32_t past = ((uint32_t)context->tick + context->m->row[i].id) % context->look_frames;
    return past == 0 ? context->tick : context->tick + context->look_frames - past;
}

/* Returns true if the crew finds the vehicle in this look. A look of T seconds finds it with
 * probability T / (T + mean), so that the time to find it is geometric, nearly exponential. */
static bool finds(const struct step_context *context, uint32_t i, uint32_t other, double sight)
{
    const struct entities *w = &context->committed->entities;
    struct vec3 off = vec3_sub(step_context_position(context, w, other), entities_position(w, i));
    double dx = off.x, dz = off.z;
    double share = sqrt(dx * dx + dz * dz) / maths_max(sight, 1.0);
    double mean_s = maths_clamp(SEARCH_MOST_S * share, SEARCH_LEAST_S, SEARCH_MOST_S);
    double look_s = (double)context->look_frames * context->dt_s;
    uint64_t pair = (uint64_t)w->row[i].id << 32 | w->row[other].id;
    return random_unit(context->world->params->seed, look_tick(context, i), pair, RANDOM_SEARCH) *
               (look_s + mean_s) <
           look_s;
}

/* The candidate for line of sight n. The last line goes to another one each time, so that an enemy
 * behind a hill does not hide those further away. */
static uint32_t in_turn(const struct step_context *context, const struct candidates *c, uint32_t n)
{
    if (n < LINES - 1 || c->count <= LINES)
        return n;
    return n + (uint32_t)(context->tick / context->look_frames) % (c->count - (LINES - 1));
}

uint32_t target_search(const struct step_context *context, uint32_t i, enum target_search how)
{
    double sight = context->world->kinds[context->m->row[i].kind].sight_m;
    enum force force = (enum force)context->committed->entities.row[i].force;
    struct candidates c = {0};
    uint32_t lines = 0;
    if (!(neighbour_index_enemies(force) & context->neighbours->present))
        return SLOT_NONE;
    struct sector view = sector_of(context, i);
    for (double radius = 0.25 * sight;; radius = maths_min(2.0 * radius, sight)) {
        gather(context, i, &view, radius, how, &c);
        if (c.count == CANDIDATES || radius >= sight)
            break;
    }
    for (uint32_t n = 0; n < c.count && lines < LINES; n++) {
        uint32_t row = c.row[how == TARGET_SEARCH_ALERT ? in_turn(context, &c, n) : n];
        if (how == TARGET_SEARCH_CALM && !finds(context, i, row, sight))
            continue;
        lines++;
        if (target_search_sees(context, i, row))
            return row;
    }
    return SLOT_NONE;
}
