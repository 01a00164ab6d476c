/* Verbs that describe a world: info, status, summary, digest. Each prints a few lines for people,
 * or one JSON object for scripts. */
#include "ipc/segment/segment_attach.h"
#include "ipc/segment/segment_locks.h"
#include "supervisor/worldctl/battle.h"
#include "supervisor/worldctl/verbs.h"

#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "world/entity/kind.h"
#include "world/enum_names.h"
#include "world/gateway_idle.h"
#include "world/param_values.h"
#include "world/params.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"
#include "recorder/replay/arguments.h"
#include "ipc/json/world_json.h"

#include <inttypes.h>
#include <stdio.h>

/* --- info --------------------------------------------------------------------------------------*/

struct dispersion {
    uint32_t of_class[OBJECT_CLASS_COUNT];
    uint32_t occupied, most;
};

static struct dispersion count_objects(const struct world *world)
{
    struct dispersion d = {0};
    uint32_t run = 0;
    for (uint32_t i = 0; i < world->counts.fixed; i++) {
        const struct fixed_object *object = &world->fixed[i];
        bool same = i > 0 && gridsquare_of(&world->terrain.squares, object->x, object->z) ==
                                 gridsquare_of(&world->terrain.squares, world->fixed[i - 1].x,
                                               world->fixed[i - 1].z);
        run = same ? run + 1 : 1;
        d.occupied += !same;
        d.most = run > d.most ? run : d.most;
        d.of_class[world->kinds[object->kind].object_class]++;
    }
    return d;
}

static double per(uint32_t count, uint32_t squares)
{
    return squares > 0 ? (double)count / (double)squares : 0.0;
}

static void info_text(const struct view *view, const struct dispersion *d)
{
    const struct world *world = &view->world;
    const struct params *params = world->params;
    const struct counts *counts = &world->counts;
    printf("world        %s (%s, seed %" PRIu64 ")\n", view->name, params->name, params->seed);
    printf("scenario     %s\n", params->scenario);
    printf("step         %g Hz, pace %s\n", params->hz, params->pace == PACE_MAX ? "max" : "real");
    printf("memory       %.1f MB, room for %u entities of %zu bytes a table, and %u contacts\n",
           (double)view->layout.total / 1e6, params->capacity, sizeof(struct entity),
           params->contact_slots);
    printf("terrain      %u x %u posts, %g m apart\n", counts->posts_side, counts->posts_side,
           world->terrain.spacing_m);
    printf("shapes       %u models of %u triangles, in %u hulls of %u vertices\n", counts->models,
           counts->model_triangles, counts->hulls, counts->hull_vertices);
    for (int i = 0; i < OBJECT_CLASS_COUNT; i++)
        printf("%-16s %6u\n", object_class_name((enum object_class)i), d->of_class[i]);
    printf("%-16s %6u in %u of %u gridsquares: at most %u, on average %.2f of the occupied, "
           "%.2f of all\n",
           "fixed objects", counts->fixed, d->occupied, world->terrain.squares.count, d->most,
           per(counts->fixed, d->occupied), per(counts->fixed, world->terrain.squares.count));
}

static void info_json(const struct view *view, const struct dispersion *d)
{
    const struct world *world = &view->world;
    const struct params *params = world->params;
    cJSON *object = cJSON_CreateObject();
    json_text(object, "world", view->name);
    json_text(object, "name", params->name);
    json_text(object, "scenario", params->scenario);
    json_whole(object, "seed", params->seed);
    json_number(object, "hz", params->hz);
    json_whole(object, "capacity", params->capacity);
    json_whole(object, "contact_slots", params->contact_slots);
    json_whole(object, "bytes", view->layout.total);
    json_whole(object, "bytes_per_entity", sizeof(struct entity));
    json_whole(object, "vehicles", params->initial_entities);
    cJSON *counts = json_object(object, "counts");
    for (int i = 0; i < OBJECT_CLASS_COUNT; i++)
        json_whole(counts, object_class_name((enum object_class)i), d->of_class[i]);
    json_whole(object, "fixed_objects", world->counts.fixed);
    json_whole(object, "gridsquares", world->terrain.squares.count);
    json_whole(object, "occupied", d->occupied);
    json_whole(object, "most_per_square", d->most);
    json_number(object, "average_per_occupied", per(world->counts.fixed, d->occupied));
    json_number(object, "average_per_square",
                per(world->counts.fixed, world->terrain.squares.count));
    json_whole(object, "hulls", world->counts.hulls);
    json_whole(object, "hull_vertices", world->counts.hull_vertices);
    cJSON *terrain = json_object(object, "terrain");
    json_whole(terrain, "posts", world->counts.posts_side);
    json_number(terrain, "spacing_m", world->terrain.spacing_m);
    json_print(object);
}

