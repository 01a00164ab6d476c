/* Verb dump: prints every entity, every fixed object, or the heights of a piece of terrain. */
#include "ipc/segment/segment_attach.h"
#include "supervisor/worldctl/contact_chains.h"
#include "supervisor/worldctl/verbs.h"

#include "ipc/process/log.h"
#include "recorder/replay/arguments.h"
#include "ipc/json/world_json.h"
#include "world/entity/remote.h"
#include "world/entity/grounded.h"
#include "world/entity/kind.h"
#include "world/enum_names.h"
#include "world/terrain/fallen.h"

#include <stdio.h>
#include <stdlib.h>

/* Time until the gun can fire again. */
static double reload_s(const struct world *world, const struct state_head *head, uint32_t tick)
{
    return tick > head->tick ? (double)(tick - head->tick) * world_dt_s(world) : 0.0;
}

/* Adds the identifier of an entity at its owner. */
static void add_remote(cJSON *object, uint64_t remote)
{
    char text[REMOTE_ID_TEXT];
    json_text(object, "remote", remote_id_text(remote, text));
}

static cJSON *entity_json(const struct world *world, const struct state_head *head,
                          const struct entities *e, uint32_t i)
{
    cJSON *object = cJSON_CreateObject();
    json_whole(object, "id", e->row[i].id);
    json_text(object, "kind", world->kinds[e->row[i].kind].name);
    const char *name = world_entity_name(world, e->row[i].id);
    if (name[0] != '\0')
        json_text(object, "name", name);
    json_text(object, "force", force_name((enum force)e->row[i].force));
    json_triple(object, "position", e->row[i].x, e->row[i].y, e->row[i].z);
    json_triple(object, "velocity", e->row[i].vx, e->row[i].vy, e->row[i].vz);
    json_number(object, "heading_deg", e->row[i].heading * DEG_PER_RAD);
    json_number(object, "pitch_deg", e->row[i].pitch * DEG_PER_RAD);
    json_number(object, "roll_deg", e->row[i].roll * DEG_PER_RAD);
    json_number(object, "speed_mps", vec3_length(entities_velocity(e, i)));
    json_text(object, "state", entity_state_name((enum entity_state)e->row[i].state));
    json_bool(object, "grounded", grounded_of(e, &world->kinds[e->row[i].kind], i));
    json_text(object, "damage", damage_name((enum damage)e->row[i].damage));
    json_whole(object, "rounds", e->row[i].rounds);
    json_number(object, "fuel", e->row[i].fuel_l);
    json_number(object, "turret_deg", (double)e->row[i].turret * DEG_PER_RAD);
    json_number(object, "gun_deg", (double)e->row[i].gun * DEG_PER_RAD);
    json_number(object, "reload_s", reload_s(world, head, e->row[i].reload_tick));
    json_number(object, "throttle", (double)e->row[i].throttle);
    json_text(object, "gear", gear_name(entity_gear(e->row[i].flags)));
    json_text(object, "behaviour", behaviour_name((enum behaviour)e->row[i].behaviour));
    if (remote_is(e, i)) {
        char marking[REMOTE_MARKING_MAX + 1];
        remote_marking(e, i, marking);
        add_remote(object, e->row[i].driver);
        json_text(object, "marking", marking);
    }
    return object;
}

static void dump_entities_json(const struct view *view, const struct snapshot *snapshot)
{
    const struct entities *e = &snapshot->entities;
    struct contact_chains chains;
    if (contact_chains_make(&chains, snapshot) != 0)
        die_refused("out of memory for the contacts");
    for (uint32_t i = 0; i < snapshot->head.used; i++) {
        if (e->row[i].state == ENTITY_FREE)
            continue;
        cJSON *object = entity_json(&view->world, &snapshot->head, e, i);
        contact_chains_json(object, &chains, i);
        json_print(object);
    }
    contact_chains_free(&chains);
}

