/* Replaces a route's few points by all those of the roads between them. */
#include "world/making/road_routing.h"

#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"
#include "world/maths/maths.h"
#include "world/making/road_graph.h"
#include "world/world.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A route that is being laid along roads. */
struct laying {
    struct world_build *built;
    const struct road_graph *net;
    const struct scenario_group *group;
    char key[64]; /* of the route in the file, for messages */
    bool open;    /* it does not lead back to its first point */
    struct error_text *error;
    uint32_t room; /* of built->route_points */
};

static int add_points(struct laying *laying, const struct route_point *points, uint32_t count)
{
    struct world_build *built = laying->built;
    uint32_t used = built->counts.route_points;
    if (used + count > ROUTE_POINTS_MAX)
        return error_text_set(laying->error,
                              "%s:%d: %s.route: the routes have more than %u points along "
                              "the roads; right would be: shorter or fewer ones",
                              built->scenario->settings->params.scenario, laying->group->line,
                              laying->key, ROUTE_POINTS_MAX);
    if (used + count > laying->room) {
        uint32_t room = 2 * (used + count) + 256;
        struct route_point *grown = realloc(built->route_points, room * sizeof *grown);
        if (!grown)
            return error_text_memory(laying->error);
        built->route_points = grown;
        laying->room = room;
    }
    if (count > 0)
        memcpy(built->route_points + used, points, count * sizeof *points);
    built->counts.route_points += count;
    return 0;
}

static int find_road(const struct laying *laying, const struct route_point *point, uint32_t number,
                     struct road_place *place)
{
    const char *file = laying->built->scenario->settings->params.scenario;
    if (!road_graph_place(laying->net, point->x, point->z, place))
        return error_text_set(laying->error,
                              "%s:%d: %s.roads = true: this ground has no roads; right would "
                              "be: terrain.source = \"generated\", or a route without roads",
                              file, laying->group->line, laying->key);
    if (place->off_m > ROAD_ROUTE_OFF_M)
        return error_text_set(laying->error,
                              "%s:%d: %s.route: point %u, [%.0f, %.0f], is %.0f m from the "
                              "nearest road; allowed: up to %.0f m; right would be: near [%.0f, "
                              "%.0f]",
                              file, laying->group->line, laying->key, number, point->x, point->z,
                              place->off_m, ROAD_ROUTE_OFF_M, place->x, place->z);
    return 0;
}

/* Adds the path from one point to the next without its end, with which the next path begins. */
static int lay_leg(struct laying *laying, const struct route_point *points, uint32_t count,
                   uint32_t leg)
{
    const struct route_point *a = &points[leg], *b = &points[(leg + 1) % count];
    struct road_place from, to;
    struct route_point *way = NULL;
    uint32_t length = 0;
    double metres;
    if (find_road(laying, a, leg + 1, &from) != 0 ||
        find_road(laying, b, (leg + 1) % count + 1, &to) != 0)
        return -1;
    if (road_graph_way(laying->net, &from, &to, &way, &length, &metres) != 0)
        return errno == ENOMEM
                   ? error_text_memory(laying->error)
                   : error_text_set(laying->error,
                                    "%s:%d: %s.route: no road leads from point %u, [%.0f, "
                                    "%.0f], to point %u, [%.0f, %.0f]; right would be: points on "
                                    "roads that meet",
                                    laying->built->scenario->settings->params.scenario,
                                    laying->group->line, laying->key, leg + 1, a->x, a->z,
                                    (leg + 1) % count + 1, b->x, b->z);
    int result = add_points(laying, way, length - 1);
    free(way);
    return result;
}

/* Adds the points of one route, leaving out points at the place of the one before. */
static int lay_route(struct laying *laying)
{
    const struct scenario *scenario = laying->built->scenario;
    struct world_build *built = laying->built;
    const struct route *given = &scenario->routes[laying->group->route];
    struct route *route = &built->routes[laying->group->route];
    const struct route_point *points = &scenario->route_points[given->first];
    uint32_t first = built->counts.route_points, kept = first;
    for (uint32_t i = 0; i + laying->open < given->count && laying->group->roads; i++) {
        if (lay_leg(laying, points, given->count, i) != 0)
            return -1;
    }
    if (laying->open && laying->group->roads &&
        add_points(laying, &points[given->count - 1], 1) != 0)
        return -1;
    if (!laying->group->roads && add_points(laying, points, given->count) != 0)
        return -1;
    for (uint32_t i = first; i < built->counts.route_points && laying->group->roads; i++) {
        const struct route_point p = built->route_points[i];
        const struct route_point *last = &built->route_points[kept > first ? kept - 1 : first];
        if (kept > first && p.x == last->x && p.z == last->z)
            continue;
        built->route_points[kept++] = p;
    }
    if (laying->group->roads)
        built->counts.route_points = kept;
    *route = *given;
    route->first = first;
    route->count = built->counts.route_points - first;
    return 0;
}