int verb_info(const struct arguments *arguments)
{
    struct view view;
    arguments_attach(arguments, &view);
    struct dispersion d = count_objects(&view.world);
    if (arguments->json)
        info_json(&view, &d);
    else
        info_text(&view, &d);
    segment_detach(&view);
    return EXIT_OK;
}

/* --- status ------------------------------------------------------------------------------------*/

static const char *state_of(const struct view *view, const struct state_head *head)
{
    uint32_t mover = atomic_load(&view->slot[ROLE_MOVER]->pid);
    if (frame_protocol_finished(view))
        return "finished";
    if (mover == 0 || segment_holder(view->name, ROLE_MOVER) == 0)
        return "stopped";
    return head->paused ? "paused" : "running";
}

static double beat_age_ms(const struct role_slot *slot)
{
    uint64_t beat = atomic_load(&slot->beat_ns), now = clock_now_ns();
    return now > beat ? (double)(now - beat) / 1e6 : 0.0;
}

static void add_role(cJSON *array, const struct view *view, enum role role)
{
    const struct role_slot *slot = view->slot[role];
    int pid = segment_holder(view->name, role);
    cJSON *entry = cJSON_CreateObject();
    cJSON_AddItemToArray(
        array, entry); /* entry is NULL if memory is out: the first json_text() reports that */
    json_text(entry, "role", role_name(role));
    json_whole(entry, "pid", (uint64_t)pid);
    json_text(entry, "state",
              pid ? role_state_name((enum role_state)atomic_load(&slot->state)) : "dead");
    json_number(entry, "beat_age_ms", beat_age_ms(slot));
    json_whole(entry, "restarts", atomic_load(&slot->starts) - 1);
    json_number(entry, "stage_ms", (double)atomic_load(&slot->stage_ns) / 1e6);
    if (atomic_load(&slot->detail_pct) > 0) {
        json_whole(entry, "detail_pct", atomic_load(&slot->detail_pct));
        json_whole(entry, "size_pct", atomic_load(&slot->size_pct));
    }
}

static void read_head(const struct view *view, struct state_head *head)
{
    for (int tries = 0; tries < 1000; tries++) {
        if (snapshot_head(head, view) == 0)
            return;
    }
    die_refused("world \"%s\" is damaged: its last frame cannot be read", view->name);
}

static bool unguarded(const struct view *view)
{
    return segment_holder(view->name, ROLE_REPORTER) != 0 &&
           atomic_load(&view->slot[ROLE_REPORTER]->unguarded) != 0;
}

/* Settings of a gateway that the world does not have, by name. */
static void add_idle_settings(cJSON *object, const struct params *params)
{
    cJSON *array = json_array(object, "without_effect");
    char names[GATEWAY_IDLE_TEXT], *rest = NULL;
    if (!gateway_idle_settings(params, names))
        return;
    for (char *name = strtok_r(names, GATEWAY_IDLE_BETWEEN, &rest); name;
         name = strtok_r(NULL, GATEWAY_IDLE_BETWEEN, &rest))
        (void)cJSON_AddItemToArray(array, cJSON_CreateString(name));
}

static void status_json(const struct view *view, const struct state_head *head)
{
    cJSON *object = cJSON_CreateObject();
    json_text(object, "world", view->name);
    json_text(object, "state", state_of(view, head));
    json_whole(object, "commit", head->frame);
    json_whole(object, "moved", atomic_load(&view->moved_word->moved));
    json_number(object, "sim_time_s", state_time_s(&view->world, head));
    json_number(object, "hz", view->world.params->hz);
    json_bool(object, "paused", head->paused != 0);
    json_number(object, "time_scale", head->time_scale);
    json_whole(object, "vehicles", head->vehicles);
    json_whole(object, "munitions", head->munitions);
    json_whole(object, "events", head->event_end);
    json_bool(object, "unguarded", unguarded(view));
    add_idle_settings(object, view->world.params);
    battle_json(object, &view->world, head);
    cJSON *roles = json_array(object, "roles");
    for (int role = 0; role < ROLE_COUNT; role++) {
        if (atomic_load(&view->slot[role]->starts) > 0)
            add_role(roles, view, (enum role)role);
    }
    json_print(object);
}

