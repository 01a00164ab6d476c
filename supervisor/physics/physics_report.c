/* Lines and JSON of measures. */
#include "supervisor/physics/physics_report.h"

#include "world/entity/kind.h"
#include "world/world.h"

#include <inttypes.h>
#include <stdio.h>

static const char *kind_name(const struct physics_check *check, const struct measured_body *body)
{
    return check->world->kinds[body->kind].name;
}

static void print_body(const struct physics_check *check, const struct measured_body *body)
{
    if (body->id == 0)
        return;
    printf("%s%s %" PRIu32 " at (%.3f, %.3f, %.3f)", body->fixed ? "; fixed " : "; ",
           kind_name(check, body), body->id, body->at.x, body->at.y, body->at.z);
}

static const char *verdict(const struct measures *measures, enum measure_kind kind)
{
    if (measure_bound(measures, kind) == NO_BOUND)
        return "-";
    return measure_good(measures, kind) ? "good" : "BAD";
}

static void print_line(const struct physics_check *check, enum measure_kind kind)
{
    const struct measure *measure = &check->measures.of[kind];
    double bound = measure_bound(&check->measures, kind);
    char limit[24] = "-", worst[24] = "-";
    if (bound != NO_BOUND)
        snprintf(limit, sizeof limit, "%g", bound);
    if (measure->taken > 0)
        snprintf(worst, sizeof worst, "%.6g", measure->worst);
    printf("%-14s %12s %8s %-10s %-4s %8" PRIu64, measure_word(kind), worst, limit,
           measure_unit(kind), verdict(&check->measures, kind), measure->beyond);
    if (measure->taken > 0 && measure->worst > 0.0) {
        printf("  frame %" PRIu64 " (%.3f s)", measure->frame, measure->time_s);
        print_body(check, &measure->body[0]);
        print_body(check, &measure->body[1]);
    }
    printf("\n");
}

void physics_report_print(const struct physics_check *check)
{
    printf("physics: %s: looked at %" PRIu64 " frames, %" PRIu64
           " times at a body, at most %" PRIu32 " in a frame\n",
           measures_good(&check->measures) ? "good" : "BAD", check->frames, check->bodies,
           check->most);
    printf("%-14s %12s %8s %-10s %-4s %8s  %s\n", "measure", "worst", "bound", "unit", "", "beyond",
           "worst at");
    for (int i = 0; i < MEASURE_KINDS; i++)
        print_line(check, (enum measure_kind)i);
}

static void add_body(const struct physics_check *check, cJSON *array,
                     const struct measured_body *body)
{
    if (body->id == 0)
        return;
    cJSON *object = cJSON_CreateObject();
    cJSON_AddItemToArray(array, object);
    json_whole(object, "id", body->id);
    json_bool(object, "fixed", body->fixed);
    json_text(object, "kind", kind_name(check, body));
    json_text(object, "name", body->fixed ? "" : world_entity_name(check->world, body->id));
    json_triple(object, "position", body->at.x, body->at.y, body->at.z);
}

static void add_measure(const struct physics_check *check, cJSON *object, enum measure_kind kind)
{
    const struct measure *measure = &check->measures.of[kind];
    json_text(object, "unit", measure_unit(kind));
    json_text(object, "meaning", measure_meaning(kind));
    json_number(object, "worst", measure->taken > 0 ? measure->worst : NAN);
    json_number(object, "bound", measure_bound(&check->measures, kind));
    json_bool(object, "good", measure_good(&check->measures, kind));
    json_whole(object, "taken", measure->taken);
    json_whole(object, "beyond", measure->beyond);
    json_whole(object, "frame", measure->frame);
    json_number(object, "time_s", measure->time_s);
    cJSON *bodies = json_array(object, "bodies");
    add_body(check, bodies, &measure->body[0]);
    add_body(check, bodies, &measure->body[1]);
}

void physics_report_json(const struct physics_check *check, cJSON *object)
{
    cJSON *physics = json_object(object, "physics");
    json_whole(physics, "frames", check->frames);
    json_whole(physics, "bodies", check->bodies);
    json_whole(physics, "bodies_at_once", check->most);
    json_bool(physics, "good", measures_good(&check->measures));
    cJSON *measures = json_object(physics, "measures");
    for (int i = 0; i < MEASURE_KINDS; i++)
        add_measure(check, json_object(measures, measure_word((enum measure_kind)i)),
                    (enum measure_kind)i);
}