/* Sets the key to that of phase p of the scenario: "missions[1].reactions[0]". */
static void name_phase(struct laying *laying, uint32_t p)
{
    const struct scenario *scenario = laying->built->scenario;
    uint32_t m = 0;
    while (m + 1 < scenario->mission_count && scenario->missions[m + 1].mission.first_phase <= p)
        m++;
    const struct mission *of = &scenario->missions[m].mission;
    bool reacts = p - of->first_phase >= of->phase_count;
    snprintf(laying->key, sizeof laying->key, "missions[%u].%s[%u]", m,
             reacts ? "reactions" : "phases", p - of->first_phase - (reacts ? of->phase_count : 0));
}

/* The routes of missions are open. */
static int lay_missions(struct laying *laying)
{
    const struct scenario *scenario = laying->built->scenario;
    int result = 0;
    laying->open = true;
    for (uint32_t p = 0; p < scenario->phase_count && result == 0; p++) {
        const struct scenario_phase *phase = &scenario->phases[p];
        const struct scenario_group group = {
            .route = phase->phase.route, .roads = phase->roads, .line = phase->line};
        laying->group = &group;
        name_phase(laying, p);
        if (group.route != MISSION_NONE)
            result = lay_route(laying);
        laying->group = NULL;
    }
    return result;
}

int road_routing_build(struct world_build *built, struct error_text *error)
{
    const struct scenario *scenario = built->scenario;
    struct road_graph net = {0};
    struct laying laying = {.built = built, .net = &net, .error = error};
    int result = 0;
    bool roads = false;
    built->counts.routes = scenario->route_count;
    built->routes = calloc(scenario->route_count + 1, sizeof *built->routes);
    for (uint32_t g = 0; g < scenario->group_count; g++)
        roads |= scenario->groups[g].roads != 0;
    for (uint32_t p = 0; p < scenario->phase_count; p++)
        roads |= scenario->phases[p].roads != 0;
    if (!built->routes || (roads && road_graph_build(&net, built->roads, built->counts.road_points,
                                                     built->counts.side_m) != 0))
        return error_text_memory(error);
    for (uint32_t g = 0; g < scenario->group_count && result == 0; g++) {
        laying.group = &scenario->groups[g];
        snprintf(laying.key, sizeof laying.key, "vehicles[%u]", g);
        if (laying.group->route != UINT32_MAX)
            result = lay_route(&laying);
    }
    if (result == 0)
        result = lay_missions(&laying);
    road_graph_free(&net);
    return result;
}

static double step_of(const struct route_point *a, const struct route_point *b)
{
    return sqrt((b->x - a->x) * (b->x - a->x) + (b->z - a->z) * (b->z - a->z));
}

double road_routing_length(const struct world_build *built, const struct route *route)
{
    const struct route_point *points = &built->route_points[route->first];
    double length = 0.0;
    for (uint32_t i = 0; i < route->count; i++)
        length += step_of(&points[i], &points[(i + 1) % route->count]);
    return length;
}

struct route_place road_routing_place(const struct world_build *built, const struct route *route,
                                      double along_m)
{
    const struct route_point *points = &built->route_points[route->first];
    double length = road_routing_length(built, route);
    struct route_place place = {points[0].x, points[0].z, 0.0, 1 % route->count};
    if (!(length > 0.0))
        return place;
    along_m -= length * floor(along_m / length);
    for (uint32_t i = 0; i < route->count; i++) {
        const struct route_point *a = &points[i], *b = &points[(i + 1) % route->count];
        double step = step_of(a, b);
        if (along_m < step) {
            double share = along_m / step;
            return (struct route_place){a->x + (b->x - a->x) * share, a->z + (b->z - a->z) * share,
                                        maths_heading(b->x - a->x, b->z - a->z),
                                        (i + 1) % route->count};
        }
        along_m -= step;
    }
    return place;
}