static void print_role(const struct view *view, enum role role)
{
    const struct role_slot *slot = view->slot[role];
    int pid = segment_holder(view->name, role);
    printf("  %-10s %-8s pid %-7d beat %6.1f ms ago, %" PRIu64 " restarts, %.3f ms a frame",
           role_name(role),
           pid ? role_state_name((enum role_state)atomic_load(&slot->state)) : "dead", pid,
           beat_age_ms(slot), (uint64_t)atomic_load(&slot->starts) - 1,
           (double)atomic_load(&slot->stage_ns) / 1e6);
    if (atomic_load(&slot->detail_pct) > 0)
        printf(", %u %% of the detail at %u %% of the size", atomic_load(&slot->detail_pct),
               atomic_load(&slot->size_pct));
    printf("\n");
}

static void status_text(const struct view *view, const struct state_head *head)
{
    char names[GATEWAY_IDLE_TEXT];
    printf("world \"%s\" is %s at frame %" PRIu64 ", %.2f s; %u vehicles, %u munitions, %" PRIu64
           " events; scenario %s\n",
           view->name, state_of(view, head), head->frame, state_time_s(&view->world, head),
           head->vehicles, head->munitions, head->event_end, view->world.params->scenario);
    for (int role = 0; role < ROLE_COUNT; role++) {
        if (atomic_load(&view->slot[role]->starts) > 0)
            print_role(view, (enum role)role);
    }
    battle_print(&view->world, head);
    if (unguarded(view))
        printf("WARNING: the reporter takes commands from every host that reaches its network "
               "(--remote-commands without DDS Security)\n");
    if (gateway_idle_settings(view->world.params, names))
        printf("WARNING: " GATEWAY_IDLE_WARNING "\n", names);
}

int verb_status(const struct arguments *arguments)
{
    struct view view;
    struct state_head head;
    arguments_attach(arguments, &view);
    read_head(&view, &head);
    if (arguments->json)
        status_json(&view, &head);
    else
        status_text(&view, &head);
    segment_detach(&view);
    return EXIT_OK;
}

/* --- digest and summary ------------------------------------------------------------------------*/

int verb_digest(const struct arguments *arguments)
{
    struct view view;
    struct snapshot snapshot;
    arguments_snapshot(arguments, &view, &snapshot);
    struct state state = snapshot_state(&snapshot, &view);
    uint64_t digest = state_digest(&view.world, &state);
    if (arguments->json) {
        cJSON *object = cJSON_CreateObject();
        json_whole(object, "frame", snapshot.head.frame);
        json_hex(object, "digest", digest);
        json_hex(object, "event_digest", snapshot.head.event_digest);
        json_print(object);
    } else {
        printf("%016" PRIx64 " %016" PRIx64 " frame %" PRIu64 "\n", digest,
               snapshot.head.event_digest, snapshot.head.frame);
    }
    snapshot_free(&snapshot);
    segment_detach(&view);
    return EXIT_OK;
}

static void add_times(cJSON *object, const char *key, const struct histogram *histogram)
{
    cJSON *times = json_object(object, key);
    json_number(times, "p50", (double)histogram_quantile(histogram, 0.50) / 1e6);
    json_number(times, "p99", (double)histogram_quantile(histogram, 0.99) / 1e6);
    json_number(times, "max", (double)histogram->max_ns / 1e6);
}

static uint64_t restarts_of(const struct view *view)
{
    uint64_t restarts = 0;
    for (int role = 0; role < ROLE_COUNT; role++) {
        uint64_t starts = atomic_load(&view->slot[role]->starts);
        restarts += starts > 0 ? starts - 1 : 0;
    }
    return restarts;
}