static void dump_entities(const struct arguments *arguments, const struct view *view,
                          const struct snapshot *snapshot)
{
    const struct entities *e = &snapshot->entities;
    if (arguments->json) {
        dump_entities_json(view, snapshot);
        return;
    }
    for (uint32_t i = 0; i < snapshot->head.used; i++) {
        if (e->row[i].state == ENTITY_FREE)
            continue;
        const struct kind *kind = &view->world.kinds[e->row[i].kind];
        const char *grounded = grounded_word(e, kind, i);
        printf("%6u %-14s %-7s x %10.2f y %8.2f z %10.2f heading %5.1f %6.1f m/s %-7s %-9s %s\n",
               e->row[i].id, kind->name, force_name((enum force)e->row[i].force), e->row[i].x,
               e->row[i].y, e->row[i].z, e->row[i].heading * DEG_PER_RAD,
               vec3_length(entities_velocity(e, i)),
               grounded ? grounded : entity_state_name((enum entity_state)e->row[i].state),
               damage_name((enum damage)e->row[i].damage),
               behaviour_name((enum behaviour)e->row[i].behaviour));
    }
}

static void dump_fixed(const struct arguments *arguments, const struct view *view,
                       const struct snapshot *snapshot)
{
    for (uint32_t i = 0; i < view->world.counts.fixed; i++) {
        const struct fixed_object *object = &view->world.fixed[i];
        const char *kind = view->world.kinds[object->kind].name;
        const char *damage = damage_name(fallen_damage(snapshot->fixed_damage[i]));
        if (!arguments->json) {
            printf("%6u %-12s x %10.2f y %8.2f z %10.2f radius %5.2f %s\n", i + 1, kind, object->x,
                   (double)object->y, object->z, (double)object->radius_m, damage);
            continue;
        }
        cJSON *entry = cJSON_CreateObject();
        json_whole(entry, "id", i + 1);
        json_text(entry, "kind", kind);
        json_triple(entry, "position", object->x, (double)object->y, object->z);
        json_single(entry, "radius_m", object->radius_m);
        json_single(entry, "height_m", object->height_m);
        json_text(entry, "damage", damage);
        json_print(entry);
    }
}

static void dump_terrain(const struct arguments *arguments, const struct view *view,
                         const struct snapshot *snapshot)
{
    double x0, z0, x1, z1, step;
    char rest;
    struct crater_index craters;
    if (sscanf(arguments->terrain, "%lf,%lf,%lf,%lf,%lf%c", &x0, &z0, &x1, &z1, &step, &rest) != 5)
        die_usage("--terrain %s: must be X0,Z0,X1,Z1,STEP in metres", arguments->terrain);
    if (!(step > 0.0) || !(x1 >= x0) || !(z1 >= z0) || (x1 - x0) / step * ((z1 - z0) / step) > 1e8)
        die_usage("--terrain %s: X0 <= X1, Z0 <= Z1, 0 < STEP, at most 1e8 points",
                  arguments->terrain);
    if (crater_index_init(&craters, &view->world.terrain.squares, view->w[0].craters) != 0)
        die_refused("out of memory for the index of craters");
    crater_index_update(&craters, snapshot->head.crater_count);
    printf("x,z,height_m,cover\n");
    for (uint64_t row = 0; z0 + (double)row * step <= z1; row++) {
        for (uint64_t column = 0; x0 + (double)column * step <= x1; column++) {
            double x = x0 + (double)column * step, z = z0 + (double)row * step;
            printf("%.3f,%.3f,%.4f,%s\n", x, z,
                   terrain_height(&view->world.terrain, &craters, x, z),
                   cover_name(terrain_cover(&view->world.terrain, x, z)));
        }
    }
    crater_index_free(&craters);
}

int verb_dump(const struct arguments *arguments)
{
    struct view view;
    struct snapshot snapshot;
    arguments_snapshot(arguments, &view, &snapshot);
    snapshot_settle_poses(&snapshot, &view);
    if (arguments->terrain)
        dump_terrain(arguments, &view, &snapshot);
    else if (arguments->fixed)
        dump_fixed(arguments, &view, &snapshot);
    else
        dump_entities(arguments, &view, &snapshot);
    snapshot_free(&snapshot);
    segment_detach(&view);
    return EXIT_OK;
}