static void summary_json(const struct view *view, const struct state_head *head, uint64_t digest,
                         double wall_s)
{
    const struct counters *tally = &head->tally;
    cJSON *object = cJSON_CreateObject();
    json_text(object, "world", view->name);
    json_whole(object, "frame", head->frame);
    json_number(object, "sim_time_s", state_time_s(&view->world, head));
    json_hex(object, "digest", digest);
    json_hex(object, "event_digest", head->event_digest);
    json_whole(object, "vehicles", head->vehicles);
    json_whole(object, "munitions", head->munitions);
    json_whole(object, "fixed_objects", view->world.counts.fixed);
    json_whole(object, "events", head->event_end);
    json_whole(object, "collisions", tally->collisions);
    json_whole(object, "fires", tally->fires);
    json_whole(object, "detonations", tally->detonations);
    json_whole(object, "craters", head->crater_count);
    json_whole(object, "destroyed", tally->destroyed);
    json_whole(object, "fixed_damaged", tally->fixed_damaged);
    json_whole(object, "agent_changes", tally->agent_changes);
    json_whole(object, "commands", tally->commands);
    json_whole(object, "events_dropped", tally->events_dropped);
    json_whole(object, "craters_refused", tally->craters_refused);
    json_whole(object, "spawns_refused", tally->spawns_refused);
    json_whole(object, "contacts", head->contact_count);
    json_whole(object, "contacts_refused", tally->contacts_refused);
    battle_json(object, &view->world, head);
    json_whole(object, "restarts", restarts_of(view));
    json_whole(object, "late_frames", atomic_load(&view->slot[ROLE_MOVER]->late_frames));
    add_times(object, "frame_ms", &view->slot[ROLE_COLLIDER]->whole);
    add_times(object, "mover_ms", &view->slot[ROLE_MOVER]->stage);
    add_times(object, "collider_ms", &view->slot[ROLE_COLLIDER]->stage);
    json_number(object, "wall_s", wall_s);
    json_print(object);
}

static void print_times(const char *name, const struct histogram *histogram)
{
    printf("  %-10s p50 %8.3f ms   p99 %8.3f ms   max %8.3f ms\n", name,
           (double)histogram_quantile(histogram, 0.50) / 1e6,
           (double)histogram_quantile(histogram, 0.99) / 1e6, (double)histogram->max_ns / 1e6);
}

static void summary_text(const struct view *view, const struct state_head *head, uint64_t digest,
                         double wall_s)
{
    const struct counters *tally = &head->tally;
    printf("world \"%s\": %" PRIu64 " frames, %.1f s of simulation in %.1f s\n", view->name,
           head->frame, state_time_s(&view->world, head), wall_s);
    printf("  %u vehicles, %" PRIu64 " of them destroyed; %" PRIu64 " shots, %" PRIu64
           " detonations, %u craters\n",
           head->vehicles, tally->destroyed, tally->fires, tally->detonations, head->crater_count);
    printf("  %" PRIu64 " collisions; %" PRIu64 " of %u fixed objects damaged; %" PRIu64
           " events\n",
           tally->collisions, tally->fixed_damaged, view->world.counts.fixed, head->event_end);
    print_times("frame", &view->slot[ROLE_COLLIDER]->whole);
    print_times("mover", &view->slot[ROLE_MOVER]->stage);
    print_times("collider", &view->slot[ROLE_COLLIDER]->stage);
    printf("  %" PRIu64 " late frames, %" PRIu64 " restarts\n",
           (uint64_t)atomic_load(&view->slot[ROLE_MOVER]->late_frames), restarts_of(view));
    printf("  digest %016" PRIx64 ", of events %016" PRIx64 "\n", digest, head->event_digest);
}

int verb_summary(const struct arguments *arguments)
{
    struct view view;
    struct snapshot snapshot;
    arguments_snapshot(arguments, &view, &snapshot);
    struct state state = snapshot_state(&snapshot, &view);
    uint64_t digest = state_digest(&view.world, &state);
    if (arguments->json)
        summary_json(&view, &snapshot.head, digest, arguments->wall_s);
    else
        summary_text(&view, &snapshot.head, digest, arguments->wall_s);
    snapshot_free(&snapshot);
    segment_detach(&view);
    return EXIT_OK;
}
